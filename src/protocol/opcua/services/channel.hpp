// SPDX-License-Identifier: Apache-2.0
// OpenSecureChannel and CloseSecureChannel (OPC 10000-4, 5.5; OPC 10000-6, 6.7.4).
#pragma once

#include "opcua/services/headers.hpp"

namespace takt::opcua {

enum class SecurityTokenRequestType : std::int32_t { Issue, Renew };
enum class MessageSecurityMode : std::int32_t { Invalid, None, Sign, SignAndEncrypt };

struct OpenSecureChannelRequest {
  static constexpr std::uint32_t encoding_id = 446;
  RequestHeader request_header;
  std::uint32_t client_protocol_version = 0;
  SecurityTokenRequestType request_type = SecurityTokenRequestType::Issue;
  MessageSecurityMode security_mode = MessageSecurityMode::Invalid;
  Bytes client_nonce;
  std::uint32_t requested_lifetime = 0;
  static constexpr auto members() {
    return std::tuple(&OpenSecureChannelRequest::request_header, &OpenSecureChannelRequest::client_protocol_version,
                      &OpenSecureChannelRequest::request_type, &OpenSecureChannelRequest::security_mode,
                      &OpenSecureChannelRequest::client_nonce, &OpenSecureChannelRequest::requested_lifetime);
  }
};

struct ChannelSecurityToken {
  static constexpr std::uint32_t encoding_id = 443;
  std::uint32_t channel_id = 0;
  std::uint32_t token_id = 0;
  DateTime created_at;
  std::uint32_t revised_lifetime = 0;
  static constexpr auto members() {
    return std::tuple(&ChannelSecurityToken::channel_id, &ChannelSecurityToken::token_id,
                      &ChannelSecurityToken::created_at, &ChannelSecurityToken::revised_lifetime);
  }
};

struct OpenSecureChannelResponse {
  static constexpr std::uint32_t encoding_id = 449;
  ResponseHeader response_header;
  std::uint32_t server_protocol_version = 0;
  ChannelSecurityToken security_token;
  Bytes server_nonce;
  static constexpr auto members() {
    return std::tuple(&OpenSecureChannelResponse::response_header, &OpenSecureChannelResponse::server_protocol_version,
                      &OpenSecureChannelResponse::security_token, &OpenSecureChannelResponse::server_nonce);
  }
};

struct CloseSecureChannelRequest {
  static constexpr std::uint32_t encoding_id = 452;
  RequestHeader request_header;
  static constexpr auto members() { return std::tuple(&CloseSecureChannelRequest::request_header); }
};

}  // namespace takt::opcua
