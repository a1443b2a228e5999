// SPDX-License-Identifier: Apache-2.0
// Arrivals at a reader's history, made by hand.
#pragma once

#include "dds/history/reader_history.hpp"

namespace takt::dds {

inline constexpr sim::LocalTime start = sim::LocalTime::from_ps(0);
inline constexpr InstanceKey a{1};
inline constexpr InstanceKey b{2};

inline Guid writer(std::uint8_t number) { return {{{number}}, EntityId::user(1, EntityKind::writer_with_key)}; }

/// Feeds a history with samples whose payload is one octet.
struct Feed {
  explicit Feed(const ReaderHistory::Settings& settings) : history(settings) {}

  Admission add(std::uint8_t from, const InstanceKey& key, int value, sim::LocalTime now, std::int32_t strength = 0,
                ChangeKind kind = ChangeKind::alive) {
    return add_stamped(from, key, value, now, now, strength, kind);
  }
  Admission add_stamped(std::uint8_t from, const InstanceKey& key, int value, sim::LocalTime source, sim::LocalTime now,
                        std::int32_t strength = 0, ChangeKind kind = ChangeKind::alive,
                        sim::LocalTime expires = sim::LocalTime::never()) {
    const std::byte octet{static_cast<unsigned char>(value)};
    return history.add({writer(from), strength, SequenceNumber{++numbers[from]}, kind, key, source, expires,
                        Octets(&octet, kind == ChangeKind::alive ? 1 : 0)},
                       now);
  }
  /// The values that are there, taken; -1 stands for a sample without data.
  std::vector<int> drain_all(sim::LocalTime now = start) {
    std::vector<int> all;
    while (const std::optional<Sample> sample = history.take(now))
      all.push_back(sample->info.valid_data ? std::to_integer<int>(sample->payload.at(0)) : -1);
    return all;
  }

  ReaderHistory history;
  std::map<std::uint8_t, std::int64_t> numbers;
};

}  // namespace takt::dds
