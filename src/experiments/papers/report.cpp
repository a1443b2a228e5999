// SPDX-License-Identifier: Apache-2.0
#include "papers/report.hpp"

#include <fmt/format.h>

#include "json/node.hpp"
#include "papers/folder.hpp"

namespace takt::papers {
namespace {

using json::Node;

std::string microseconds(const std::optional<sim::Duration>& d) {
  return d ? fmt::format("{:.1f}", static_cast<double>(d->ps()) * 1e-6) : "-";
}

std::string table_text(const BeyondTable& table) {
  std::string out =
      fmt::format("\n{}\nlongest of so many simulated | analytic bound, us\n\n  {:<16}", table.question, table.column);
  for (const char* name : reaction_names) out += fmt::format("{:>28}", name);
  out += "\n";
  for (const BeyondRow& row : table.rows) {
    out += fmt::format("  {:<16}", row.variant);
    for (const ReactionCell& cell : row.reactions)
      out += fmt::format("{:>28}", fmt::format("{} of {} | {}", microseconds(cell.simulated), cell.reactions,
                                               microseconds(cell.bound)));
    out += "\n";
  }
  return out;
}

Node picoseconds(const std::optional<sim::Duration>& value) { return value ? Node::of_integer(value->ps()) : Node(); }

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

}  // namespace

std::string text_report(const Reproduction& made) {
  std::string out = fmt::format("Distributed Programs over TSN, reproduced{}\n\n",
                                made.is_short ? " (short: three minutes, not an hour)" : "") +
                    text_of(made.comparisons);
  for (const BeyondTable& table : made.beyond) out += table_text(table);
  out += "\nRuns of Table I\n";
  for (const Speed& speed : made.speed)
    out += fmt::format("  {:>2} values: {:.0f} s simulated, {} events, {} round trips, digest {:016x}\n", speed.values,
                       speed.simulated_seconds, speed.events, speed.round_trips, speed.digest);
  return out + fmt::format("\n{}\n", made.holds() ? "REPRODUCED" : "NOT REPRODUCED");
}

std::string json_report(const Reproduction& made) {
  Node node = Node::object();
  node.add("paper", Node::of_string("programs"));
  node.add("short", Node::of_bool(made.is_short));
  node.add("holds", Node::of_bool(made.holds()));
  node.add("comparisons", json_of(made.comparisons));
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
  return json::pretty(node);
}

std::string write_folder(const std::string& folder, const Reproduction& made) {
  return write_folder(folder, {text_report(made), json_report(made), made.figures, made.scenarios, {}});
}

}  // namespace takt::papers
