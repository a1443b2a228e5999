// SPDX-License-Identifier: Apache-2.0
// Compiled by tools/bench --only build beside takt: what a build costs is said in units of this file. It never changes.
#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

namespace reference {

template <int N>
struct Record {
  std::string name;
  std::optional<std::vector<int>> values;
  std::variant<int, double, std::string> value;
  std::map<std::string, std::vector<std::string>> children;
  std::unordered_map<int, std::function<int(int)>> actions;
  bool operator==(const Record& other) const {
    return name == other.name && values == other.values && value == other.value && children == other.children;
  }
};

template <int N>
int work(std::vector<Record<N>> records) {
  std::sort(records.begin(), records.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  records.erase(std::unique(records.begin(), records.end()), records.end());
  std::regex pattern("([a-z]+)_([0-9]+)");
  int sum = N;
  for (Record<N>& record : records) {
    std::smatch match;
    if (std::regex_match(record.name, match, pattern)) sum += std::stoi(match[2]);
    for (auto& [number, action] : record.actions) sum += action(number);
    record.children[record.name].push_back(record.name);
  }
  return sum;
}

int all() {
  return work<1>({}) + work<2>({}) + work<3>({}) + work<4>({}) + work<5>({}) + work<6>({}) + work<7>({}) + work<8>({});
}

}  // namespace reference
