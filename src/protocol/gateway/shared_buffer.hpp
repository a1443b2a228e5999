// SPDX-License-Identifier: Apache-2.0
// The designated buffer between the half of a gateway that receives and the half that sends: each goes at its own rate.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/time.hpp"
#include "uadp/octets.hpp"

namespace takt::gateway {

using uadp::Octets;

/// What happens to a value for which there is no room.
enum class Overflow : std::uint8_t {
  overwrite_oldest,  ///< it takes the place of the one that has waited longest
  drop_newest,       ///< it is dropped
  keep_latest,       ///< the buffer holds one value, the last; capacity says nothing
};

struct BufferSettings {
  std::size_t capacity = 1;  ///< values; at least 1
  Overflow overflow = Overflow::overwrite_oldest;
  std::optional<sim::Duration> stale_after = {};  ///< a value that is older when it is its turn is not sent
};

/// What became of values. Those received are all the others together and those that wait.
struct BufferFigures {
  std::uint64_t received = 0;
  std::uint64_t forwarded = 0;
  std::uint64_t overwritten = 0;
  std::uint64_t dropped = 0;
  std::uint64_t stale = 0;
  bool operator==(const BufferFigures&) const = default;
};

/// How long values that were forwarded have waited.
struct AgeFigures {
  std::uint64_t count = 0;
  sim::Duration least;
  sim::Duration greatest;
  sim::int128 sum_ps = 0;  ///< many values that wait together outgrow 106 days soon
  void add(sim::Duration age);
  sim::Duration mean() const {
    return count == 0 ? sim::Duration()
                      : sim::Duration::from_ps(static_cast<std::int64_t>(sum_ps / static_cast<sim::int128>(count)));
  }
  bool operator==(const AgeFigures&) const = default;
};

/// First in, first out. Octets are copied; nothing allocates once every place has held a value of full length.
class SharedBuffer {
 public:
  explicit SharedBuffer(const BufferSettings& settings);

  struct Value {
    Octets octets;         ///< valid until the next push
    sim::LocalTime since;  ///< when it was received
  };

  /// A value has been received.
  void push(Octets octets, sim::LocalTime now);
  /// The value whose turn it is, which leaves the buffer; stale ones before it leave too. Nothing if none is left.
  std::optional<Value> pull(sim::LocalTime now);

  std::size_t waiting() const { return waiting_; }
  const BufferSettings& settings() const { return settings_; }
  const BufferFigures& figures() const { return figures_; }
  const AgeFigures& age() const { return age_; }

 private:
  struct Place {
    std::vector<std::byte> octets;
    sim::LocalTime since;
  };
  void leave();

  BufferSettings settings_;
  std::vector<Place> places_;
  std::size_t first_ = 0;  ///< place of the oldest
  std::size_t waiting_ = 0;
  BufferFigures figures_;
  AgeFigures age_;
};

}  // namespace takt::gateway
