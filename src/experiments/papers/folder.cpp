// SPDX-License-Identifier: Apache-2.0
#include "papers/folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace takt::papers {
namespace {

using json::Node;

std::string deviation_text(const Comparison& c) {
  if (!c.deviation) return "";
  if (c.in_points) return fmt::format("{:+.1f} of {:g} points", *c.deviation, c.tolerance.value_or(0));
  return fmt::format("{:+.1f} % of {:.1f}", 100 * *c.deviation, 100 * c.tolerance.value_or(0));
}

Node real(const std::optional<double>& value) { return value ? Node::of_double(*value) : Node(); }

std::string write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  return file ? "" : path.string() + " cannot be written";
}

}  // namespace

std::string text_of(const std::vector<Comparison>& comparisons) {
  const bool is_measured =
      std::any_of(comparisons.begin(), comparisons.end(), [](const Comparison& c) { return !c.measured.empty(); });
  const auto measured = [is_measured](const std::string& text) {
    return is_measured ? fmt::format("{:>14}", text) : "";
  };
  std::string out = fmt::format("  {:<48}{:>20}{:>22}{}{:>20}  verdict\n", "", "published", "reproduced",
                                measured("measured"), "deviation");
  for (const Comparison& c : comparisons) {
    out += fmt::format("  {:<48}{:>20}{:>22}{}{:>20}  {}, {}\n", c.what, c.published, c.reproduced,
                       measured(c.measured), deviation_text(c), c.holds ? "holds" : "MISSED", name_of(c.standing));
    if (!c.remark.empty()) out += fmt::format("      {}\n", c.remark);
  }
  return out;
}

Node json_of(const std::vector<Comparison>& comparisons) {
  Node all = Node::array();
  for (const Comparison& c : comparisons) {
    Node node = Node::object();
    node.add("what", Node::of_string(c.what));
    node.add("published", Node::of_string(c.published));
    node.add("reproduced", Node::of_string(c.reproduced));
    if (!c.measured.empty()) node.add("measured", Node::of_string(c.measured));
    node.add(c.in_points ? "deviation_points" : "deviation", real(c.deviation));
    node.add(c.in_points ? "tolerance_points" : "tolerance", real(c.tolerance));
    node.add("standing", Node::of_string(name_of(c.standing)));
    node.add("holds", Node::of_bool(c.holds));
    node.add("remark", Node::of_string(c.remark));
    all.items.push_back(std::move(node));
  }
  return all;
}

std::string write_folder(const std::string& folder, const Folder& content) {
  namespace fs = std::filesystem;
  const fs::path to = folder;
  std::error_code error;
  fs::create_directories(to / "scenarios", error);
  if (error) return folder + ": " + error.message();
  std::vector<std::pair<fs::path, std::string>> files = {{to / "report.txt", content.text},
                                                         {to / "report.json", content.json}};
  for (const Figure& figure : content.figures) files.emplace_back(to / (figure.name + ".svg"), figure.svg);
  for (const auto& [name, text] : content.scenarios) files.emplace_back(to / "scenarios" / (name + ".json"), text);
  for (const auto& [name, text] : content.others) files.emplace_back(to / name, text);
  for (const auto& [path, text] : files)
    if (std::string problem = write(path, text); !problem.empty()) return problem;
  return "";
}

}  // namespace takt::papers
