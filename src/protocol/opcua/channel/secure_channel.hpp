// SPDX-License-Identifier: Apache-2.0
// One secure channel as one of its sides has it (OPC 10000-4, 5.5; OPC 10000-6, 6.7): tokens, keys, sequence numbers.
// Sans-IO: chunks and times in, chunks out.
#pragma once

#include "opcua/channel/chunk.hpp"
#include "security/random.hpp"
#include "sim/time.hpp"

namespace takt::opcua {

/// A chunk that has been opened, and which all checks let pass.
struct OpenedChunk {
  ChunkKind kind = ChunkKind::Final;
  SequenceHeader sequence;
  Octets body;  ///< lasts as long as the chunk
};

/// Of what a channel sends, by HEL and ACK.
struct SendLimits {
  std::size_t chunk_octets = least_buffer_octets;
  std::size_t message_octets = 0;  ///< 0: any
  std::size_t chunks = 0;          ///< 0: any
};

/// How long tokens live. One is taken for a quarter longer than it was promised, for the clocks of both differ.
struct TokenLifetimes {
  sim::Duration least = sim::Duration::from_ps(10'000'000'000'000);
  sim::Duration most = sim::Duration::from_ps(3'600'000'000'000'000);
};

/// Which end of a channel this is.
enum class Side : std::uint8_t { server, client };

class SecureChannel {
 public:
  /// The other side's first OPN has been opened and is sound: with these numbers in it. `other` is its certificate, if
  /// the policy has one; `sent` the last number of our own.
  SecureChannel(std::uint32_t id, const ChannelSecurity& security, std::optional<security::Certificate> other,
                std::uint32_t first_sequence_number, Side side = Side::server, std::uint32_t sent = 0);

  std::uint32_t id() const { return id_; }
  const ChannelSecurity& security() const { return security_; }
  /// Null without a policy.
  const security::Certificate* client_certificate() const { return other_ ? &*other_ : nullptr; }

  /// The server issues a token, the first one or a renewed one. Its keys are of the two nonces, which are empty without
  /// a policy.
  ChannelSecurityToken issue(sim::LocalTime now, DateTime utc, std::uint32_t requested_ms,
                             const TokenLifetimes& lifetimes, Octets client_nonce, Octets server_nonce);

  /// The client takes the token that the server has issued.
  void take(const ChannelSecurityToken& token, sim::LocalTime now, Octets client_nonce, Octets server_nonce);

  /// A MSG or CLO, decrypted in place. Good, or what an ERR says of it: then the connection ends. The old token is
  /// refused when the new one has been used.
  StatusCode open(std::span<std::byte> chunk, sim::LocalTime now, OpenedChunk& opened);
  /// The sequence number of an OPN that renews.
  StatusCode accept_sequence_number(std::uint32_t number);

  /// Puts a message into chunks behind `out`. False if it is longer than the limits allow: nothing is written then.
  bool seal_message(std::uint32_t request_id, Octets body, const SendLimits& limits, std::vector<std::byte>& out,
                    MessageType type = MessageType::Message);
  /// The sequence header of an OPN response.
  SequenceHeader next_sequence(std::uint32_t request_id) { return {++sent_, request_id}; }

  /// No token lives any more from then on.
  sim::LocalTime ends() const;

 private:
  struct Token {
    std::uint32_t id = 0;
    sim::LocalTime ends;
    std::optional<TokenKeys> keys;
  };

  ChunkKeys& own(TokenKeys& keys) const { return side_ == Side::server ? keys.server : keys.client; }
  ChunkKeys& of_other(TokenKeys& keys) const { return side_ == Side::server ? keys.client : keys.server; }

  Side side_;
  std::uint32_t id_;
  ChannelSecurity security_;
  std::optional<security::Certificate> other_;
  std::optional<Token> used_;
  std::optional<Token> next_;  ///< issued by the server, and not used by the client yet
  std::uint32_t last_token_ = 0;
  std::uint32_t received_;
  std::uint32_t sent_;
};

}  // namespace takt::opcua
