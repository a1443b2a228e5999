#include "output/text_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

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
    if (r.measured && r.limit) {
      const std::int64_t limit = r.limit->ps();
      figures = fmt::format("{} of {}", readable(*r.measured), readable(*r.limit));
      if (limit > 0) figures += fmt::format(" ({:.0f} %)", 100.0 * static_cast<double>(r.measured->ps()) / static_cast<double>(limit));
      if (!r.remark.empty()) figures += ", ";
    }
    out += fmt::format("  {}  {:<46} {}\n", mark(r.verdict), r.text, figures + r.remark);
  }
  return out;
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
    if (!entry.call.empty()) {
      since = entry.at;
      out += fmt::format("  {:>16}  {:>12}  {} on {}\n", readable(entry.at.since_start()), "", entry.call, program.participants[entry.participant]);
      ++i;
      continue;
    }
    std::vector<std::string> cells(widths.size(), "|");
    std::vector<bool> taken(widths.size(), false);
    while (i < program.timeline.size() && program.timeline[i].at == entry.at && program.timeline[i].call.empty() &&
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
    if (!entry.call.empty()) {
      since = entry.at;
      out += fmt::format("  {:>16}  {:>12}  {} on {}\n", readable(entry.at.since_start()), "", entry.call, program.participants[entry.participant]);
    } else {
      out += fmt::format("  {:>16}  {:>12}  {:<20} {}\n", readable(entry.at.since_start()), "+" + readable(entry.at - since),
                         program.participants[entry.participant], entry.state);
    }
  }
  return out;
}

std::string reactions_part(const ProgramResult& program) {
  std::string out;
  std::size_t shown = 0;
  for (const results::ReactionResult& reaction : program.reactions) {
    if (++shown > most_reactions) {
      out += fmt::format("  ... {} more reactions\n", program.reactions.size() - most_reactions);
      break;
    }
    const std::string duration = reaction.completed ? readable(*reaction.duration()) : reaction.superseded ? "superseded" : "not complete";
    out += fmt::format("  {:<8} from {:<16} at {:>14}   {:>14}{}\n", reaction.kind, reaction.initiator, readable(reaction.began.since_start()), duration,
                       reaction.cause == "command" ? "" : "   (" + reaction.cause + ")");
  }
  return out;
}

std::string program_part(const ProgramResult& program) {
  std::string out = heading(fmt::format("Program {}: {} handshake, master {}, {} slave{}, cycle {}", program.name, program.variant,
                                        program.participants.front(), program.participants.size() - 1,
                                        program.participants.size() == 2 ? "" : "s", readable(program.cycle)));
  if (program.timeline.empty()) return out + "  nothing was called\n";
  out += program.participants.size() <= most_columns ? columns_timeline(program) : list_timeline(program);
  if (program.timeline.size() > most_timeline_rows) out += fmt::format("  ... {} changes of state in all\n", program.changes);
  if (!program.reactions.empty()) out += "\n  Reactions (from the call until all are there)\n" + reactions_part(program);
  if (program.process_data_received > 0) out += fmt::format("  {} process data messages reached their applications\n", program.process_data_received);
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
  out += fmt::format("  {:<{}} {:>10} {:>10} {:>8} {:>12} {:>12} {:>12} {:>12} {:>12}\n", "stream", width, "sent", "delivered", "dropped", "min", "mean", "p99", "max", "stddev");
  for (std::size_t i = 0; i < std::min(streams.size(), most_streams); ++i) {
    const StreamResult& s = *streams[i];
    out += fmt::format("  {:<{}} {:>10} {:>10} {:>8}", s.name, width, s.sent, s.delivered, s.dropped_in_all());
    if (s.latency)
      out += fmt::format(" {:>12} {:>12} {:>12} {:>12} {:>12}", readable(s.latency->min), readable(s.latency->mean), readable(s.latency->p99),
                         readable(s.latency->max), readable(s.latency->stddev));
    for (const auto& [reason, count] : s.dropped) out += fmt::format("  {}: {}", reason, count);
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
  std::string verdict = results::name_of(result.verdict);
  if (failed > 0) verdict += fmt::format(" ({} of {} requirements)", failed, result.requirements.size());
  return fmt::format("{}: {}, digest {:016x}{}\n", result.scenario, verdict, result.digest, result.partial ? ", partial" : "");
}

std::string run_report(const RunResult& result) {
  std::string out = fmt::format("{}, seed {}: {} simulated, {} events\n", result.scenario, result.seed, readable(result.simulated), result.events);
  if (result.partial) out += fmt::format("PARTIAL: interrupted after {} of {}\n", readable(result.simulated), readable(result.wanted));
  for (const ProgramResult& program : result.programs) out += program_part(program);
  out += streams_part(result);
  out += ports_part(result);
  out += requirements_part(result);
  return out + "\n" + run_line(result);
}

}  // namespace takt::output
