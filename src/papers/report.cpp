#include "papers/report.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "scenario/json/node.hpp"

namespace takt::papers {
namespace {

using scenario::json::Node;

std::string deviation_text(const Comparison& c) {
  if (!c.deviation) return "";
  return fmt::format("{:+.1f} % of {:.1f}", 100 * *c.deviation, 100 * c.tolerance.value_or(0));
}

std::string microseconds(const std::optional<sim::Duration>& d) { return d ? fmt::format("{:.1f}", static_cast<double>(d->ps()) * 1e-6) : "-"; }

std::string table_text(const BeyondTable& table) {
  std::string out = fmt::format("\n{}\nlongest of so many simulated | analytic bound, us\n\n  {:<16}", table.question, table.column);
  for (const char* name : reaction_names) out += fmt::format("{:>28}", name);
  out += "\n";
  for (const BeyondRow& row : table.rows) {
    out += fmt::format("  {:<16}", row.variant);
    for (const ReactionCell& cell : row.reactions)
      out += fmt::format("{:>28}", fmt::format("{} of {} | {}", microseconds(cell.simulated), cell.reactions, microseconds(cell.bound)));
    out += "\n";
  }
  return out;
}

Node real(const std::optional<double>& value) { return value ? Node::of_double(*value) : Node(); }
Node picoseconds(const std::optional<sim::Duration>& value) { return value ? Node::of_integer(value->ps()) : Node(); }

Node comparisons_node(const Reproduction& made) {
  Node all = Node::array();
  for (const Comparison& c : made.comparisons) {
    Node node = Node::object();
    node.add("what", Node::of_string(c.what));
    node.add("published", Node::of_string(c.published));
    node.add("reproduced", Node::of_string(c.reproduced));
    node.add("deviation", real(c.deviation));
    node.add("tolerance", real(c.tolerance));
    node.add("standing", Node::of_string(name_of(c.standing)));
    node.add("holds", Node::of_bool(c.holds));
    node.add("remark", Node::of_string(c.remark));
    all.items.push_back(std::move(node));
  }
  return all;
}

Node beyond_node(const Reproduction& made) {
  Node all = Node::object();
  for (const BeyondTable& table : made.beyond) {
    Node rows = Node::object();
    for (const BeyondRow& row : table.rows) {
      Node cells = Node::object();
      for (std::size_t k = 0; k < reaction_kinds; ++k) {
        Node cell = Node::object();
        cell.add("reactions", Node::of_integer(static_cast<sim::int128>(row.reactions[k].reactions)));
        cell.add("simulated_ps", picoseconds(row.reactions[k].simulated));
        cell.add("bound_ps", picoseconds(row.reactions[k].bound));
        cells.add(reaction_names[k], std::move(cell));
      }
      rows.add(row.variant, std::move(cells));
    }
    all.add(table.name, std::move(rows));
  }
  return all;
}

std::string write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  return file ? "" : path.string() + " cannot be written";
}

}  // namespace

std::string text_report(const Reproduction& made) {
  std::string out = fmt::format("Distributed Programs over TSN, reproduced{}\n\n  {:<48}{:>20}{:>22}{:>20}  verdict\n", made.is_short ? " (short: three minutes, not an hour)" : "",
                                "", "published", "reproduced", "deviation");
  for (const Comparison& c : made.comparisons) {
    out += fmt::format("  {:<48}{:>20}{:>22}{:>20}  {}, {}\n", c.what, c.published, c.reproduced, deviation_text(c), c.holds ? "holds" : "MISSED", name_of(c.standing));
    if (!c.remark.empty()) out += fmt::format("      {}\n", c.remark);
  }
  for (const BeyondTable& table : made.beyond) out += table_text(table);
  out += "\nRuns of Table I\n";
  for (const Speed& speed : made.speed)
    out += fmt::format("  {:>2} values: {:.0f} s simulated, {} events, {} round trips, digest {:016x}\n", speed.values, speed.simulated_seconds, speed.events, speed.round_trips,
                       speed.digest);
  return out + fmt::format("\n{}\n", made.holds() ? "REPRODUCED" : "NOT REPRODUCED");
}

std::string json_report(const Reproduction& made) {
  Node node = Node::object();
  node.add("paper", Node::of_string("programs"));
  node.add("short", Node::of_bool(made.is_short));
  node.add("holds", Node::of_bool(made.holds()));
  node.add("comparisons", comparisons_node(made));
  node.add("beyond", beyond_node(made));
  Node runs = Node::object();
  for (const Speed& speed : made.speed) {
    Node run = Node::object();
    run.add("simulated_s", Node::of_double(speed.simulated_seconds));
    run.add("events", Node::of_integer(static_cast<sim::int128>(speed.events)));
    run.add("round_trips", Node::of_integer(static_cast<sim::int128>(speed.round_trips)));
    run.add("digest", Node::of_string(fmt::format("{:016x}", speed.digest)));
    runs.add(std::to_string(speed.values), std::move(run));
  }
  node.add("runs", std::move(runs));
  return scenario::json::pretty(node);
}

std::string write_folder(const std::string& folder, const Reproduction& made) {
  namespace fs = std::filesystem;
  const fs::path to = folder;
  std::error_code error;
  fs::create_directories(to / "scenarios", error);
  if (error) return folder + ": " + error.message();
  std::vector<std::pair<fs::path, std::string>> files = {{to / "report.txt", text_report(made)}, {to / "report.json", json_report(made)}};
  for (const Figure& figure : made.figures) files.emplace_back(to / (figure.name + ".svg"), figure.svg);
  for (const auto& [name, text] : made.scenarios) files.emplace_back(to / "scenarios" / (name + ".json"), text);
  for (const auto& [path, text] : files)
    if (std::string problem = write(path, text); !problem.empty()) return problem;
  return "";
}

}  // namespace takt::papers
