// SPDX-License-Identifier: Apache-2.0
// Whom a node hears, and what becomes of what they say: a publisher that is refused does not look like one that is
// silent.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "json/type.hpp"
#include "node/socket.hpp"
#include "wire/verdict.hpp"

namespace takt::node {

/// Counts of one sender. Its address and its PublisherId are what it says of itself.
struct HeardSource {
  SenderAddress address;
  std::optional<std::uint64_t> publisher_id;  ///< a number; nothing: none, or a text
  std::array<std::uint64_t, wire::verdict_count> counts{};
  std::int64_t last_ns = 0;   ///< on the node's clock
  std::int64_t sound_ns = 0;  ///< when a message of the group came last that was not refused; 0: none did

  std::uint64_t count(wire::Verdict verdict) const { return counts[wire::index_of(verdict)]; }
  std::uint64_t refused() const;
};
const json::Record& describe(json::Type<HeardSource>);

/// Bounded: whoever sends under ever new names fills one entry for all others.
class SourceTable {
 public:
  static constexpr std::size_t most_sources = 64;

  SourceTable() { sources_.reserve(most_sources); }
  /// True if a source is refused so for the first time; that is worth a line.
  bool count(const Arrival& arrival, wire::Verdict verdict, std::int64_t now_ns);

  /// A PublisherId that messages of the group come under from two addresses, both within ten seconds: two nodes of one
  /// name.
  struct Twins {
    std::uint64_t publisher_id = 0;
    SenderAddress one;
    SenderAddress other;
    bool operator==(const Twins&) const = default;
  };
  std::vector<Twins> twins(std::int64_t now_ns) const;

  /// Those that have a place of their own, and the others, without an address, if there were some.
  std::vector<HeardSource> all() const;

 private:
  HeardSource& find(const SenderAddress& address, std::optional<std::uint64_t> publisher_id, std::int64_t now_ns);

  std::vector<HeardSource> sources_;
  HeardSource others_;
};

/// The PublisherId of a NetworkMessage, if it has one that is a number.
std::optional<std::uint64_t> publisher_id_of(uadp::Octets message);

}  // namespace takt::node
