// SPDX-License-Identifier: Apache-2.0
#include "papers/validation/entries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "json/override.hpp"

namespace takt::papers::validation {
namespace {

namespace fs = std::filesystem;
using json::Node;

std::string text_of(const Node& value) {
  return value.kind == json::Kind::string || value.kind == json::Kind::number ? value.text
         : value.kind == json::Kind::boolean                                  ? value.boolean ? "true" : "false"
                                                                              : json::compact(value);
}

/// The values of one row by column.
using Row = std::map<std::string, const Node*, std::less<>>;

/// Puts values in the place of {columns}; a text that is nothing but a column becomes its value, of whatever kind.
void fill(Node& node, const Row& row) {
  for (Node& item : node.items) fill(item, row);
  for (json::Member& member : node.members) fill(member.value, row);
  if (node.kind != json::Kind::string) return;
  for (const auto& [column, value] : row) {
    const std::string mark = "{" + column + "}";
    if (node.text == mark) {
      const json::Position position = node.position;
      node = *value;
      node.position = position;
      return;
    }
    for (std::size_t at = node.text.find(mark); at != std::string::npos; at = node.text.find(mark))
      node.text.replace(at, mark.size(), text_of(*value));
  }
}

class Reader {
 public:
  Reader(const std::string& path, bool is_short, Entries& made, json::Diagnostics& diagnostics)
      : path_(path),
        folder_(fs::path(path).parent_path()),
        is_short_(is_short),
        made_(made),
        diagnostics_(diagnostics) {}

  void read() {
    const auto document = json::parse_file(path_, diagnostics_);
    if (!document) return;
    Table table;
    json::decode(*document, table, diagnostics_);
    if (diagnostics_.has_errors()) return;
    for (const auto& [name, scenario] : table.templates)
      scenarios_.emplace(name, json::Document(scenario.node, path_, "/templates" + json::pointer_step(name)));
    made_.sources.push_back(
        {fs::path(path_).stem().string(), table.source, table.reference, table.about, table.budget});
    for (const FigureText& figure : table.figures) add(figure, {}, {});
    for (const Family& family : table.families) add(family);
  }

 private:
  void add(const Family& family) {
    for (std::size_t r = 0; r < family.rows.size(); r += is_short_ ? family.short_every : 1) {
      const std::vector<json::Any>& values = family.rows[r];
      if (values.size() != family.columns.size()) {
        diagnostics_.error(family.where.at("rows", r), "not a value for each column",
                           {fmt::format("{} values", values.size()), fmt::format("{} values", family.columns.size())});
        continue;
      }
      Row row;
      for (std::size_t c = 0; c < values.size(); ++c) row[family.columns[c]] = &values[c].node;
      for (std::size_t f = 0; f < family.figures.size(); ++f) {
        if (f < family.when.size() && !concerns(family.when[f], row)) continue;
        Node node = family.figures[f].node;
        fill(node, row);
        FigureText figure;
        json::decode(json::Document(std::move(node), path_, family.figures[f].where.place().pointer), figure,
                     diagnostics_);
        if (diagnostics_.has_errors()) return;
        add(figure, family.factors, row);
      }
    }
  }

  static bool concerns(const json::NameMap<json::Any>& when, const Row& row) {
    return std::all_of(when.begin(), when.end(), [&](const auto& each) {
      const auto found = row.find(each.first);
      return found != row.end() && json::equal(*found->second, each.second.node);
    });
  }

  void add(const FigureText& figure, const Factors& factors, const Row& row) {
    const std::optional<json::Document> base = scenario_of(figure);
    if (!base) return;
    std::vector<json::Replacement> replacements;
    collect(factors, row, replacements);
    for (const auto& [pointer, value] : figure.set) replacements.push_back({pointer, value.node, figure.what});
    collect(figure.by, row, replacements);
    json::Document scenario = *base;
    if (json::replace(scenario, replacements, diagnostics_))
      made_.figures.push_back({made_.sources.size() - 1, figure, scenario});
  }

  void collect(const Factors& factors, const Row& row, std::vector<json::Replacement>& replacements) {
    for (const auto& [column, levels] : factors) {
      const auto value = row.find(column);
      if (value == row.end()) {
        diagnostics_.error({path_, 0, 0, ""}, "a factor of no column", {json::quote(column), "the name of a column"});
        continue;
      }
      const std::string level = text_of(*value->second);
      const auto found =
          std::find_if(levels.begin(), levels.end(), [&](const auto& each) { return each.first == level; });
      if (found == levels.end())
        diagnostics_.error({path_, 0, 0, ""}, "a value that no factor knows",
                           {column + " " + json::quote(level), "one of its levels"});
      else
        for (const auto& [pointer, put] : found->second)
          replacements.push_back({pointer, put.node, column + " = " + level});
    }
  }

  std::optional<json::Document> scenario_of(const FigureText& figure) {
    if (const auto known = scenarios_.find(figure.scenario); known != scenarios_.end()) return known->second;
    const auto document = json::parse_file((folder_ / figure.scenario).string(), diagnostics_);
    if (document) scenarios_.emplace(figure.scenario, *document);
    return document;
  }

  std::string path_;
  fs::path folder_;
  bool is_short_;
  Entries& made_;
  json::Diagnostics& diagnostics_;
  std::map<std::string, json::Document> scenarios_;  // templates and files that were read
};

}  // namespace

std::optional<Entries> read_tables(const std::string& folder, bool is_short, json::Diagnostics& diagnostics) {
  std::error_code error;
  std::vector<std::string> files;
  for (const fs::directory_entry& file : fs::directory_iterator(folder, error))
    if (file.path().extension() == ".json") files.push_back(file.path().string());
  if (files.empty())
    diagnostics.error({folder, 0, 0, ""}, "no tables of published figures",
                      {"no file *.json", "the folder validation/ of takt"});
  std::sort(files.begin(), files.end());
  Entries made;
  for (const std::string& file : files) Reader(file, is_short, made, diagnostics).read();
  if (diagnostics.has_errors()) return std::nullopt;
  return made;
}

}  // namespace takt::papers::validation
