// SPDX-License-Identifier: Apache-2.0
#include "results/behaviour.hpp"

#include <fmt/format.h>

#include <iterator>

#include "results/version.hpp"

namespace takt::results {
namespace {

constexpr std::string_view changes[] = {
#include "results/behaviours.inc"
};
constexpr std::uint32_t most_changes_shown = 3;

/// What has changed since an older number, the last changes if there are many.
std::string changes_since(std::uint32_t older) {
  const auto now = static_cast<std::uint32_t>(std::size(changes));
  std::uint32_t first = older + 1;
  std::string text;
  if (first + most_changes_shown <= now) {
    text = fmt::format("{} changes, ", now - older);
    first = now - most_changes_shown + 1;
  }
  for (std::uint32_t number = first; number <= now; ++number)
    text += fmt::format("{}{}: {}", number == first ? "" : "; ", number, changes[number - 1]);
  return text;
}

}  // namespace

std::uint32_t behaviour() { return static_cast<std::uint32_t>(std::size(changes)); }

Maker this_takt() { return {version, behaviour()}; }

std::string name_of(const Maker& maker) {
  return fmt::format("takt {} {}", maker.version,
                     maker.behaviour == 0 ? std::string("without a number of behaviour")
                                          : fmt::format("with behaviour {}", maker.behaviour));
}

std::string difference_to(const Maker& maker, std::string_view file) {
  if (maker.behaviour == behaviour()) return {};
  std::string text = fmt::format("{} was made by {}, this is {}", file, name_of(maker), name_of(this_takt()));
  if (maker.behaviour > 0 && maker.behaviour < behaviour())
    text += fmt::format(" (since then: {})", changes_since(maker.behaviour));
  return text;
}

}  // namespace takt::results
