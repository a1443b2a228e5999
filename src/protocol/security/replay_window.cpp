// SPDX-License-Identifier: Apache-2.0
#include "security/replay_window.hpp"

#include <algorithm>

#include "security/key_ring.hpp"

namespace takt::security {
namespace {

constexpr std::size_t most_probes = 64;
constexpr std::uint32_t quarter = 0x4000'0000;  // OPC 10000-14, 7.2.3: what is newer is less than that ahead

std::size_t place_of(const StreamKey& stream) {
  std::uint64_t hash =
      (stream.publisher ^ std::uint64_t{stream.writer_group} << 48 ^ std::uint64_t{stream.sender} << 32) *
      0x9E37'79B9'7F4A'7C15U;
  return static_cast<std::size_t>(hash >> 32);
}

}  // namespace

bool Freshness::is_newer_than(const Freshness& other) const {
  if (token != other.token) return other.token == 0 || is_later_token(token, other.token);
  if (life != other.life) return static_cast<std::int16_t>(static_cast<std::uint16_t>(life - other.life)) > 0;
  const std::uint32_t ahead = number - 1 - other.number;
  return ahead < quarter;
}

StoredWindow* ReplayMemory::find(const StreamKey& stream, std::uint32_t token) {
  StoredWindow* outdated = nullptr;
  for (std::size_t i = 0; i < std::min(most_probes, windows_.size()); ++i) {
    StoredWindow& window = windows_[(place_of(stream) + i) % windows_.size()];
    if (window.is_used == 0) return &(window = {stream.publisher, stream.writer_group, stream.sender, 1, 0, 0, {}});
    if (window.publisher == stream.publisher && window.writer_group == stream.writer_group &&
        window.sender == stream.sender)
      return &window;
    // Two tokens back no key is taken any more, so nothing of that window can come again.
    const Freshness& newest = window.newest[window.valid & 1U];
    if (outdated == nullptr && is_later_token(token, next_token(next_token(newest.token)))) outdated = &window;
  }
  return outdated == nullptr ? nullptr
                             : &(*outdated = {stream.publisher, stream.writer_group, stream.sender, 1, 0, 0, {}});
}

bool ReplayMemory::take(const StreamKey& stream, const Freshness& freshness) {
  StoredWindow* const window = find(stream, freshness.token);
  if (window == nullptr) return false;
  const std::uint8_t valid = window->valid & 1U;
  if (!freshness.is_newer_than(window->newest[valid])) return false;
  window->newest[valid ^ 1U] = freshness;
  *static_cast<volatile std::uint8_t*>(&window->valid) = valid ^ 1U;
  return true;
}

}  // namespace takt::security
