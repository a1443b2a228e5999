// SPDX-License-Identifier: Apache-2.0
// Chunks that have been opened, put together to messages again.
#pragma once

#include <utility>

#include "opcua/channel/secure_channel.hpp"

namespace takt::opcua {

/// The chunks of one message are put together; a second one is not begun before the first has ended.
class MessageAssembler {
 public:
  enum class Verdict : std::uint8_t { more, complete, dropped, too_large, mixed };
  Verdict take(const OpenedChunk& chunk, std::size_t most_octets, std::size_t most_chunks);
  /// The whole message, once.
  std::vector<std::byte> accept_message() { return std::exchange(collected_, {}); }
  /// Octets that wait for the rest of their message.
  std::size_t held() const { return collected_.size(); }

 private:
  std::vector<std::byte> collected_;
  std::uint32_t request_id_ = 0;
  std::size_t chunks_ = 0;  ///< 0: nothing has begun
};

}  // namespace takt::opcua
