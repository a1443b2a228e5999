// SPDX-License-Identifier: Apache-2.0
// GetSecurityKeys (OPC 10000-14, 8.3.2): what is asked and what is answered, as the arguments of a Call and back. Both
// sides of it.
#pragma once

#include "opcua/services/attributes.hpp"
#include "security/secret.hpp"

namespace takt::opcua {

struct SecurityKeysRequest {
  Text group;
  std::uint32_t starting_token = 0;  ///< 0: the current one
  std::uint32_t count = 0;           ///< of future keys
};

struct SecurityKeys {
  Text policy_uri;
  std::uint32_t first_token = 0;  ///< of the first key; the next ones are those behind it
  std::vector<security::Secret> keys;
  double time_to_next_ms = 0;  ///< until the current one ends
  double lifetime_ms = 0;      ///< of each one behind it
};

/// The method of the object PublishSubscribe.
CallMethodRequest call_of(const SecurityKeysRequest& request);
/// Nothing if the arguments are not those of the method; `result` says why.
std::optional<SecurityKeysRequest> keys_request_in(const CallMethodRequest& call, CallMethodResult& result);
CallMethodResult result_of(const SecurityKeys& keys);
/// Nothing if the output arguments are not those of the method. What they say is not looked at.
std::optional<SecurityKeys> keys_in(const CallMethodResult& result);

}  // namespace takt::opcua
