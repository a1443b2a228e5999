// SPDX-License-Identifier: Apache-2.0
#include "json/suggest.hpp"

#include <algorithm>
#include <array>

namespace takt::json {

namespace {

constexpr std::size_t longest_name = 64;
constexpr std::size_t most_candidates = 2000;
constexpr std::size_t shortest_prefix = 3;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool equal_but_for_case(std::string_view a, std::string_view b) { return std::ranges::equal(a, b, {}, lower, lower); }

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t limit) {
  const std::size_t difference = a.size() > b.size() ? a.size() - b.size() : b.size() - a.size();
  if (difference > limit || a.size() > longest_name || b.size() > longest_name) return limit + 1;

  // Three rows of the table of distances between prefixes: of a up to i - 2, i - 1 and i.
  using Row = std::array<std::size_t, longest_name + 1>;
  Row before_last{}, last{}, current{};
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replacement = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({replacement, last[j] + 1, current[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        current[j] = std::min(current[j], before_last[j - 2] + 1);
    }
    before_last = last;
    last = current;
  }
  return std::min(last[b.size()], limit + 1);
}

std::string suggest(std::string_view name, std::span<const std::string_view> candidates) {
  if (name.empty() || name.size() > longest_name) return {};
  const std::size_t threshold = name.size() <= 3 ? 1 : name.size() <= 7 ? 2 : 3;
  std::size_t nearest = threshold + 1;
  std::size_t examined = 0;
  std::string_view best;
  for (const std::string_view candidate : candidates) {
    if (candidate.size() > name.size() + threshold || candidate.size() + threshold < name.size()) continue;
    if (++examined > most_candidates) break;
    if (equal_but_for_case(name, candidate)) return std::string(candidate);
    const std::size_t distance = edit_distance(name, candidate, threshold);
    // A candidate that shares no octet with the name is no help, however short both are.
    if (distance < nearest && distance < std::max(name.size(), candidate.size())) {
      nearest = distance;
      best = candidate;
    }
  }
  if (best.empty() && name.size() >= shortest_prefix) {
    const auto longer = std::ranges::find_if(candidates, [name](std::string_view c) { return c.starts_with(name); });
    if (longer != candidates.end()) best = *longer;
  }
  return std::string(best);
}

}  // namespace takt::json
