// SPDX-License-Identifier: Apache-2.0
#include "explore/model/recording.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::explore {

std::size_t Recording::say(WordId word, std::uint8_t life) {
  if (says(word, life)) return size_;
  TAKT_CHECK(size_ < most_recorded, "what is recorded of a run is bounded: allow fewer calls or faults");
  entries_[size_++] = {word, token_, life};
  return size_;
}

void Recording::take(std::size_t hearer, std::size_t place) {
  taken_[hearer] = std::max(taken_[hearer], static_cast<std::uint8_t>(place));
}

security::Freshness Recording::freshness(std::size_t place) const {
  const Recorded& entry = entries_[place - 1];
  return {entry.token + 1U, static_cast<std::uint32_t>(place), entry.life};
}

bool Recording::takes(std::size_t hearer, std::size_t place, std::uint8_t token) const {
  if (place == 0 || !is_known_key(entries_[place - 1].token, token)) return false;
  const std::size_t newest = taken_[hearer];
  return newest == 0 || place == newest || freshness(place).is_newer_than(freshness(newest));
}

void Recording::forget(std::uint32_t hearers) {
  std::uint8_t least = size_;
  for (std::size_t i = 0; i < most_participants; ++i)
    if (((hearers >> i) & 1U) != 0) least = std::min(least, taken_[i]);
  if (least < 2) return;
  const auto gone = static_cast<std::uint8_t>(least - 1);  // the last one that all have taken may come again
  std::copy(entries_.begin() + gone, entries_.begin() + size_, entries_.begin());
  std::fill(entries_.begin() + (size_ - gone), entries_.begin() + size_, Recorded{});
  size_ = static_cast<std::uint8_t>(size_ - gone);
  for (std::size_t i = 0; i < most_participants; ++i) {
    if (((hearers >> i) & 1U) == 0) continue;
    taken_[i] = static_cast<std::uint8_t>(taken_[i] - gone);
    standing_[i] = static_cast<std::uint8_t>(standing_[i] - std::min(standing_[i], gone));
  }
}

std::uint64_t Recording::hash() const {
  std::uint64_t digest = mixed(std::uint64_t{size_} << 8 | token_);
  for (std::size_t i = 0; i < most_participants; ++i)
    digest = mixed(digest ^ (std::uint64_t{standing_[i]} << 8 | taken_[i]));
  for (std::size_t i = 0; i < size_; ++i)
    digest = mixed(digest ^
                   (std::uint64_t{entries_[i].word} << 16 | std::uint64_t{entries_[i].token} << 8 | entries_[i].life));
  return digest;
}

}  // namespace takt::explore
