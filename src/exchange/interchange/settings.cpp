// SPDX-License-Identifier: Apache-2.0
#include "interchange/settings.hpp"

#include <algorithm>
#include <charconv>

#include "json/node.hpp"
#include "json/suggest.hpp"
#include "sim/check.hpp"

namespace takt::interchange {
namespace {

bool is_among(std::string_view choices, std::string_view value) {
  while (true) {
    const std::size_t bar = choices.find('|');
    if (choices.substr(0, bar) == value) return true;
    if (bar == std::string_view::npos) return false;
    choices.remove_prefix(bar + 1);
  }
}

}  // namespace

std::optional<Settings> Settings::read(std::span<const std::string> assignments, std::span<const SettingInfo> table,
                                       std::string& mistake) {
  Settings settings;
  for (const SettingInfo& info : table) settings.values_.emplace(info.key, info.fallback);
  for (const std::string& assignment : assignments) {
    const std::size_t equals = assignment.find('=');
    const std::string_view key = std::string_view(assignment).substr(0, equals);
    const auto info = std::ranges::find(table, key, &SettingInfo::key);
    if (equals == std::string::npos || info == table.end()) {
      std::string known;
      for (const SettingInfo& each : table) known += (known.empty() ? "" : ", ") + std::string(each.key);
      mistake = "unknown setting " + json::quote(assignment) +
                (known.empty() ? ": this format has none" : ": expected KEY=VALUE, with a key among " + known);
      return std::nullopt;
    }
    const std::string value = assignment.substr(equals + 1);
    if (info->is_choice() && !is_among(info->values, value)) {
      mistake =
          "setting " + std::string(key) + ": found " + json::quote(value) + ", expected " + std::string(info->values);
      return std::nullopt;
    }
    settings.values_[std::string(key)] = value;
  }
  return settings;
}

const std::string& Settings::operator[](std::string_view key) const {
  const auto found = values_.find(key);
  TAKT_CHECK(found != values_.end(), "a setting is asked for that stands in the format's table");
  return found->second;
}

std::optional<std::uint64_t> Settings::number(std::string_view key, std::uint64_t most) const {
  const std::string& text = (*this)[key];
  std::uint64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size() || value > most) return std::nullopt;
  return value;
}

}  // namespace takt::interchange
