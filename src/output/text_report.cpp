#include "output/text_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "output/application_report.hpp"
#include "output/cpu_report.hpp"

namespace takt::output {
namespace {

using results::ProgramResult;
using results::RunResult;
using results::StreamResult;
using results::Verdict;
using sim::Duration;
using sim::TrueTime;

constexpr std::size_t most_timeline_rows = 48;
constexpr std::size_t most_columns = 6;
constexpr std::size_t most_streams = 12;
constexpr std::size_t most_reactions = 24;
constexpr std::size_t most_violations = 12;
constexpr std::size_t most_features = 16;

const char* mark(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass: return "pass";
    case Verdict::fail: return "FAIL";
    case Verdict::undecided: return "open";
  }
  return "?";
}

std::string heading(std::string_view text) { return fmt::format("\n{}\n", text); }

std::string requirements_part(const RunResult& result) {
  if (result.requirements.empty()) return {};
  std::string out = heading("Requirements");
  for (const results::RequirementResult& r : result.requirements) {
    std::string figures;
    if (r.measured && r.limit && !r.figure) {
      const std::int64_t limit = r.limit->ps();
      figures = fmt::format("{} of {}", readable(*r.measured), readable(*r.limit));
      if (r.least_limit) figures = fmt::format("{} to {} of {} to {}", r.least_measured ? readable(*r.least_measured) : "?", readable(*r.measured), readable(*r.least_limit), readable(*r.limit));
      else if (limit > 0) figures += fmt::format(" ({:.0f} %)", 100.0 * static_cast<double>(r.measured->ps()) / static_cast<double>(limit));
      if (!r.remark.empty()) figures += ", ";
    }
    out += fmt::format("  {}  {:<46} {}\n", mark(r.verdict), r.text, figures + r.remark);
  }
  return out;
}

/// A call or a fault: what follows counts from it.
bool is_cause(const results::TimelineEntry& entry) { return !entry.call.empty() || !entry.fault.empty(); }

std::string cause_line(const ProgramResult& program, const results::TimelineEntry& entry) {
  return fmt::format("  {:>16}  {:>12}  {}\n", readable(entry.at.since_start()), "", entry.fault.empty() ? entry.call + " on " + program.participants[entry.participant] : entry.fault);
}

/// One row an instant, one column a participant; a cell shows the state that is entered.
std::string columns_timeline(const ProgramResult& program) {
  std::vector<std::size_t> widths;
  for (const std::string& name : program.participants) widths.push_back(std::max<std::size_t>(12, name.size() + 2));
  std::string out = fmt::format("  {:>16}  {:>12}  ", "time", "since");
  for (std::size_t p = 0; p < widths.size(); ++p) out += fmt::format("{:<{}}", program.participants[p], widths[p]);
  out += "\n";
  TrueTime since;
  std::size_t rows = 0;
  for (std::size_t i = 0; i < program.timeline.size() && rows < most_timeline_rows; ++rows) {
    const results::TimelineEntry& entry = program.timeline[i];
    if (is_cause(entry)) {
      since = entry.at;
      out += cause_line(program, entry);
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
    out += fmt::format("  {:>16}  {:>12}  ", readable(entry.at.since_start()), "+" + readable(entry.at - since));
    for (std::size_t p = 0; p < widths.size(); ++p) out += fmt::format("{:<{}}", cells[p], widths[p]);
    while (out.back() == ' ') out.pop_back();
    out += "\n";
  }
  return out;
}

/// For groups that are too wide for columns: how many have reached which state when.
std::string list_timeline(const ProgramResult& program) {
  std::string out;
  TrueTime since;
  std::size_t rows = 0;
  for (const results::TimelineEntry& entry : program.timeline) {
    if (++rows > most_timeline_rows) break;
    if (is_cause(entry)) {
      since = entry.at;
      out += cause_line(program, entry);
    } else {
      out += fmt::format("  {:>16}  {:>12}  {:<20} {}\n", readable(entry.at.since_start()), "+" + readable(entry.at - since),
                         program.participants[entry.participant], entry.state);
    }
  }
  return out;
}

std::string reactions_part(const std::vector<results::ReactionResult>& reactions) {
  std::string out;
  std::size_t shown = 0;
  for (const results::ReactionResult& reaction : reactions) {
    if (++shown > most_reactions) {
      out += fmt::format("  ... {} more reactions\n", reactions.size() - most_reactions);
      break;
    }
    const std::string duration = reaction.completed ? readable(*reaction.duration()) : reaction.superseded ? "superseded" : "not complete";
    out += fmt::format("  {:<8} from {:<16} at {:>14}   {:>14}{}\n", reaction.kind, reaction.initiator, readable(reaction.began.since_start()), duration,
                       reaction.cause == "command" ? "" : "   (" + reaction.cause + ")");
  }
  return out;
}

constexpr std::size_t most_bindings = 40;

std::string bindings_part(const ProgramResult& program) {
  std::string out = "\n  Roles (which node got them, and when)\n";
  std::size_t shown = 0;
  for (const results::BindingResult& each : program.bindings) {
    if (shown++ == most_bindings) return out + fmt::format("  ... {} more bindings\n", program.bindings.size() - most_bindings);
    out += fmt::format("  {:>16}  {:<16} {}\n", readable(each.at.since_start()), each.role, each.node.empty() ? "nobody" : each.node);
  }
  return out;
}

std::string program_part(const ProgramResult& program) {
  std::string out = heading(fmt::format("Program {}: {} handshake, master {}, {} slave{}, cycle {}", program.name, program.variant,
                                        program.participants.front(), program.participants.size() - 1,
                                        program.participants.size() == 2 ? "" : "s", readable(program.cycle)));
  if (!program.bindings.empty()) out += bindings_part(program).substr(1) + "\n";
  if (program.timeline.empty()) return out + "  nothing was called\n";
  out += program.participants.size() <= most_columns ? columns_timeline(program) : list_timeline(program);
  if (program.timeline.size() > most_timeline_rows) out += fmt::format("  ... {} changes of state in all\n", program.changes);
  if (!program.reactions.empty()) out += "\n  Reactions (from the cause until all living participants are there)\n" + reactions_part(program.reactions);
  if (!program.tree_reactions.empty()) out += "\n  Reactions of the whole tree (until all who live in nested programs are there, too)\n" + reactions_part(program.tree_reactions);
  if (program.process_data_received > 0) out += fmt::format("  {} process data messages reached their applications\n", program.process_data_received);
  for (const results::RoundTripResult& trip : program.round_trips) {
    if (!trip.time) continue;
    out += fmt::format("  round trip {} -> {}: {} of them, min {}, mean {}, max {}, standard deviation {}\n", trip.request, trip.reply, trip.count, readable(trip.time->min),
                       readable(trip.time->mean), readable(trip.time->max), readable(trip.time->stddev));
  }
  std::size_t shown = 0;
  for (const results::ViolationResult& violation : program.violations) {
    if (shown++ == 0) out += "\n  Violated invariants\n";
    if (shown > most_violations) {
      out += fmt::format("  ... {} more violations\n", program.violations.size() - most_violations);
      break;
    }
    out += fmt::format("  {} at {}: {} {}\n", violation.invariant, readable(violation.at.since_start()), violation.participant, violation.text);
  }
  return out;
}

std::string streams_part(const RunResult& result) {
  if (result.streams.empty()) return {};
  std::vector<const StreamResult*> streams;
  for (const StreamResult& stream : result.streams) streams.push_back(&stream);
  std::stable_sort(streams.begin(), streams.end(), [](const StreamResult* a, const StreamResult* b) {
    const auto key = [](const StreamResult* s) { return s->latency ? s->latency->max : Duration(); };
    return key(a) > key(b);
  });
  std::string out = heading(streams.size() > most_streams ? fmt::format("The {} slowest of {} streams", most_streams, streams.size()) : std::string("Streams, slowest first"));
  std::size_t width = 6;
  for (std::size_t i = 0; i < std::min(streams.size(), most_streams); ++i) width = std::max(width, std::min<std::size_t>(40, streams[i]->name.size()));
  out += fmt::format("  {:<{}} {:>10} {:>10} {:>8} {:>12} {:>12} {:>12} {:>12} {:>12}\n", "stream", width, "sent", "delivered", "lost", "min", "mean", "p99", "max", "stddev");
  for (std::size_t i = 0; i < std::min(streams.size(), most_streams); ++i) {
    const StreamResult& s = *streams[i];
    out += fmt::format("  {:<{}} {:>10} {:>10} {:>8}", s.name, width, s.sent, s.delivered, s.lost);
    if (s.latency)
      out += fmt::format(" {:>12} {:>12} {:>12} {:>12} {:>12}", readable(s.latency->min), readable(s.latency->mean), readable(s.latency->p99),
                         readable(s.latency->max), readable(s.latency->stddev));
    if (s.has_copies && !s.dropped.empty()) out += "  copies";
    for (const auto& [reason, count] : s.dropped) out += fmt::format("  {}: {}", reason, count);
    // What is still to come has been longer under way than all that came.
    if (s.oldest_in_flight && (!s.latency || *s.oldest_in_flight > s.latency->max))
      out += fmt::format("  under way at the end: {}, the oldest for {}", s.in_flight, readable(*s.oldest_in_flight));
    out += "\n";
  }
  return out;
}

std::string ports_part(const RunResult& result) {
  std::vector<const results::PortResult*> ports;
  for (const results::PortResult& port : result.ports) ports.push_back(&port);
  if (ports.empty()) return {};
  std::stable_sort(ports.begin(), ports.end(), [](const auto* a, const auto* b) { return a->utilisation > b->utilisation; });
  std::string out = heading("Busiest ports");
  for (std::size_t i = 0; i < std::min<std::size_t>(5, ports.size()); ++i) {
    const results::PortResult& p = *ports[i];
    out += fmt::format("  {:<32} {:>6.2f} % used, {} frames, longest queue {}{}\n", fmt::format("{}:{} to {}", p.node, p.port, p.peer), 100 * p.utilisation,
                       p.frames, p.queue_peak, p.dropped > 0 ? fmt::format(", {} dropped", p.dropped) : "");
  }
  return out;
}

/// "3 red" if there are any, after a comma if something stands before.
void mention(std::string& row, std::uint64_t count, std::string_view what) {
  if (count > 0) row += fmt::format("{}{} {}", row.empty() ? "" : ", ", count, what);
}
void mention_latch(std::string& row, bool latched, std::string_view what) {
  if (latched) row += (row.empty() ? "" : ", ") + std::string(what);
}

/// A table of what was counted where. Rows without anything to say are left out. Where there are too many rows, those that tell of
/// trouble come first.
class FeatureTable {
 public:
  explicit FeatureTable(std::string_view title) : title_(title) {}
  void add(std::string who, std::string what, bool trouble = false) {
    if (!what.empty()) rows_.push_back({std::move(who), std::move(what), trouble});
  }
  std::string text() {
    if (rows_.empty()) return {};
    const std::size_t shown = std::min(rows_.size(), most_features);
    if (shown < rows_.size()) std::stable_partition(rows_.begin(), rows_.end(), [](const Row& row) { return row.trouble; });
    std::size_t width = 0;
    for (std::size_t i = 0; i < shown; ++i) width = std::max(width, rows_[i].who.size());
    std::string out = heading(title_);
    for (std::size_t i = 0; i < shown; ++i) out += fmt::format("  {:<{}}  {}\n", rows_[i].who, width, rows_[i].what);
    if (rows_.size() > shown) out += fmt::format("  ... {} more\n", rows_.size() - shown);
    return out;
  }

 private:
  struct Row {
    std::string who;
    std::string what;
    bool trouble = false;
  };
  std::string_view title_;
  std::vector<Row> rows_;
};

std::string port_features_part(const RunResult& result) {
  FeatureTable table("Preemption, cut-through, overruns");
  for (const results::PortResult& p : result.ports) {
    std::string row;
    mention(row, p.fragments_cut, p.fragments_cut == 1 ? "frame cut for an express one" : "frames cut for express ones");
    mention(row, p.frames_cut_through, "cut through");
    mention(row, p.bad_fcs_forwarded, "of them damaged");
    mention(row, p.transmission_overrun, "sent beyond the end of their gate");
    table.add(fmt::format("{}:{} to {}", p.node, p.port, p.peer), row, p.bad_fcs_forwarded + p.transmission_overrun > 0);
  }
  return table.text();
}

/// Offsets with their sign.
std::string signed_time(Duration offset) { return offset < Duration() ? "-" + readable(Duration() - offset) : readable(offset); }

/// The worst clocks, and who is grandmaster when.
std::string clocks_part(const RunResult& result) {
  if (result.clocks.empty()) return {};
  std::vector<const results::ClockResult*> clocks;
  for (const results::ClockResult& clock : result.clocks) clocks.push_back(&clock);
  const auto worst = [](const results::ClockResult* c) { return std::max(c->greatest, Duration() - c->least); };
  std::stable_sort(clocks.begin(), clocks.end(), [&](const auto* a, const auto* b) { return worst(a) > worst(b); });
  const std::size_t shown = std::min(clocks.size(), most_features);
  std::size_t width = 4;
  for (std::size_t i = 0; i < shown; ++i) width = std::max(width, clocks[i]->node.size());
  std::string out = heading("Clocks, by their greatest offset from the grandmaster since they were locked");
  out += fmt::format("  {:<{}}  {:<12}  {:<12}  {:>12}  {:>12}  {:>12}  {:>12}  {:>12}  {:>10}  {}\n", "node", width, "grandmaster", "state", "locked after", "min", "mean", "rms", "max",
                     "rate error", "steps");
  for (std::size_t i = 0; i < shown; ++i) {
    const results::ClockResult& c = *clocks[i];
    out += fmt::format("  {:<{}}  {:<12}  {:<12}  {:>12}  {:>12}  {:>12}  {:>12}  {:>12}  {:>6.1f} ppb  {}\n", c.node, width, c.grandmaster, c.state,
                       c.time_to_lock ? readable(*c.time_to_lock) : c.state == "grandmaster" ? "-" : "never", signed_time(c.least), signed_time(c.mean), readable(c.rms), signed_time(c.greatest),
                       static_cast<double>(c.frequency_error_ppt) / 1000.0, c.steps);
  }
  if (clocks.size() > shown) out += fmt::format("  ... {} more\n", clocks.size() - shown);
  return out;
}

std::string filter_name(const results::StreamFilterResult& filter) {
  std::string name = filter.stream.empty() ? "all streams" : filter.stream;
  if (filter.priority) name += fmt::format(" PCP {}", *filter.priority);
  return name;
}

std::string ingress_part(const RunResult& result) {
  FeatureTable table("Ingress of switches");
  for (const results::IngressResult& ingress : result.ingress) {
    for (const results::StreamFilterResult& f : ingress.filters) {
      std::string row;
      mention(row, f.matching, "matched");
      mention(row, f.not_passing_sdu, "too long");
      mention(row, f.not_passing, "stopped by the gate");
      mention(row, f.red, "discarded by the meter");
      mention_latch(row, f.blocked_due_to_oversize, "BLOCKED since one was too long");
      table.add(fmt::format("{} filter {}", ingress.node, filter_name(f)), row, f.not_passing_sdu + f.not_passing + f.red > 0);
    }
    for (const results::StreamGateResult& g : ingress.gates) {
      std::string row;
      mention(row, g.passed, "passed");
      mention(row, g.closed, "came while it was closed");
      mention(row, g.octets_exceeded, "beyond its octets");
      mention_latch(row, g.closed_due_to_invalid_rx, "CLOSED since one came while it was closed");
      mention_latch(row, g.closed_due_to_octets_exceeded, "CLOSED since octets were exceeded");
      table.add(fmt::format("{} gate {}", ingress.node, g.name), row, g.closed + g.octets_exceeded > 0);
    }
    for (const results::FlowMeterResult& m : ingress.meters) {
      std::string row;
      mention(row, m.frames[0], "green");
      mention(row, m.frames[1], "yellow");
      mention(row, m.frames[2], "red");
      mention(row, m.discarded, "discarded");
      mention_latch(row, m.marks_all_red, "ALL RED since the first discarded one");
      table.add(fmt::format("{} meter {}", ingress.node, m.name), row, m.discarded > 0);
    }
    for (const results::AtsSchedulerResult& s : ingress.ats) {
      std::string row;
      mention(row, s.passed, "passed");
      if (s.longest_hold > Duration()) row += fmt::format(", held for up to {}", readable(s.longest_hold));
      mention(row, s.discarded, "would have stayed too long");
      table.add(fmt::format("{} ats {}", ingress.node, s.name), row, s.discarded > 0);
    }
  }
  return table.text();
}

std::string counters_text(const results::RecoveryCounters& c) {
  std::string row;
  mention(row, c.passed, "passed");
  mention(row, c.discarded, "discarded");
  mention(row, c.lost, "lost");
  mention(row, c.out_of_order, "out of order");
  mention(row, c.rogue, "outside the history");
  mention(row, c.tagless, "without an R-TAG");
  mention(row, c.resets, c.resets == 1 ? "time-out" : "time-outs");
  return row;
}

std::string redundancy_part(const RunResult& result) {
  FeatureTable table("Redundant streams");
  for (const results::SplitResult& s : result.redundancy.splits) {
    std::string row;
    mention(row, s.frames, fmt::format("split into {} members", s.members));
    table.add(fmt::format("{} at {}", s.stream, s.node), row);
  }
  for (const results::RecoveryResult& r : result.redundancy.recoveries) {
    std::string row = counters_text(r.counters);
    if (r.latent_errors && r.latent_errors->errors > 0)
      row += fmt::format("{}LATENT ERROR signalled {} time{}, first at {}", row.empty() ? "" : ", ", r.latent_errors->errors,
                         r.latent_errors->errors == 1 ? "" : "s", readable(r.latent_errors->first->since_start()));
    table.add(fmt::format("{} at {}", r.stream, r.node), row, r.counters.lost + r.counters.rogue > 0 || (r.latent_errors && r.latent_errors->errors > 0));
    for (const results::RecoveryResult::Individual& each : r.individual)
      if (each.counters.discarded > 0)
        table.add(fmt::format("{} at {}, {} through port {}", r.stream, r.node, each.member ? fmt::format("member {}", *each.member) : std::string("no member"), each.port),
                  counters_text(each.counters), true);
  }
  return table.text();
}

/// The sum of what the rows of several streams say.
std::string drops_part(const RunResult& result) {
  const auto drops = [](const StreamResult& stream) { return !stream.dropped.empty(); };
  if (std::count_if(result.streams.begin(), result.streams.end(), drops) < 2) return {};
  std::string row;
  for (const auto& [reason, count] : result.dropped) row += fmt::format("{}{}: {}", row.empty() ? "" : ", ", reason, count);
  return "  dropped in all  " + row + "\n";
}

}  // namespace

std::string readable(Duration duration) {
  struct Unit {
    std::int64_t ps;
    const char* name;
  };
  static constexpr Unit units[] = {{1'000'000'000'000, "s"}, {1'000'000'000, "ms"}, {1'000'000, "us"}, {1'000, "ns"}};
  const std::int64_t ps = duration.ps();
  if (ps == 0) return "0 s";
  const std::int64_t size = std::llabs(ps);
  for (const Unit& unit : units) {
    if (size < unit.ps) continue;
    // Seconds need more places, or the time line would not tell its rows apart.
    const int places = unit.ps == 1'000'000'000'000 ? 9 : unit.ps == 1'000'000'000 ? 6 : 3;
    std::string text = fmt::format("{:.{}f}", static_cast<double>(ps) / static_cast<double>(unit.ps), places);
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text + " " + unit.name;
  }
  return fmt::format("{} ps", ps);
}

std::string run_line(const RunResult& result) {
  std::size_t failed = 0;
  for (const results::RequirementResult& r : result.requirements) failed += r.verdict == Verdict::fail ? 1 : 0;
  std::string verdict = result.nothing_required ? std::string(results::nothing_was_required) : results::name_of(result.verdict);
  if (failed > 0) verdict += fmt::format(" ({} of {} requirements)", failed, result.requirements.size());
  return fmt::format("{}: {}, digest {:016x}{}\n", result.scenario, verdict, result.digest, result.partial ? ", partial" : "");
}

std::string run_report(const RunResult& result) {
  std::string out = fmt::format("{}, seed {}: {} simulated, {} events\n", result.scenario, result.seed, readable(result.simulated), result.events);
  if (result.from > Duration()) out += fmt::format("Figures are of what began at {} or later\n", readable(result.from));
  if (result.partial) out += fmt::format("PARTIAL: interrupted after {} of {}\n", readable(result.simulated), readable(result.wanted));
  for (const ProgramResult& program : result.programs) out += program_part(program);
  out += applications_part(result);
  out += cpus_part(result);
  out += streams_part(result);
  out += drops_part(result);
  out += ports_part(result);
  out += port_features_part(result);
  out += clocks_part(result);
  out += ingress_part(result);
  out += redundancy_part(result);
  out += requirements_part(result);
  return out + "\n" + run_line(result);
}

}  // namespace takt::output
