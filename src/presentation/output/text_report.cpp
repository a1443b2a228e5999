// SPDX-License-Identifier: Apache-2.0
#include "output/text_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "output/application_report.hpp"
#include "output/cpu_report.hpp"
#include "output/program_report.hpp"

namespace takt::output {
namespace {

using results::ProgramResult;
using results::RunResult;
using results::StreamResult;
using results::Verdict;
using sim::Duration;

constexpr std::size_t most_streams = 12;
constexpr std::size_t most_features = 16;

const char* mark(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::fail:
      return "FAIL";
    case Verdict::undecided:
      return "open";
  }
  return "?";
}

std::string heading(std::string_view text) { return fmt::format("\n{}\n", text); }

std::string requirements_part(const RunResult& result, const Layout& layout) {
  if (result.requirements.empty()) return {};
  Table table({{"", Table::Align::left}, {"", Table::Align::left}});
  for (const results::RequirementResult& r : result.requirements) {
    std::string figures;
    if (r.measured && r.limit && !r.figure) {
      const std::int64_t limit = r.limit->ps();
      figures = fmt::format("{} of {}", readable(*r.measured), readable(*r.limit));
      if (r.least_limit)
        figures = fmt::format("{} to {} of {} to {}", r.least_measured ? readable(*r.least_measured) : "?",
                              readable(*r.measured), readable(*r.least_limit), readable(*r.limit));
      else if (limit > 0)
        figures +=
            fmt::format(" ({:.0f} %)", 100.0 * static_cast<double>(r.measured->ps()) / static_cast<double>(limit));
      if (!r.remark.empty()) figures += ", ";
    }
    table.add({mark(r.verdict), results::titled(r)}, figures + r.remark);
  }
  return heading("Requirements") + table.text(layout);
}

std::string streams_part(const RunResult& result, const Layout& layout) {
  if (result.streams.empty()) return {};
  std::vector<const StreamResult*> streams;
  for (const StreamResult& stream : result.streams) streams.push_back(&stream);
  std::stable_sort(streams.begin(), streams.end(), [](const StreamResult* a, const StreamResult* b) {
    const auto key = [](const StreamResult* s) { return s->latency ? s->latency->max : Duration(); };
    return key(a) > key(b);
  });
  const std::size_t shown = layout.all ? streams.size() : std::min(streams.size(), most_streams);
  using enum Table::Align;
  Table table({{"stream", left},
               {"sent", right, 3},
               {"delivered", right},
               {"lost", right},
               {"min", quantity, 4},
               {"mean", quantity, 2},
               {"p99", quantity, 1},
               {"max", quantity},
               {"stddev", quantity, 5}});
  for (std::size_t i = 0; i < shown; ++i) {
    const StreamResult& s = *streams[i];
    std::vector<std::string> cells = {shortened(s.name, 40), std::to_string(s.sent), std::to_string(s.delivered),
                                      std::to_string(s.lost)};
    if (s.latency)
      for (const Duration each : {s.latency->min, s.latency->mean, s.latency->p99, s.latency->max, s.latency->stddev})
        cells.push_back(readable(each));
    std::string remark = s.has_copies && !s.dropped.empty() ? "copies" : "";
    for (const auto& [reason, count] : s.dropped)
      remark += fmt::format("{}{}: {}", remark.empty() ? "" : "  ", reason, count);
    // What is still to come has been longer under way than all that came.
    if (s.oldest_in_flight && (!s.latency || *s.oldest_in_flight > s.latency->max))
      remark += fmt::format("{}under way at the end: {}, the oldest for {}", remark.empty() ? "" : "  ", s.in_flight,
                            readable(*s.oldest_in_flight));
    table.add(std::move(cells), std::move(remark));
  }
  return heading(streams.size() > shown ? fmt::format("The {} slowest of {} streams", shown, streams.size())
                                        : std::string("Streams, slowest first")) +
         table.text(layout);
}

std::string ports_part(const RunResult& result, const Layout& layout) {
  std::vector<const results::PortResult*> ports;
  for (const results::PortResult& port : result.ports) ports.push_back(&port);
  if (ports.empty()) return {};
  std::stable_sort(ports.begin(), ports.end(),
                   [](const auto* a, const auto* b) { return a->utilisation > b->utilisation; });
  std::string out = heading(layout.all ? "Ports, busiest first" : "Busiest ports");
  for (std::size_t i = 0; i < (layout.all ? ports.size() : std::min<std::size_t>(5, ports.size())); ++i) {
    const results::PortResult& p = *ports[i];
    out += fmt::format("  {:<32} {:>6.2f} % used, {} frames, longest queue {}{}\n",
                       fmt::format("{}:{} to {}", p.node, p.port, p.peer), 100 * p.utilisation, p.frames, p.queue_peak,
                       p.dropped > 0 ? fmt::format(", {} dropped", p.dropped) : "");
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

/// A table of what was counted where. Rows without anything to say are left out. Where there are too many rows, those
/// that tell of trouble come first.
class FeatureTable {
 public:
  explicit FeatureTable(std::string_view title) : title_(title) {}
  void add(std::string who, std::string what, bool trouble = false) {
    if (!what.empty()) rows_.push_back({std::move(who), std::move(what), trouble});
  }
  std::string text(const Layout& layout) {
    if (rows_.empty()) return {};
    const std::size_t shown = layout.all ? rows_.size() : std::min(rows_.size(), most_features);
    if (shown < rows_.size())
      std::stable_partition(rows_.begin(), rows_.end(), [](const Row& row) { return row.trouble; });
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

std::string port_features_part(const RunResult& result, const Layout& layout) {
  FeatureTable table("Preemption, cut-through, overruns");
  for (const results::PortResult& p : result.ports) {
    std::string row;
    mention(row, p.fragments_cut,
            p.fragments_cut == 1 ? "frame cut for an express one" : "frames cut for express ones");
    mention(row, p.frames_cut_through, "cut through");
    mention(row, p.bad_fcs_forwarded, "of them damaged");
    mention(row, p.transmission_overrun, "sent beyond the end of their gate");
    table.add(fmt::format("{}:{} to {}", p.node, p.port, p.peer), row,
              p.bad_fcs_forwarded + p.transmission_overrun > 0);
  }
  return table.text(layout);
}

/// Offsets with their sign.
std::string signed_time(Duration offset) {
  return offset < Duration() ? "-" + readable(Duration() - offset) : readable(offset);
}

/// "20 s: gm lost", "20.25 s: h1 leads".
std::string grandmasters_part(const RunResult& result, const Layout& layout) {
  if (result.grandmasters.empty()) return {};
  std::string out = heading("Grandmasters: when another node was locked to one, and when that was over");
  const std::size_t shown =
      layout.all ? result.grandmasters.size() : std::min(result.grandmasters.size(), most_features);
  for (std::size_t i = 0; i < shown; ++i)
    out += fmt::format("  {:>14}  {} {}\n", readable(result.grandmasters[i].at.since_start()),
                       result.grandmasters[i].node, result.grandmasters[i].event);
  if (result.grandmasters.size() > shown) out += fmt::format("  ... {} more\n", result.grandmasters.size() - shown);
  return out;
}

std::string clock_differences_part(const RunResult& result) {
  std::string out;
  for (const results::ClockDifferenceResult& each : result.clock_differences) {
    if (!each.greatest || *each.greatest == Duration()) continue;
    const std::string whose = each.name == "all"              ? "all nodes"
                              : each.name.starts_with("ways") ? "nodes on " + each.name
                                                              : each.name;
    out += fmt::format("  {}: {}, {} ahead of {} at {}\n", whose, readable(*each.greatest), each.ahead, each.behind,
                       readable(each.at->since_start()));
  }
  return out.empty() ? out : heading("Greatest differences of two clocks") + out;
}

std::string incapable_links_part(const RunResult& result, const Layout& layout) {
  FeatureTable table("Ports that are not capable of gPTP");
  for (const results::GptpLinkResult& each : result.gptp_links)
    if (!each.is_capable) table.add(fmt::format("{}:{} to {}", each.node, each.port, each.peer), each.why_not, true);
  return table.text(layout);
}

/// The worst clocks, and who is grandmaster when.
std::string clocks_part(const RunResult& result, const Layout& layout) {
  if (result.clocks.empty()) return {};
  std::vector<const results::ClockResult*> clocks;
  for (const results::ClockResult& clock : result.clocks) clocks.push_back(&clock);
  const auto worst = [](const results::ClockResult* c) { return std::max(c->greatest, Duration() - c->least); };
  std::stable_sort(clocks.begin(), clocks.end(), [&](const auto* a, const auto* b) { return worst(a) > worst(b); });
  const std::size_t shown = layout.all ? clocks.size() : std::min(clocks.size(), most_features);
  using enum Table::Align;
  Table table({{"node", left},
               {"grandmaster", left, 1},
               {"state", left},
               {"locked after", quantity, 3},
               {"min", quantity},
               {"mean", quantity, 5},
               {"rms", quantity, 4},
               {"max", quantity},
               {"greatest at", quantity, 6},
               {"rate error", quantity, 2},
               {"steps", right}});
  for (std::size_t i = 0; i < shown; ++i) {
    const results::ClockResult& c = *clocks[i];
    table.add({c.node, c.grandmaster, c.state,
               c.time_to_lock          ? readable(*c.time_to_lock)
               : c.was_never_to_lock() ? "-"
                                       : "never",
               signed_time(c.least), signed_time(c.mean), readable(c.rms), signed_time(c.greatest),
               c.greatest_at ? readable(c.greatest_at->since_start()) : "-",
               fmt::format("{:.1f} ppb", static_cast<double>(c.frequency_error_ppt) / 1000.0),
               std::to_string(c.steps)});
  }
  std::string out =
      heading("Clocks, by their greatest offset from the grandmaster since they were locked") + table.text(layout);
  if (clocks.size() > shown) out += fmt::format("  ... {} more\n", clocks.size() - shown);
  return out + grandmasters_part(result, layout) + clock_differences_part(result) +
         incapable_links_part(result, layout);
}

std::string filter_name(const results::StreamFilterResult& filter) {
  std::string name = filter.stream.empty() ? "all streams" : filter.stream;
  if (filter.priority) name += fmt::format(" PCP {}", *filter.priority);
  return name;
}

std::string ingress_part(const RunResult& result, const Layout& layout) {
  FeatureTable table("Ingress of switches");
  for (const results::IngressResult& ingress : result.ingress) {
    for (const results::StreamFilterResult& f : ingress.filters) {
      std::string row;
      mention(row, f.matching, "matched");
      mention(row, f.not_passing_sdu, "too long");
      mention(row, f.not_passing, "stopped by the gate");
      mention(row, f.red, "discarded by the meter");
      mention_latch(row, f.blocked_due_to_oversize, "BLOCKED since one was too long");
      table.add(fmt::format("{} filter {}", ingress.node, filter_name(f)), row,
                f.not_passing_sdu + f.not_passing + f.red > 0);
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
  return table.text(layout);
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

std::string redundancy_part(const RunResult& result, const Layout& layout) {
  FeatureTable table("Redundant streams");
  for (const results::SplitResult& s : result.redundancy.splits) {
    std::string row;
    mention(row, s.frames, fmt::format("split into {} members", s.members));
    table.add(fmt::format("{} at {}", s.stream, s.node), row);
  }
  for (const results::RecoveryResult& r : result.redundancy.recoveries) {
    std::string row = counters_text(r.counters);
    if (r.latent_errors && r.latent_errors->errors > 0)
      row += fmt::format("{}LATENT ERROR signalled {} time{}, first at {}", row.empty() ? "" : ", ",
                         r.latent_errors->errors, r.latent_errors->errors == 1 ? "" : "s",
                         readable(r.latent_errors->first->since_start()));
    table.add(fmt::format("{} at {}", r.stream, r.node), row,
              r.counters.lost + r.counters.rogue > 0 || (r.latent_errors && r.latent_errors->errors > 0));
    for (const results::RecoveryResult::Individual& each : r.individual)
      if (each.counters.discarded > 0)
        table.add(
            fmt::format("{} at {}, {} through port {}", r.stream, r.node,
                        each.member ? fmt::format("member {}", *each.member) : std::string("no member"), each.port),
            counters_text(each.counters), true);
  }
  return table.text(layout);
}

/// The sum of what the rows of several streams say.
std::string drops_part(const RunResult& result) {
  const auto drops = [](const StreamResult& stream) { return !stream.dropped.empty(); };
  if (std::count_if(result.streams.begin(), result.streams.end(), drops) < 2) return {};
  std::string row;
  for (const auto& [reason, count] : result.dropped)
    row += fmt::format("{}{}: {}", row.empty() ? "" : ", ", reason, count);
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
  std::string verdict =
      result.nothing_required ? std::string(results::nothing_was_required) : results::name_of(result.verdict);
  if (failed > 0) verdict += fmt::format(" ({} of {} requirements)", failed, result.requirements.size());
  return fmt::format("{}: {}, digest {:016x}{}\n", result.scenario, verdict, result.digest,
                     result.partial ? ", partial" : "");
}

std::string run_report(const RunResult& result, const Layout& layout) {
  std::string out = fmt::format("{}, seed {}: {} simulated, {} events\n", result.scenario, result.seed,
                                readable(result.simulated), result.events);
  if (result.from > Duration()) out += fmt::format("Figures are of what began at {} or later\n", readable(result.from));
  if (result.partial)
    out += fmt::format("PARTIAL: interrupted after {} of {}\n", readable(result.simulated), readable(result.wanted));
  for (const ProgramResult& program : result.programs) out += program_part(program, layout);
  out += applications_part(result);
  out += cpus_part(result);
  out += streams_part(result, layout);
  out += drops_part(result);
  out += ports_part(result, layout);
  out += port_features_part(result, layout);
  out += clocks_part(result, layout);
  out += ingress_part(result, layout);
  out += redundancy_part(result, layout);
  out += requirements_part(result, layout);
  return out + "\n" + run_line(result);
}

}  // namespace takt::output
