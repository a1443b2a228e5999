// SPDX-License-Identifier: Apache-2.0
// Which secured messages have come of whom: nothing is taken twice, and nothing that is older than what was taken.
#pragma once

#include <cstdint>
#include <span>

namespace takt::security {

/// What the numbers in nonces of a stream are compared by: token, then the life of its sender, then the number. Each in
/// the order of serial numbers.
struct Freshness {
  std::uint32_t token = 0;  ///< 0: nothing has come
  std::uint32_t number = 0;
  std::uint16_t life = 0;
  bool operator==(const Freshness&) const = default;
  bool is_newer_than(const Freshness& other) const;
};

/// Whose window it is.
struct StreamKey {
  std::uint64_t publisher = 0;  ///< its PublisherId with its type
  std::uint16_t writer_group = 0;
  std::uint16_t sender = 0;  ///< the node, where one PublisherId goes from one to another; 0: all the same
  bool operator==(const StreamKey&) const = default;
};

/// One window. It is written in two steps, so that a process that is killed in between leaves a sound one: plain
/// octets, which may stand in a file.
struct StoredWindow {
  std::uint64_t publisher = 0;
  std::uint16_t writer_group = 0;
  std::uint16_t sender = 0;
  std::uint8_t is_used = 0;
  std::uint8_t valid = 0;  ///< which of the two below
  std::uint16_t reserved = 0;
  Freshness newest[2];
};
static_assert(sizeof(StoredWindow) == 40);

/// Windows of all streams, in octets that somebody else owns (a file that outlives the process, or memory). Only what
/// is signed has a window, so that only holders of keys can fill it.
class ReplayMemory {
 public:
  static constexpr std::size_t most_streams = 1024;

  /// As many windows as are there; all zeros is an empty memory.
  explicit ReplayMemory(std::span<StoredWindow> windows) : windows_(windows) {}

  /// True, and it is the newest now, if it is newer than all that has come of the stream. False also where there is no
  /// room for another stream.
  bool take(const StreamKey& stream, const Freshness& freshness);

 private:
  StoredWindow* find(const StreamKey& stream, std::uint32_t token);

  std::span<StoredWindow> windows_;
};

}  // namespace takt::security
