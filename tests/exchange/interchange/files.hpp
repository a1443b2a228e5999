// SPDX-License-Identifier: Apache-2.0
// Files of tests/exchange/interchange/data, and tables of what they should give.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "interchange/format.hpp"
#include "json/fields.hpp"

namespace takt::interchange::test {

inline std::filesystem::path data() { return std::filesystem::path(TAKT_SOURCE_DIR) / "tests/exchange/interchange/data"; }

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  EXPECT_TRUE(stream.good()) << path;
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The rows of a CSV file (RFC 4180, a row a line) by the names of its first row.
inline std::vector<std::map<std::string, std::string>> rows_of(const std::filesystem::path& path) {
  std::vector<std::map<std::string, std::string>> rows;
  std::vector<std::string> names;
  std::ifstream stream(path);
  for (std::string line; std::getline(stream, line);) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
        cells.back() += '"';
        ++i;
      } else if (line[i] == '"')
        quoted = !quoted;
      else if (line[i] == ',' && !quoted)
        cells.emplace_back();
      else if (line[i] != '\r')
        cells.back() += line[i];
    }
    if (names.empty()) {
      names = cells;
      continue;
    }
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < std::min(names.size(), cells.size()); ++i) row[names[i]] = cells[i];
    rows.push_back(std::move(row));
  }
  EXPECT_FALSE(rows.empty()) << path;
  return rows;
}

inline InputFile input(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return {name, device_of_file(name), text_of(path)};
}

struct Reading {
  Imported imported;
  json::Diagnostics diagnostics;
  bool lost() const {
    return std::ranges::any_of(imported.remarks, [](const Remark& each) { return each.kind == RemarkKind::lost; });
  }
  std::string remarks() const {
    std::string text = diagnostics.to_text();
    for (const Remark& each : imported.remarks) text += to_text(each) + "\n";
    return text;
  }
};

inline Reading read(const std::string& format, std::vector<InputFile> files, const scenario::Scenario* base = nullptr,
                    std::vector<std::string> settings = {}) {
  Reading reading;
  const ImportFormat* const found = find_import_format(format);
  std::string mistake;
  const auto set = Settings::read(settings, found->settings, mistake);
  EXPECT_TRUE(set) << mistake;
  reading.imported = found->read({files, base, *set}, reading.diagnostics);
  return reading;
}

/// A node as a file of `takt/` says it.
inline scenario::Node node_of(const std::filesystem::path& path) {
  json::Diagnostics diagnostics;
  const auto document =
      json::parse("{\"name\": \"n\", \"duration\": \"1s\", \"network\": {\"nodes\": {\"n\": " + text_of(path) + "}}}",
                  path.filename().string(), diagnostics);
  scenario::Scenario scenario;
  EXPECT_TRUE(document && json::decode(*document, scenario, diagnostics)) << diagnostics.to_text();
  return scenario.network.nodes.front().second;
}

/// What was written, to be read again.
inline std::vector<InputFile> inputs(const Exported& exported) {
  std::vector<InputFile> files;
  for (const OutputFile& file : exported.files) files.push_back({file.name, device_of_file(file.name), file.content});
  return files;
}

/// What the ports of two nodes are set to is the same, whatever their neighbours are called.
inline void expect_same_ports(const scenario::Node& found, const scenario::Node& expected, const std::string& what) {
  const scenario::NodePorts& a = scenario::ports_of(found);
  const scenario::NodePorts& b = scenario::ports_of(expected);
  EXPECT_EQ(a.traffic_classes, b.traffic_classes) << what;
  ASSERT_EQ(a.egress.size(), b.egress.size()) << what;
  for (std::size_t i = 0; i < a.egress.size(); ++i) {
    scenario::Egress left = a.egress[i], right = b.egress[i];
    left.to = right.to = std::nullopt;
    // A cycle that is the sum of its entries may be said or not; so may the order of what has no order.
    for (scenario::Egress* const egress : {&left, &right})
      if (egress->gates) {
        sim::Duration sum;
        for (const scenario::GateEntry& entry : egress->gates->entries) sum += entry.interval;
        egress->gates->cycle = egress->gates->cycle.value_or(sum);
      }
    EXPECT_EQ(json::compact(json::encode_value(left)), json::compact(json::encode_value(right))) << what;
  }
}

}  // namespace takt::interchange::test
