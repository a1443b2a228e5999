// One connection of a client: what has come of it, what waits to go, and its channel.
#pragma once

#include <memory>

#include "opcua/server/session.hpp"
#include "opcua/transport/message.hpp"

namespace takt::opcua {

/// The chunks of one message are put together; a second one is not begun before the first has ended.
class MessageAssembler {
 public:
  enum class Verdict : std::uint8_t { more, complete, dropped, too_large, mixed };
  Verdict take(const OpenedChunk& chunk, std::size_t most_octets, std::size_t most_chunks);
  /// The whole message, until the next chunk.
  Octets message() const { return collected_; }

 private:
  std::vector<std::byte> collected_;
  std::uint32_t request_id_ = 0;
  std::size_t chunks_ = 0;  ///< 0: nothing has begun
};

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
