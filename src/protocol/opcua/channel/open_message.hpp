// SPDX-License-Identifier: Apache-2.0
// OPN (OPC 10000-6, 6.7.4): the message that opens a channel, whole, as either side sends it.
#pragma once

#include "opcua/channel/chunk.hpp"

namespace takt::opcua {

/// Who a server or a client is.
struct Identity {
  security::PrivateKey key;
  security::Certificate certificate;
};

/// `body` begins with its type. `other` is null without a policy. Nothing if a key cannot be used.
std::optional<std::vector<std::byte>> sealed_open(std::uint32_t channel, const PolicyInfo& policy,
                                                  const SequenceHeader& sequence, Octets body, const Identity& own,
                                                  const security::Certificate* other);

}  // namespace takt::opcua
