// SPDX-License-Identifier: Apache-2.0
// Settings of a format, KEY=VALUE on the command line: which there are stands in a table of the format.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace takt::interchange {

struct SettingInfo {
  std::string_view key;
  std::string_view
      values;  ///< "a|b|c": one of these; otherwise words for what it may be, such as "a whole number of ns"
  std::string_view fallback;  ///< the value if it is not set; "" for none
  std::string_view help;
  bool is_choice() const { return values.find('|') != std::string_view::npos; }
};

class Settings {
 public:
  /// Reads "KEY=VALUE" texts by the table; null, with what is wrong, if one is not known or not a choice.
  static std::optional<Settings> read(std::span<const std::string> assignments, std::span<const SettingInfo> table,
                                      std::string& mistake);

  /// The value, or the fallback of the table. CHECKs that the table has the key.
  const std::string& operator[](std::string_view key) const;
  /// A whole number from 0 to `most`; null if it is none.
  std::optional<std::uint64_t> number(std::string_view key, std::uint64_t most) const;

 private:
  std::map<std::string, std::string, std::less<>> values_;
};

}  // namespace takt::interchange
