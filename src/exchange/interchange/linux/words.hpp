// SPDX-License-Identifier: Apache-2.0
// The words of one command of Linux, taken one after the other.
#pragma once

#include <charconv>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "interchange/linux/script.hpp"
#include "json/node.hpp"

namespace takt::interchange::linux_tc {

/// The words of one command, taken one after the other.
class Words {
 public:
  Words(const Command& command, json::Diagnostics& diagnostics) : command_(command), diagnostics_(diagnostics) {}

  bool at_end() const { return next_ == command_.size(); }
  const Word& peek() const { return command_[next_]; }
  bool is_next(std::string_view text) const { return !at_end() && peek().text == text; }
  bool read_if(std::string_view text) {
    if (!is_next(text)) return false;
    ++next_;
    return true;
  }
  const Word& take() { return command_[next_++]; }
  /// The next word; empty, and reported, if there is none.
  Word parse_value(const std::string& expected) {
    if (!at_end()) return take();
    const Word& last = command_.back();
    json::Place place = last.place;
    place.column += static_cast<std::uint32_t>(last.text.size());
    diagnostics_.error(place, "the command ends", {"nothing behind " + json::quote(last.text), expected});
    failed_ = true;
    return {"", place};
  }
  void refuse(const Word& word, const std::string& message, const std::string& expected, std::string suggestion = {}) {
    diagnostics_.error(word.place, message, {json::quote(word.text), expected, std::move(suggestion)});
    failed_ = true;
  }
  At<std::int64_t> parse_number(const std::string& expected, std::int64_t least, std::int64_t most, int base = 10) {
    const Word word = parse_value(expected);
    const auto value = number(word.text, base);
    if (!word.text.empty() && (!value || *value < least || *value > most))
      refuse(word, "not a number that fits", expected);
    return {value && *value >= least && *value <= most ? *value : least > 0 ? least : std::int64_t{0}, word.place};
  }
  static std::optional<std::int64_t> number(std::string_view text, int base = 10) {
    const bool has_prefix = text.starts_with("0x") || text.starts_with("0X");
    if (base == 0) base = has_prefix ? 16 : text.size() > 1 && text.front() == '0' ? 8 : 10;  // as strtoul does
    if (base == 16 && has_prefix) text.remove_prefix(2);
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    if (text.empty() || error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
    return value;
  }
  bool failed() const { return failed_; }
  json::Diagnostics& diagnostics() { return diagnostics_; }

 private:
  const Command& command_;
  json::Diagnostics& diagnostics_;
  std::size_t next_ = 0;
  bool failed_ = false;
};

inline constexpr std::int64_t most_ns = std::numeric_limits<std::int64_t>::max();

/// tc filter ...: what polices at the ingress of an interface; other filters are remarked.
void read_filter(Words& words, const Word& start, Machine& machine);

}  // namespace takt::interchange::linux_tc
