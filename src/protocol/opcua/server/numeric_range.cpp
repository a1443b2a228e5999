// SPDX-License-Identifier: Apache-2.0
#include "opcua/server/numeric_range.hpp"

#include <algorithm>
#include <charconv>

namespace takt::opcua {
namespace {

struct Range {
  std::size_t first = 0;
  std::size_t last = 0;
};

std::optional<std::size_t> number_of(std::string_view text) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::optional<Range> range_of(std::string_view text) {
  const std::size_t colon = text.find(':');
  const auto first = number_of(text.substr(0, colon));
  const auto last = colon == std::string_view::npos ? first : number_of(text.substr(colon + 1));
  if (!first || !last || (colon != std::string_view::npos && *last <= *first)) return std::nullopt;
  return Range{*first, *last};
}

/// Of a vector or a string; false if nothing is there.
template <class Sequence>
bool keep(Sequence& sequence, const Range& range) {
  if (range.first >= sequence.size()) return false;
  const auto begin = sequence.begin() + static_cast<std::ptrdiff_t>(range.first);
  const auto end = sequence.begin() + static_cast<std::ptrdiff_t>(std::min(range.last + 1, sequence.size()));
  sequence = Sequence(begin, end);
  return true;
}

}  // namespace

StatusCode cut(Variant& value, std::string_view text) {
  if (text.empty()) return StatusCode::Good;
  std::size_t dimensions = 1;
  std::optional<Range> range;
  for (std::string_view rest = text;; ++dimensions) {
    const std::size_t comma = rest.find(',');
    range = range_of(rest.substr(0, comma));
    if (!range) return StatusCode::BadIndexRangeInvalid;
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (dimensions > 1) return StatusCode::BadIndexRangeNoData;
  bool is_there = false;
  if (value.is_array) {
    is_there = keep(value.values, *range);
  } else if (!value.values.empty()) {
    if (auto* const string = std::get_if<Text>(&value.values.front())) is_there = keep(string->value, *range);
    if (auto* const octets = std::get_if<Bytes>(&value.values.front())) is_there = keep(octets->value, *range);
  }
  return is_there ? StatusCode::Good : StatusCode::BadIndexRangeNoData;
}

}  // namespace takt::opcua
