// SPDX-License-Identifier: Apache-2.0
// What may stand in a sampled register, without saying when its sender published.
//
// A register holds the last published word. Its sender publishes at any time, so what the receiver samples next is one
// of: the word that it sampled last (nothing was published since), or any word that the sender has had since then.
// These words are the value, oldest first; the last one is the sender's word of now, if that is up. So publishing is no
// step of its own, and each order of publishing and sampling has its order of samples here, and the other way round
// (parts/README.md, step 3).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "explore/model/hash_index.hpp"
#include "explore/model/members.hpp"

namespace takt::explore {

class Said {
 public:
  std::size_t size() const { return words_.size(); }
  WordId operator[](std::size_t i) const { return words_[i]; }
  WordId last() const { return words_.empty() ? no_word : words_.back(); }

  /// The sender has another word.
  void append(WordId word) {
    if (last() != word) words_.push_back(word);
  }
  /// The register holds this one; what the sender said before can be heard no more.
  void hold(std::size_t i, bool sender_is_up) {
    const WordId held = words_[i];
    const WordId now = last();
    words_.clear();
    append(held);
    if (sender_is_up) append(now);
  }
  /// All that may stand in one of both registers, whose senders say the same now. `keeps_first`: both hold the same
  /// word.
  void join(const Said& other, bool sender_is_up, bool keeps_first) {
    const std::ptrdiff_t first = keeps_first ? 1 : 0;
    const std::ptrdiff_t last_words = sender_is_up ? 1 : 0;
    std::vector<WordId> all;
    const auto add = [&](const std::vector<WordId>& words) {
      if (words.size() >= static_cast<std::size_t>(first + last_words))
        all.insert(all.end(), words.begin() + first, words.end() - last_words);
    };
    add(words_);
    add(other.words_);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    const WordId now = last();
    const WordId held = words_.empty() ? no_word : words_.front();
    words_.clear();
    if (keeps_first) append(held);
    for (const WordId word : all)
      if (!(keeps_first && word == held) && !(sender_is_up && word == now)) append(word);
    if (sender_is_up) append(now);
  }

  bool operator==(const Said&) const = default;
  std::uint64_t hash() const {
    std::uint64_t digest = words_.size();
    for (const WordId word : words_) digest = mixed(digest ^ word);
    return digest;
  }

 private:
  std::vector<WordId> words_;
};

struct HashOfSaid {
  std::size_t operator()(const Said& said) const { return said.hash(); }
};

}  // namespace takt::explore
