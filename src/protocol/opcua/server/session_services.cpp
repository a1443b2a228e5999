// SPDX-License-Identifier: Apache-2.0
// Discovery and sessions (OPC 10000-4, 5.4 and 5.6).
#include <algorithm>

#include "opcua/channel/password.hpp"
#include "opcua/server/services.hpp"

namespace takt::opcua {
namespace {

constexpr std::string_view transport_profile = "http://opcfoundation.org/UA-Profile/Transport/uatcp-uasc-uabinary";
constexpr std::string_view anonymous_policy = "anonymous";
constexpr std::size_t most_sources = 256;
constexpr std::size_t session_nonce_octets = 32;
constexpr std::uint64_t steps_of_password = 1'000'000;  // what makes a hash of it takes 50 ms on purpose

/// With what policy the password is encrypted: the channel's, and where it has none, one all the same.
const PolicyInfo& password_policy(SecurityPolicy policy) {
  return info(is_secured(policy) ? policy : SecurityPolicy::Basic256Sha256);
}
std::string user_policy(SecurityPolicy policy) { return "username_" + std::string(password_policy(policy).name); }

}  // namespace

bool Services::is_offered(const ChannelSecurity& security) const {
  return std::find(settings_.endpoints.begin(), settings_.endpoints.end(), security) != settings_.endpoints.end();
}

ApplicationDescription Services::application(const Request& request) const {
  ApplicationDescription made;
  made.application_uri = Text(settings_.application_uri);
  made.product_uri = Text("urn:takt:node");
  made.application_name = LocalizedText(settings_.application_name);
  made.discovery_urls.push_back(Text(request.url));
  return made;
}

List<EndpointDescription> Services::endpoints(const Request& request) const {
  List<EndpointDescription> list;
  for (const ChannelSecurity& each : settings_.endpoints) {
    EndpointDescription endpoint;
    endpoint.endpoint_url = Text(request.url);
    endpoint.server = application(request);
    endpoint.server_certificate = Bytes({identity_.certificate.der().begin(), identity_.certificate.der().end()});
    endpoint.security_mode = each.mode;
    endpoint.security_policy_uri = Text(info(each.policy).uri);
    if (settings_.anonymous)
      endpoint.user_identity_tokens.push_back({Text(anonymous_policy), UserTokenType::Anonymous, {}, {}, {}});
    if (!settings_.users.empty())
      endpoint.user_identity_tokens.push_back(
          {Text(user_policy(each.policy)), UserTokenType::UserName, {}, {}, Text(password_policy(each.policy).uri)});
    endpoint.transport_profile_uri = Text(transport_profile);
    endpoint.security_level = static_cast<std::uint8_t>(info(each.policy).level + (each.is_encrypted() ? 100 : 0));
    list.push_back(std::move(endpoint));
  }
  return list;
}

Answer<FindServersResponse> Services::find_servers(const Request& request, const FindServersRequest& body) {
  FindServersResponse response;
  const bool is_asked_for =
      body.server_uris.empty() || std::any_of(body.server_uris.begin(), body.server_uris.end(),
                                              [&](const Text& each) { return each == settings_.application_uri; });
  if (is_asked_for) response.servers.push_back(application(request));
  return response;
}

Answer<GetEndpointsResponse> Services::get_endpoints(const Request& request, const GetEndpointsRequest& body) {
  GetEndpointsResponse response;
  const bool is_asked_for =
      body.profile_uris.empty() || std::any_of(body.profile_uris.begin(), body.profile_uris.end(),
                                               [](const Text& each) { return each == transport_profile; });
  if (is_asked_for) response.endpoints = endpoints(request);
  return response;
}

std::vector<Place> Services::places(bool active, Now now, std::vector<NodeId>& tokens) const {
  std::vector<Place> places;
  for (const auto& [token, each] : sessions_) {
    if (each.is_active != active) continue;
    const bool is_left = active && each.connection == 0 && each.left + settings_.limits.session_grace <= now.local;
    places.push_back({each.holder(), active ? each.rank() : 0, each.connection == 0 ? 0 : 1, is_left, each.created});
    tokens.push_back(token);
  }
  return places;
}

/// Those who have not signed in have the places that are left, half as many as there are at least. Who it will be is
/// not known here: somebody for whom another would go may come.
bool Services::make_room_to_sign_in(const std::string& host, Now now) {
  std::vector<NodeId> tokens;
  const auto waiting = places(false, now, tokens);
  std::vector<NodeId> of_active;
  const auto active = places(true, now, of_active);
  const Newcomer most = settings_.users.empty() ? Newcomer{host, 0} : Newcomer{"", 2};
  if (active.size() >= settings_.limits.sessions && !place_to_give(active, most)) return false;
  const std::size_t left = settings_.limits.sessions - std::min(settings_.limits.sessions, active.size());
  if (waiting.size() < std::max({left, settings_.limits.sessions / 2, std::size_t{1}})) return true;
  const auto given = place_to_give(waiting, {host, 1});
  if (given) end(tokens[*given], true, StatusCode::BadSessionClosed, now);
  return given.has_value();
}

/// For one who has signed in. Subscriptions of the one that goes wait for whom they belong to.
bool Services::make_room(const Session& newcomer, Now now) {
  std::vector<NodeId> tokens;
  const auto active = places(true, now, tokens);
  if (active.size() < settings_.limits.sessions) return true;
  const auto given = place_to_give(active, {newcomer.holder(), newcomer.rank()});
  if (given) end(tokens[*given], false, StatusCode::BadSessionClosed, now);
  return given.has_value();
}

Answer<CreateSessionResponse> Services::create_session(const Request& request, const CreateSessionRequest& body) {
  if (!is_offered(request.security)) return StatusCode::BadSecurityPolicyRejected;
  const bool has_policy = is_secured(request.security.policy);
  if (has_policy) {
    if (body.client_nonce.value.size() < 32 || body.client_nonce.value.size() > 128) return StatusCode::BadNonceInvalid;
    const auto certificate = security::Certificate::from_der(body.client_certificate.value);
    if (!certificate || request.certificate == nullptr || !(*certificate == *request.certificate))
      return StatusCode::BadSecurityChecksFailed;
    if (certificate->application_uri() != body.client_description.application_uri.value)
      return StatusCode::BadCertificateUriInvalid;
  }
  if (!make_room_to_sign_in(host_of(request.source), request.now)) return StatusCode::BadTooManySessions;
  Session session;
  session.host = host_of(request.source);
  session.id = NodeId(own_namespace, ++last_session_);
  session.token.name_space = own_namespace;
  session.token.id = Bytes(random_octets(32));
  session.name = body.session_name.empty() ? Text("session " + std::to_string(last_session_)) : body.session_name;
  session.client_uri = body.client_description.application_uri;
  session.connection = request.connection;
  session.security = request.security;
  if (request.certificate != nullptr) session.certificate = *request.certificate;
  session.nonce = random_octets(session_nonce_octets);
  const double most_ms = static_cast<double>(settings_.limits.most_session.ps()) / 1e9;
  const double wanted_ms = body.requested_session_timeout > 0 && body.requested_session_timeout < most_ms
                               ? body.requested_session_timeout
                               : most_ms;
  session.timeout = std::clamp(milliseconds(static_cast<std::int64_t>(wanted_ms)), settings_.limits.least_session,
                               settings_.limits.most_session);
  session.created = request.now.local;
  session.ends = request.now.local + session.timeout;

  CreateSessionResponse response;
  response.session_id = session.id;
  response.authentication_token = session.token;
  response.revised_session_timeout = static_cast<double>(session.timeout.ps()) / 1e9;
  response.server_nonce = Bytes(session.nonce);
  response.server_certificate = Bytes({identity_.certificate.der().begin(), identity_.certificate.der().end()});
  response.server_endpoints = endpoints(request);
  response.max_request_message_size = static_cast<std::uint32_t>(settings_.limits.message_octets);
  if (has_policy) {
    const PolicyInfo& policy = info(request.security.policy);
    const std::size_t leaf = security::first_der_octets(body.client_certificate.value);
    response.server_signature = {
        Text(policy.signature_uri),
        Bytes(identity_.key.sign(policy.signature,
                                 joined(Octets(body.client_certificate.value).first(leaf), body.client_nonce.value)))};
  }
  sessions_.emplace(session.token, std::move(session));
  return response;
}

Session* Services::session_for(const Request& request, StatusCode& why, bool must_be_active) {
  const auto found = sessions_.find(request.header.authentication_token);
  why = StatusCode::BadSessionIdInvalid;
  if (found == sessions_.end()) return nullptr;
  Session& session = found->second;
  if (must_be_active && session.connection != request.connection) {
    why = StatusCode::BadSecureChannelIdInvalid;
    return nullptr;
  }
  if (must_be_active && !session.is_active) {
    end(session.token, true, StatusCode::BadSessionClosed, request.now);
    why = StatusCode::BadSessionNotActivated;
    return nullptr;
  }
  session.ends = request.now.local + session.timeout;
  return &session;
}

Answer<ActivateSessionResponse> Services::activate_session(const Request& request, const ActivateSessionRequest& body) {
  Session& session = *request.session;
  const bool is_moving = session.connection != request.connection;
  // The first time on the channel that made it; later on another one of the same client, secured alike.
  if (is_moving && (!session.is_active || session.security != request.security))
    return StatusCode::BadSecureChannelIdInvalid;
  if (is_secured(request.security.policy)) {
    const PolicyInfo& policy = info(request.security.policy);
    const bool is_same =
        request.certificate != nullptr && session.certificate && *session.certificate == *request.certificate;
    if (!is_same) return StatusCode::BadSecurityChecksFailed;
    if (!session.certificate->key().verify(policy.signature, joined(identity_.certificate.der(), session.nonce),
                                           body.client_signature.signature.value))
      return StatusCode::BadApplicationSignatureInvalid;
  }
  const Text user_before = session.user;
  const Role role_before = session.role;
  const bool was_active = session.is_active;
  if (const StatusCode status = sign_in(request, session, body.user_identity_token); !is_good(status)) return status;
  if (is_moving && !(session.user == user_before)) {
    session.user = user_before;
    session.role = role_before;
    session.is_active = was_active;
    return StatusCode::BadIdentityTokenRejected;
  }
  if (!was_active && !make_room(session, request.now)) return StatusCode::BadTooManySessions;
  session.buffers = buffers_of(session);
  if (!session.account)
    session.account = std::make_shared<OctetAccount>(settings_.limits.session_octets, holder_account(session.holder()));
  else
    session.account->move_below(holder_account(session.holder()));
  if (is_moving) session.publishes.clear();  // they came over a channel that this session has left
  session.is_active = true;
  session.connection = request.connection;
  session.nonce = random_octets(session_nonce_octets);
  ActivateSessionResponse response;
  response.server_nonce = Bytes(session.nonce);
  return response;
}

StatusCode Services::sign_in(const Request& request, Session& session, const ExtensionObject& token) {
  if (const auto named = structure_in<UserNameIdentityToken>(token)) {
    if (settings_.users.empty() || !(named->policy_id == user_policy(request.security.policy)))
      return StatusCode::BadIdentityTokenInvalid;
    Text user;
    Role role = Role::observer;
    spend(steps_of_password);
    const StatusCode status = check_password(request, session, *named, user, role);
    note_sign_in(request, is_good(status));
    if (!is_good(status)) return status;
    session.user = user;
    session.role = role;
    return StatusCode::Good;
  }
  const auto anonymous = structure_in<AnonymousIdentityToken>(token);
  if (!token.type.is_null() && !anonymous) return StatusCode::BadIdentityTokenInvalid;
  if (anonymous && !anonymous->policy_id.empty() && !(anonymous->policy_id == anonymous_policy))
    return StatusCode::BadIdentityTokenInvalid;
  if (!settings_.anonymous) return StatusCode::BadIdentityTokenRejected;
  session.user = {};
  session.role = Role::observer;
  return StatusCode::Good;
}

/// Whatever is wrong, it is the same answer after the same work.
StatusCode Services::check_password(const Request& request, const Session& session, const UserNameIdentityToken& token,
                                    Text& user, Role& role) {
  const auto source = sign_ins_.find(host_of(request.source));
  if (source != sign_ins_.end() && request.now.local < source->second.refused_until)
    return StatusCode::BadUserAccessDenied;
  const PolicyInfo& policy = password_policy(request.security.policy);
  const auto clear = token.encryption_algorithm == policy.encryption_uri
                         ? identity_.key.decrypt(policy.encryption, token.password.value)
                         : std::nullopt;
  const auto password = clear ? password_in(clear->octets(), session.nonce) : std::nullopt;
  const auto known = std::find_if(settings_.users.begin(), settings_.users.end(),
                                  [&](const User& each) { return token.user_name == each.name; });
  const User& asked = known == settings_.users.end() ? settings_.users.front() : *known;
  const bool matches = asked.password.matches(password.value_or(std::string()));
  if (!password || known == settings_.users.end() || !matches) return StatusCode::BadUserAccessDenied;
  user = Text(known->name);
  role = known->role;
  return StatusCode::Good;
}

/// Some failures are people; more of them wait from one second on up to a minute.
void Services::note_sign_in(const Request& request, bool is_success) {
  const std::string host = host_of(request.source);
  if (is_success) {
    sign_ins_.erase(host);
    return;
  }
  if (sign_ins_.size() >= most_sources && !sign_ins_.contains(host)) sign_ins_.erase(sign_ins_.begin());
  SignIns& of = sign_ins_[host];
  log_.refused(request.source, "a sign-in", "");
  if (++of.failed < settings_.limits.failed_sign_ins) return;
  const std::size_t doublings = std::min<std::size_t>(of.failed - settings_.limits.failed_sign_ins, 6);
  of.refused_until = std::max(
      of.refused_until, request.now.local + std::min(milliseconds(1000) * static_cast<std::int64_t>(1U << doublings),
                                                     milliseconds(60'000)));
}

Answer<CloseSessionResponse> Services::close_session(const Request& request, const CloseSessionRequest& body) {
  end(NodeId(request.session->token), body.delete_subscriptions, StatusCode::BadSessionClosed, request.now);
  return CloseSessionResponse();
}

void Services::end(const NodeId& token_of, bool deletes_subscriptions, StatusCode why, Now now) {
  const NodeId token = token_of;  // it may be the session's own
  const auto found = sessions_.find(token);
  if (found == sessions_.end()) return;
  refuse_publishes(found->second, why, now);
  std::vector<std::uint32_t> of_it;
  for (auto& [id, subscription] : subscriptions_)
    if (subscription.session == token) of_it.push_back(id);
  for (const std::uint32_t id : of_it) {
    if (deletes_subscriptions)
      remove(id);
    else
      orphan(subscriptions_.at(id), now);  // until somebody takes it over
  }
  sessions_.erase(found);
}

Answer<CancelResponse> Services::cancel(const Request& request, const CancelRequest& body) {
  CancelResponse response;
  auto& waiting = request.session->publishes;
  for (std::size_t i = 0; i < waiting.size();) {
    if (waiting[i].request_handle != body.request_handle) {
      ++i;
      continue;
    }
    fault(request.connection, waiting[i].request_id, waiting[i].request_handle, StatusCode::BadTimeout, request.now);
    waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(i));
    ++response.cancel_count;
  }
  return response;
}

}  // namespace takt::opcua
