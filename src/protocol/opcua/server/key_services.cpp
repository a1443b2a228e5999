// SPDX-License-Identifier: Apache-2.0
// GetSecurityKeys (OPC 10000-14, 8.3.2): keys of SecurityGroups for those who may have them.
#include "opcua/server/services.hpp"

namespace takt::opcua {

bool Services::may_have_keys(const Session& session) const {
  return session.role == Role::key_access && session.security.is_encrypted();
}

/// Whoever may not have keys does not learn either which groups there are.
CallMethodResult Services::get_security_keys(const Request& request, const CallMethodRequest& wanted) {
  const Session& session = *request.session;
  CallMethodResult result;
  const auto refuse = [&](StatusCode why) {
    result.status_code = why;
    log_.refused(request.source, "keys",
                 (session.user.empty() ? "a client without a name" : session.user.value) + ": " +
                     std::string(short_name_of(why)));
    return result;
  };
  if (wanted.method_id != NodeId(ids::get_security_keys) && wanted.method_id != NodeId(ids::get_security_keys_of_type))
    return refuse(StatusCode::BadMethodInvalid);
  if (!session.security.is_encrypted()) return refuse(StatusCode::BadSecurityModeInsufficient);
  if (!may_have_keys(session)) return refuse(StatusCode::BadUserAccessDenied);
  const auto asked = keys_request_in(wanted, result);
  if (!asked) return refuse(result.status_code);
  const auto answer = keys_->keys(*asked, session.user);
  if (const auto* const why = std::get_if<StatusCode>(&answer)) return refuse(*why);
  return result_of(std::get<SecurityKeys>(answer));
}

}  // namespace takt::opcua
