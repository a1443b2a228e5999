// SPDX-License-Identifier: Apache-2.0
// What the checker finds: texts with time, place and frame.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "models/ethernet/frame.hpp"
#include "tests/wire_checker/list_machine.hpp"

namespace takt::wire_checker {

class Violations {
 public:
  /// The first ones are kept as text; all are counted.
  static constexpr std::size_t most_kept = 20;

  void add(Ps time, const std::string& place, const std::string& what) {
    if (texts_.size() < most_kept) texts_.push_back(std::to_string(time) + " ps, " + place + ": " + what);
    ++count_;
  }
  std::size_t count() const { return count_; }
  const std::vector<std::string>& texts() const { return texts_; }
  std::string all() const {
    std::string text;
    for (const std::string& line : texts_) text += line + "\n";
    if (count_ > texts_.size()) text += "... " + std::to_string(count_) + " in all\n";
    return text;
  }

 private:
  std::vector<std::string> texts_;
  std::size_t count_ = 0;
};

/// "stream 3 frame 17".
inline std::string name_of(models::StreamIndex stream, std::uint64_t sequence) {
  return "stream " + std::to_string(stream.value) + " frame " + std::to_string(sequence);
}

}  // namespace takt::wire_checker
