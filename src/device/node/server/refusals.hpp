// SPDX-License-Identifier: Apache-2.0
// What a server says of those whom it refuses, as a value: the first of a host and a kind at once, then now and then
// how many more. Time is passed in.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "opcua/server/budget.hpp"

namespace takt::node {

class Refusals {
 public:
  /// The line that is to be said now, if one is: the same is said once, other details of the same kind five times, and
  /// then again after a minute of silence.
  std::optional<std::string> take(const std::string& host, const std::string& what, const std::string& detail,
                                  sim::LocalTime now);
  /// The next line of those that were only counted, a minute after the last one of their host and kind.
  std::optional<std::string> due(sim::LocalTime now);
  std::uint64_t count() const { return count_; }

 private:
  static constexpr std::size_t most_entries = 256;
  static constexpr sim::Duration quiet = sim::Duration::from_ps(60'000'000'000'000);
  struct Entry {
    std::uint64_t untold = 0;
    sim::LocalTime told;
    std::uint64_t told_in_a_row = 0;
    std::string last;  ///< detail that was told last
  };
  using Entries = std::map<std::pair<std::string, std::string>, Entry>;
  void make_room();

  Entries entries_;              ///< by host and kind
  std::uint64_t forgotten_ = 0;  ///< of entries that had to go
  std::uint64_t count_ = 0;
};

}  // namespace takt::node
