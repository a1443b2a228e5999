// One connection of a client: what has come of it, what waits to go, and its channel.
#pragma once

#include <memory>

#include "opcua/channel/message_assembler.hpp"
#include "opcua/server/session.hpp"
#include "opcua/transport/message.hpp"

namespace takt::opcua {

struct Connection {
  enum class Stage : std::uint8_t { hello, opening, open, closing };

  ConnectionId id = 0;
  std::string source;                        ///< "127.0.0.1:53412", for logs
  std::string url;                           ///< as its HEL has it
  Stage stage = Stage::hello;
  MessageSplitter splitter{least_buffer_octets};
  SendLimits send;
  std::unique_ptr<SecureChannel> channel;
  MessageAssembler assembler;
  sim::LocalTime opened;
  sim::LocalTime deadline;                   ///< by then it must have come further; moves on with what it does
  std::vector<std::byte> output;
  std::size_t taken = 0;                     ///< octets of `output` that are gone
  sim::LocalTime progress;                   ///< when the client took something last, or when `output` was empty

  std::size_t waiting() const { return output.size() - taken; }
  void put(Octets octets) { output.insert(output.end(), octets.begin(), octets.end()); }
};

}  // namespace takt::opcua
