// SPDX-License-Identifier: Apache-2.0
// Renamings of slaves: the permutations under which a group of equal slaves looks the same.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "explore/model/query.hpp"
#include "handshake/word.hpp"

namespace takt::explore {

/// to[i] is the new index of participant i; the master keeps 0.
struct Renaming {
  std::array<std::uint8_t, most_slaves + 1> to{};
  constexpr bool operator==(const Renaming&) const = default;
};

/// All permutations of the slaves, or the identity alone; the identity comes first.
class Renamings {
 public:
  Renamings(std::size_t slaves, bool symmetry);

  std::size_t size() const { return all_.size(); }
  const Renaming& operator[](std::size_t i) const { return all_[i]; }
  /// The position of "first a, then b".
  std::size_t then(std::size_t a, std::size_t b) const { return then_[a * all_.size() + b]; }

 private:
  std::vector<Renaming> all_;
  std::vector<std::size_t> then_;
};

/// The word as it would be if the slaves had the other names.
handshake::Word renamed(const handshake::Word& word, const Renaming& renaming);

}  // namespace takt::explore
