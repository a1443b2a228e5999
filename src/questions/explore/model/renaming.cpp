// SPDX-License-Identifier: Apache-2.0
#include "explore/model/renaming.hpp"

#include <algorithm>

namespace takt::explore {

Renamings::Renamings(std::size_t slaves, bool symmetry) {
  Renaming renaming;
  for (std::size_t i = 0; i < renaming.to.size(); ++i) renaming.to[i] = static_cast<std::uint8_t>(i);
  const auto first = renaming.to.begin() + 1;
  do {
    all_.push_back(renaming);
  } while (symmetry && std::next_permutation(first, first + static_cast<std::ptrdiff_t>(slaves)));
  then_.resize(all_.size() * all_.size());
  for (std::size_t a = 0; a < all_.size(); ++a) {
    for (std::size_t b = 0; b < all_.size(); ++b) {
      Renaming both;
      for (std::size_t i = 0; i < both.to.size(); ++i) both.to[i] = all_[b].to[all_[a].to[i]];
      then_[a * all_.size() + b] = static_cast<std::size_t>(std::find(all_.begin(), all_.end(), both) - all_.begin());
    }
  }
}

handshake::Word renamed(const handshake::Word& word, const Renaming& renaming) {
  handshake::Word result = word;
  result.intent.origin = renaming.to[word.intent.origin];
  return result;
}

}  // namespace takt::explore
