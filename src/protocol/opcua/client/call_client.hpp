// SPDX-License-Identifier: Apache-2.0
// A client that calls one method of a server, and is done (OPC 10000-4, 5.5, 5.6 and 5.11): Hello, channel, session,
// sign-in, call, and the end of all. Sans-IO: octets and times in, octets out.
//
// The channel signs and encrypts, to the one certificate that the client was given: there is nobody else whom it speaks
// to. Whatever the server answers, it takes bounded memory and time, and what is wrong with it is a problem in words.
#pragma once

#include <memory>
#include <string>

#include "opcua/channel/message_assembler.hpp"
#include "opcua/channel/open_message.hpp"
#include "opcua/server/settings.hpp"
#include "opcua/services/attributes.hpp"
#include "opcua/services/session.hpp"
#include "security/random.hpp"
#include "security/secret.hpp"

namespace takt::opcua {

struct CallClientSettings {
  std::string endpoint_url;     ///< "opc.tcp://host:port"
  std::string application_uri;  ///< that of the client's certificate
  std::string application_name;
  SecurityPolicy policy = SecurityPolicy::Basic256Sha256;
  std::string user;
  security::Secret password;  ///< at most most_password_octets
  sim::Duration within = milliseconds(10'000);
};

class CallClient {
 public:
  /// The connection is there. What is given by reference outlives the client.
  CallClient(const CallClientSettings& settings, const Identity& own, const security::Certificate& server,
             security::RandomOctets& random, CallMethodRequest call, Now now);
  CallClient(const CallClient&) = delete;
  CallClient& operator=(const CallClient&) = delete;

  /// Octets have come, in whatever pieces.
  void received(Octets octets, Now now);
  /// The server has closed the connection, or it is gone.
  void ended();
  /// Too late is too late.
  void advance(Now now);

  /// What waits to be sent. When the client is over, too: a server that hears of the end keeps nothing.
  Octets output() const { return Octets(output_).subspan(taken_); }
  void sent(std::size_t octets) { taken_ += octets; }

  /// The call has been answered, or there is a problem: the connection can be closed when all is sent.
  bool is_over() const { return stage_ == Stage::over; }
  /// Why there is no result; empty if there is one.
  const std::string& problem() const { return problem_; }
  /// The server's answer to the call, which may be that it refuses it.
  const CallMethodResult& result() const { return result_; }
  sim::LocalTime deadline() const { return deadline_; }

 private:
  enum class Stage : std::uint8_t { hello, opening, creating, activating, calling, over };

  void fail(std::string problem);
  void fail(std::string_view what, StatusCode status);
  void take(Octets message, Now now);
  void accept_acknowledge(Octets message, Now now);
  void accept_open(Octets message, Now now);
  void accept_chunk(Octets message, Now now);
  void accept_response(Octets body, Now now);
  void accept_session(Decoder& decoder, Now now);
  bool choose_user_token(const List<EndpointDescription>& endpoints);
  bool sign_in(ActivateSessionRequest& request, const Bytes& server_nonce);
  void accept_result(Decoder& decoder, Now now);

  template <Structure Body>
  void ask(Stage stage, Body body, Now now);
  template <Structure Body>
  bool decoded(Decoder& decoder, Body& body, std::string_view what);
  void close(Now now);

  const CallClientSettings& settings_;
  const Identity& own_;
  const security::Certificate& server_;
  security::RandomOctets& random_;
  const PolicyInfo& policy_;
  CallMethodRequest call_;
  Stage stage_ = Stage::hello;
  sim::LocalTime deadline_;
  MessageSplitter splitter_;
  MessageAssembler assembler_;
  SendLimits limits_;
  std::vector<std::byte> nonce_;  ///< of the channel, then of the session
  std::unique_ptr<SecureChannel> channel_;
  std::uint32_t request_ = 0;  ///< the last one, which waits for its answer
  NodeId token_;               ///< of the session
  Text user_policy_id_;
  std::string user_policy_uri_;
  CallMethodResult result_;
  std::string problem_;
  std::vector<std::byte> output_;
  std::size_t taken_ = 0;
};

}  // namespace takt::opcua
