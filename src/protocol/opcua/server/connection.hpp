// SPDX-License-Identifier: Apache-2.0
// One connection of a client: what has come of it, what waits to go, and its channel.
#pragma once

#include <deque>
#include <memory>

#include "opcua/channel/message_assembler.hpp"
#include "opcua/server/session.hpp"
#include "opcua/transport/message.hpp"

namespace takt::opcua {

/// A request that has come whole and waits for its turn; or a CLO behind those before it.
struct WaitingRequest {
  std::uint32_t id = 0;
  std::vector<std::byte> message;
  bool is_close = false;
};

/// An OPN of a client who is trusted, which waits for the private key.
struct WaitingOpen {
  std::vector<std::byte> message;
  std::size_t clear_from = 0;
  const PolicyInfo* policy = nullptr;
  security::Certificate client;
  std::uint64_t number = 0;  ///< one more with each
};

struct Connection {
  enum class Stage : std::uint8_t { hello, opening, open, closing };

  ConnectionId id = 0;
  std::string source;   ///< "127.0.0.1:53412", for logs
  std::string account;  ///< whose turn its requests are: the host, or who has signed in
  std::string url;      ///< as its HEL has it
  Stage stage = Stage::hello;
  MessageSplitter splitter{least_buffer_octets};
  SendLimits send;
  std::unique_ptr<SecureChannel> channel;
  MessageAssembler assembler;
  sim::LocalTime opened;
  sim::LocalTime deadline;  ///< by then it must have come further; moves on with what it does
  std::vector<std::byte> output;
  std::size_t taken = 0;                ///< octets of `output` that are gone
  std::deque<WaitingRequest> requests;  ///< in the order in which they have come
  std::size_t waiting_octets = 0;       ///< of `requests`
  std::uint64_t served = 0;             ///< number of its last request among all
  std::optional<WaitingOpen> opening;
  std::shared_ptr<OctetAccount> counts_for;  ///< of its session; null: its buffers are short instead
  HeldOctets held;
  sim::LocalTime progress;  ///< when the client took something last, or when `output` was empty

  std::size_t waiting() const { return output.size() - taken; }
  void put(Octets octets) { output.insert(output.end(), octets.begin(), octets.end()); }
};

}  // namespace takt::opcua
