// SPDX-License-Identifier: Apache-2.0
#include "output/program_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "output/text_report.hpp"

namespace takt::output {
namespace {

using results::ProgramResult;
using sim::TrueTime;

constexpr std::size_t most_timeline_rows = 48;
constexpr std::size_t most_columns = 6;
constexpr std::size_t most_reactions = 24;
constexpr std::size_t most_bindings = 40;
constexpr std::size_t most_violations = 12;

/// A call or a fault: what follows counts from it.
bool is_cause(const results::TimelineEntry& entry) { return !entry.call.empty() || !entry.fault.empty(); }

std::string cause_line(const ProgramResult& program, const results::TimelineEntry& entry) {
  return fmt::format("  {:>16}  {:>12}  {}\n", readable(entry.at.since_start()), "",
                     entry.fault.empty() ? entry.call + " on " + program.participants[entry.participant] : entry.fault);
}

std::vector<std::size_t> widths_of(const ProgramResult& program) {
  std::vector<std::size_t> widths;
  for (const std::string& name : program.participants) widths.push_back(std::max<std::size_t>(12, name.size() + 2));
  return widths;
}

constexpr std::size_t times_width = 34;  // of both columns of times

bool fits_columns(const ProgramResult& program, const Layout& layout) {
  std::size_t width = times_width;
  for (const std::size_t each : widths_of(program)) width += each;
  return program.participants.size() <= most_columns && (layout.width == 0 || width <= layout.width);
}

/// One row an instant, one column a participant; a cell shows the state that is entered.
std::string columns_timeline(const ProgramResult& program, const Layout& layout) {
  const std::vector<std::size_t> widths = widths_of(program);
  const auto finish = [](std::string row) {
    while (row.back() == ' ') row.pop_back();
    return row + "\n";
  };
  std::string titles = fmt::format("  {:>16}  {:>12}  ", "time", "since");
  for (std::size_t p = 0; p < widths.size(); ++p) titles += fmt::format("{:<{}}", program.participants[p], widths[p]);
  std::vector<std::string> rows;
  TrueTime since;
  for (std::size_t i = 0; i < program.timeline.size();) {
    const results::TimelineEntry& entry = program.timeline[i];
    if (is_cause(entry)) {
      since = entry.at;
      rows.push_back(cause_line(program, entry));
      ++i;
      continue;
    }
    std::vector<std::string> cells(widths.size(), "|");
    std::vector<bool> taken(widths.size(), false);
    while (i < program.timeline.size() && program.timeline[i].at == entry.at && !is_cause(program.timeline[i]) &&
           !taken[program.timeline[i].participant]) {
      cells[program.timeline[i].participant] = program.timeline[i].state;
      taken[program.timeline[i].participant] = true;
      ++i;
    }
    std::string row =
        fmt::format("  {:>16}  {:>12}  ", readable(entry.at.since_start()), "+" + readable(entry.at - since));
    for (std::size_t p = 0; p < widths.size(); ++p) row += fmt::format("{:<{}}", cells[p], widths[p]);
    rows.push_back(finish(std::move(row)));
  }
  return finish(std::move(titles)) + elided(rows, most_timeline_rows, layout);
}

/// For groups that are too wide for columns: who has reached which state when.
std::string list_timeline(const ProgramResult& program, const Layout& layout) {
  std::vector<std::string> rows;
  TrueTime since;
  for (const results::TimelineEntry& entry : program.timeline) {
    if (is_cause(entry)) {
      since = entry.at;
      rows.push_back(cause_line(program, entry));
    } else {
      rows.push_back(fmt::format("  {:>16}  {:>12}  {:<20} {}\n", readable(entry.at.since_start()),
                                 "+" + readable(entry.at - since), program.participants[entry.participant],
                                 entry.state));
    }
  }
  return elided(rows, most_timeline_rows, layout);
}

/// The lines of a table without titles.
std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin) + 1;
    lines.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return lines;
}

std::string reactions_part(const std::vector<results::ReactionResult>& reactions, const Layout& layout) {
  Table table({{"", Table::Align::left},
               {"", Table::Align::left},
               {"", Table::Align::left},
               {"", Table::Align::quantity},
               {"", Table::Align::quantity}});
  for (const results::ReactionResult& reaction : reactions) {
    const std::string duration = reaction.completed ? readable(*reaction.duration()) : std::string();
    const std::string remark = reaction.completed ? "" : reaction.superseded ? "superseded" : "not complete";
    const std::string cause = reaction.cause == "command" ? "" : "(" + reaction.cause + ")";
    table.add({reaction.kind, "from " + reaction.initiator, "at", readable(reaction.began.since_start()), duration},
              remark + (remark.empty() || cause.empty() ? "" : " ") + cause);
  }
  return elided(lines_of(table.text(layout)), most_reactions, layout);
}

std::string bindings_part(const ProgramResult& program, const Layout& layout) {
  std::vector<std::string> rows;
  for (const results::BindingResult& each : program.bindings)
    rows.push_back(fmt::format("  {:>16}  {:<16} {}\n", readable(each.at.since_start()), each.role,
                               each.node.empty() ? "nobody" : each.node));
  return "  Roles (which node got them, and when)\n" + elided(rows, most_bindings, layout) + "\n";
}

std::string violations_part(const ProgramResult& program, const Layout& layout) {
  if (program.violations.empty()) return {};
  std::vector<std::string> rows;
  for (const results::ViolationResult& violation : program.violations)
    rows.push_back(fmt::format("  {} at {}: {} {}\n", violation.invariant, readable(violation.at.since_start()),
                               violation.participant, violation.text));
  return "\n  Violated invariants\n" + elided(rows, most_violations, layout);
}

}  // namespace

std::string program_part(const ProgramResult& program, const Layout& layout) {
  std::string out = fmt::format("\nProgram {}: {} handshake, master {}, {} slave{}, cycle {}\n", program.name,
                                program.variant, program.participants.front(), program.participants.size() - 1,
                                program.participants.size() == 2 ? "" : "s", readable(program.cycle));
  if (!program.bindings.empty()) out += bindings_part(program, layout);
  if (program.timeline.empty()) return out + "  nothing was called\n";
  out += fits_columns(program, layout) ? columns_timeline(program, layout) : list_timeline(program, layout);
  // The result keeps the first changes only, however many there are.
  const auto kept = static_cast<std::uint64_t>(std::count_if(program.timeline.begin(), program.timeline.end(),
                                                             [](const auto& entry) { return !entry.state.empty(); }));
  if (program.changes > kept) out += fmt::format("  ... {} changes of state in all\n", program.changes);
  if (!program.reactions.empty())
    out += "\n  Reactions (from the cause until all living participants are there)\n" +
           reactions_part(program.reactions, layout);
  if (!program.tree_reactions.empty())
    out += "\n  Reactions of the whole tree (until all who live in nested programs are there, too)\n" +
           reactions_part(program.tree_reactions, layout);
  if (program.process_data_received > 0)
    out += fmt::format("  {} process data messages reached their applications\n", program.process_data_received);
  for (const results::RoundTripResult& trip : program.round_trips) {
    if (!trip.time) continue;
    out += fmt::format("  round trip {} -> {}: {} of them, min {}, mean {}, max {}, standard deviation {}\n",
                       trip.request, trip.reply, trip.count, readable(trip.time->min), readable(trip.time->mean),
                       readable(trip.time->max), readable(trip.time->stddev));
  }
  return out + violations_part(program, layout);
}

}  // namespace takt::output
