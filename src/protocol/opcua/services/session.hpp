// SPDX-License-Identifier: Apache-2.0
// Discovery and sessions (OPC 10000-4, 5.4 and 5.6).
#pragma once

#include "opcua/services/channel.hpp"

namespace takt::opcua {

enum class ApplicationType : std::int32_t { Server, Client, ClientAndServer, DiscoveryServer };
enum class UserTokenType : std::int32_t { Anonymous, UserName, Certificate, IssuedToken };

struct ApplicationDescription {
  static constexpr std::uint32_t encoding_id = 310;
  Text application_uri;
  Text product_uri;
  LocalizedText application_name;
  ApplicationType application_type = ApplicationType::Server;
  Text gateway_server_uri;
  Text discovery_profile_uri;
  List<Text> discovery_urls;
  static constexpr auto members() {
    return std::tuple(&ApplicationDescription::application_uri, &ApplicationDescription::product_uri,
                      &ApplicationDescription::application_name, &ApplicationDescription::application_type,
                      &ApplicationDescription::gateway_server_uri, &ApplicationDescription::discovery_profile_uri,
                      &ApplicationDescription::discovery_urls);
  }
};

struct UserTokenPolicy {
  static constexpr std::uint32_t encoding_id = 306;
  Text policy_id;
  UserTokenType token_type = UserTokenType::Anonymous;
  Text issued_token_type;
  Text issuer_endpoint_url;
  Text security_policy_uri;
  static constexpr auto members() {
    return std::tuple(&UserTokenPolicy::policy_id, &UserTokenPolicy::token_type, &UserTokenPolicy::issued_token_type,
                      &UserTokenPolicy::issuer_endpoint_url, &UserTokenPolicy::security_policy_uri);
  }
};

struct EndpointDescription {
  static constexpr std::uint32_t encoding_id = 314;
  Text endpoint_url;
  ApplicationDescription server;
  Bytes server_certificate;
  MessageSecurityMode security_mode = MessageSecurityMode::Invalid;
  Text security_policy_uri;
  List<UserTokenPolicy> user_identity_tokens;
  Text transport_profile_uri;
  std::uint8_t security_level = 0;
  static constexpr auto members() {
    return std::tuple(&EndpointDescription::endpoint_url, &EndpointDescription::server,
                      &EndpointDescription::server_certificate, &EndpointDescription::security_mode,
                      &EndpointDescription::security_policy_uri, &EndpointDescription::user_identity_tokens,
                      &EndpointDescription::transport_profile_uri, &EndpointDescription::security_level);
  }
};

struct FindServersRequest {
  static constexpr std::uint32_t encoding_id = 422;
  RequestHeader request_header;
  Text endpoint_url;
  List<Text> locale_ids;
  List<Text> server_uris;
  static constexpr auto members() {
    return std::tuple(&FindServersRequest::request_header, &FindServersRequest::endpoint_url,
                      &FindServersRequest::locale_ids, &FindServersRequest::server_uris);
  }
};

struct FindServersResponse {
  static constexpr std::uint32_t encoding_id = 425;
  ResponseHeader response_header;
  List<ApplicationDescription> servers;
  static constexpr auto members() {
    return std::tuple(&FindServersResponse::response_header, &FindServersResponse::servers);
  }
};

struct GetEndpointsRequest {
  static constexpr std::uint32_t encoding_id = 428;
  RequestHeader request_header;
  Text endpoint_url;
  List<Text> locale_ids;
  List<Text> profile_uris;
  static constexpr auto members() {
    return std::tuple(&GetEndpointsRequest::request_header, &GetEndpointsRequest::endpoint_url,
                      &GetEndpointsRequest::locale_ids, &GetEndpointsRequest::profile_uris);
  }
};

struct GetEndpointsResponse {
  static constexpr std::uint32_t encoding_id = 431;
  ResponseHeader response_header;
  List<EndpointDescription> endpoints;
  static constexpr auto members() {
    return std::tuple(&GetEndpointsResponse::response_header, &GetEndpointsResponse::endpoints);
  }
};

struct SignedSoftwareCertificate {
  static constexpr std::uint32_t encoding_id = 346;
  Bytes certificate_data;
  Bytes signature;
  static constexpr auto members() {
    return std::tuple(&SignedSoftwareCertificate::certificate_data, &SignedSoftwareCertificate::signature);
  }
};

struct CreateSessionRequest {
  static constexpr std::uint32_t encoding_id = 461;
  RequestHeader request_header;
  ApplicationDescription client_description;
  Text server_uri;
  Text endpoint_url;
  Text session_name;
  Bytes client_nonce;
  Bytes client_certificate;
  double requested_session_timeout = 0;
  std::uint32_t max_response_message_size = 0;
  static constexpr auto members() {
    return std::tuple(&CreateSessionRequest::request_header, &CreateSessionRequest::client_description,
                      &CreateSessionRequest::server_uri, &CreateSessionRequest::endpoint_url,
                      &CreateSessionRequest::session_name, &CreateSessionRequest::client_nonce,
                      &CreateSessionRequest::client_certificate, &CreateSessionRequest::requested_session_timeout,
                      &CreateSessionRequest::max_response_message_size);
  }
};

struct CreateSessionResponse {
  static constexpr std::uint32_t encoding_id = 464;
  ResponseHeader response_header;
  NodeId session_id;
  NodeId authentication_token;
  double revised_session_timeout = 0;
  Bytes server_nonce;
  Bytes server_certificate;
  List<EndpointDescription> server_endpoints;
  List<SignedSoftwareCertificate> server_software_certificates;
  SignatureData server_signature;
  std::uint32_t max_request_message_size = 0;
  static constexpr auto members() {
    return std::tuple(&CreateSessionResponse::response_header, &CreateSessionResponse::session_id,
                      &CreateSessionResponse::authentication_token, &CreateSessionResponse::revised_session_timeout,
                      &CreateSessionResponse::server_nonce, &CreateSessionResponse::server_certificate,
                      &CreateSessionResponse::server_endpoints, &CreateSessionResponse::server_software_certificates,
                      &CreateSessionResponse::server_signature, &CreateSessionResponse::max_request_message_size);
  }
};

struct ActivateSessionRequest {
  static constexpr std::uint32_t encoding_id = 467;
  RequestHeader request_header;
  SignatureData client_signature;
  List<SignedSoftwareCertificate> client_software_certificates;
  List<Text> locale_ids;
  ExtensionObject user_identity_token;
  SignatureData user_token_signature;
  static constexpr auto members() {
    return std::tuple(&ActivateSessionRequest::request_header, &ActivateSessionRequest::client_signature,
                      &ActivateSessionRequest::client_software_certificates, &ActivateSessionRequest::locale_ids,
                      &ActivateSessionRequest::user_identity_token, &ActivateSessionRequest::user_token_signature);
  }
};

struct ActivateSessionResponse {
  static constexpr std::uint32_t encoding_id = 470;
  ResponseHeader response_header;
  Bytes server_nonce;
  List<StatusCode> results;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&ActivateSessionResponse::response_header, &ActivateSessionResponse::server_nonce,
                      &ActivateSessionResponse::results, &ActivateSessionResponse::diagnostic_infos);
  }
};

struct AnonymousIdentityToken {
  static constexpr std::uint32_t encoding_id = 321;
  Text policy_id;
  static constexpr auto members() { return std::tuple(&AnonymousIdentityToken::policy_id); }
};

struct UserNameIdentityToken {
  static constexpr std::uint32_t encoding_id = 324;
  Text policy_id;
  Text user_name;
  Bytes password;
  Text encryption_algorithm;
  static constexpr auto members() {
    return std::tuple(&UserNameIdentityToken::policy_id, &UserNameIdentityToken::user_name,
                      &UserNameIdentityToken::password, &UserNameIdentityToken::encryption_algorithm);
  }
};

struct CloseSessionRequest {
  static constexpr std::uint32_t encoding_id = 473;
  RequestHeader request_header;
  bool delete_subscriptions = false;
  static constexpr auto members() {
    return std::tuple(&CloseSessionRequest::request_header, &CloseSessionRequest::delete_subscriptions);
  }
};

struct CloseSessionResponse {
  static constexpr std::uint32_t encoding_id = 476;
  ResponseHeader response_header;
  static constexpr auto members() { return std::tuple(&CloseSessionResponse::response_header); }
};

struct CancelRequest {
  static constexpr std::uint32_t encoding_id = 479;
  RequestHeader request_header;
  std::uint32_t request_handle = 0;
  static constexpr auto members() { return std::tuple(&CancelRequest::request_header, &CancelRequest::request_handle); }
};

struct CancelResponse {
  static constexpr std::uint32_t encoding_id = 482;
  ResponseHeader response_header;
  std::uint32_t cancel_count = 0;
  static constexpr auto members() {
    return std::tuple(&CancelResponse::response_header, &CancelResponse::cancel_count);
  }
};

}  // namespace takt::opcua
