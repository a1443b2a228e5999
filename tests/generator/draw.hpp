// SPDX-License-Identifier: Apache-2.0
// What chance decides about a scenario that is made at random.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/random.hpp"

namespace takt::generator {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : chance_(seed, "generator", "scenario") {}

  /// 0 to n - 1. Precondition: n > 0.
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(chance_.below(n)); }
  std::size_t between(std::size_t least, std::size_t most) { return least + below(most - least + 1); }
  bool one_in(std::size_t n) { return below(n) == 0; }
  bool percent(int share) { return below(100) < static_cast<std::size_t>(share); }
  template <class T>
  const T& any(const std::vector<T>& values) {
    return values[below(values.size())];
  }
  /// One of the words of a text.
  std::string word(std::string_view words);
  template <class T>
  void shuffle(std::vector<T>& values) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[below(i)]);
  }
  /// So many of them, in their order; all if they are fewer.
  template <class T>
  std::vector<T> some(const std::vector<T>& values, std::size_t count) {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < values.size(); ++i) numbers.push_back(i);
    while (numbers.size() > count) numbers.erase(numbers.begin() + static_cast<std::ptrdiff_t>(below(numbers.size())));
    std::vector<T> taken;
    for (const std::size_t i : numbers) taken.push_back(values[i]);
    return taken;
  }

 private:
  sim::RandomStream chance_;
};

std::vector<std::string> words_of(std::string_view text);

}  // namespace takt::generator
