// SPDX-License-Identifier: Apache-2.0
// The section of a page that shows where the time of the slowest frames went: a bar each, and its figures in a table.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "chart/page.hpp"
#include "chart/stacked_bars.hpp"
#include "chart/svg.hpp"
#include "explain/shown_hops.hpp"
#include "output/text_report.hpp"
#include "report/worst_ways.hpp"

namespace takt::report {
namespace {

using explain::Cause;
using explain::ExplainedFrame;
using explain::ExplainedHop;
using explain::ExplainedPart;
using explain::ShownHop;
using output::readable;

constexpr std::size_t most_parts = 200;

/// More causes than eyes tell apart: those of one kind have one colour.
struct Kind {
  std::string_view words;
  std::size_t look;
};
constexpr std::array<Kind, chart::stacked_looks> kinds = {{{"transmission", 0},
                                                           {"cable, forwarding", 1},
                                                           {"hosts: operating system, processor", 2},
                                                           {"behind its own class", 3},
                                                           {"behind a class that goes first", 4},
                                                           {"behind a lower class, on the wire already", 5},
                                                           {"gate closed, guard", 6},
                                                           {"shaped: credit, ATS, launch time", 7},
                                                           {"preemption: cuts, hold", 8}}};

constexpr std::size_t of_hosts = 2;

constexpr std::size_t kind_of(Cause cause) {
  switch (cause) {
    case Cause::transmission:
      return 0;
    case Cause::cable:
    case Cause::forwarding:
    case Cause::jitter:
      return 1;
    case Cause::os_transmit:
    case Cause::os_receive:
    case Cause::processor:
      return of_hosts;
    case Cause::own_class:
      return 3;
    case Cause::higher_class:
    case Cause::precedence:
      return 4;
    case Cause::lower_class:
      return 5;
    case Cause::gate_closed:
    case Cause::guard:
      return 6;
    case Cause::credit:
    case Cause::ats:
    case Cause::launch_time:
      return 7;
    case Cause::preemption:
    case Cause::hold:
      return 8;
    case Cause::count:
      break;
  }
  return 0;
}

std::size_t kind_of(const ExplainedPart& part) {
  for (std::size_t c = 0; c < static_cast<std::size_t>(Cause::count); ++c)
    if (part.cause == explain::name_of(static_cast<Cause>(c))) return kind_of(static_cast<Cause>(c));
  return 0;
}

std::string share_of(sim::Duration part, sim::Duration whole) {
  return whole > sim::Duration()
             ? fmt::format("{:.1f} %", 100 * static_cast<double>(part.ps()) / static_cast<double>(whole.ps()))
             : "";
}

std::string name_of(const ShownHop& shown) {
  if (shown.count > 1)
    return fmt::format("{} hops from {}:{} on", shown.count, shown.hop.node, shown.hop.port.value_or(0));
  return shown.hop.port ? fmt::format("{}:{}", shown.hop.node, *shown.hop.port) : shown.hop.node;
}

std::string behind(const ExplainedPart& part) {
  if (part.stream) return part.sequence ? fmt::format("{} frame {}", *part.stream, *part.sequence) : *part.stream;
  if (part.gate_entry) return fmt::format("entry {} of the gate list", *part.gate_entry);
  if (part.missing_bits) return fmt::format("{} bits of credit missing", *part.missing_bits);
  return {};
}

/// What a part waits for or passes, for who rests the mouse on it: one part, or several neighbours of one kind.
std::string title_of(const std::string& where, std::span<const ExplainedPart> parts, sim::Duration takes,
                     sim::Duration whole) {
  std::string text = where + ": ";
  if (parts.size() == 1) {
    const std::string who = behind(parts.front());
    text += parts.front().words + (who.empty() ? "" : ", " + who);
  } else {
    text += fmt::format("{}, {} times in a row", kinds[kind_of(parts.front())].words, parts.size());
  }
  return text + fmt::format(", {} ({})", readable(takes), share_of(takes, whole));
}

/// A group for each port, and one for each host that takes its time. Neighbours of one kind are one piece, however many
/// frames it took.
void add_groups(const ShownHop& shown, sim::Duration whole, std::vector<chart::StackedGroup>& groups) {
  const ExplainedHop& hop = shown.hop;
  groups.push_back({name_of(shown), {}});
  for (std::size_t i = 0; i < hop.parts.size();) {
    const std::size_t kind = kind_of(hop.parts[i]);
    const std::size_t first = i;
    sim::Duration takes;
    for (; i < hop.parts.size() && kind_of(hop.parts[i]) == kind; ++i) takes += hop.parts[i].takes;
    if (hop.port && kind == of_hosts && hop.to) groups.push_back({*hop.to, {}});
    const std::span<const ExplainedPart> parts(hop.parts.data() + first, i - first);
    groups.back().parts.push_back(
        {static_cast<double>(takes.ps()), kinds[kind].look, title_of(groups.back().name, parts, takes, whole)});
  }
}

/// What the bar says, for those who do not see it: the kinds by their shares.
std::string label_of(const ExplainedFrame& frame) {
  std::array<sim::Duration, kinds.size()> sums{};
  for (const ExplainedHop& hop : frame.hops)
    for (const ExplainedPart& part : hop.parts) sums[kind_of(part)] += part.takes;
  std::vector<std::size_t> order;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    if (sums[kind] > sim::Duration()) order.push_back(kind);
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t kind) { return sums[kind]; });
  std::string text = fmt::format("{}, {}", frame.stream, readable(frame.takes));
  for (const std::size_t kind : order)
    text += fmt::format("; {} {}", kinds[kind].words, share_of(sums[kind], frame.takes));
  return text;
}

std::string table_of(const ExplainedFrame& frame) {
  chart::Table table({"hop", "cause", "behind", "took", "share"}, most_parts);
  std::string last;
  for (const ShownHop& each : explain::shown_hops(frame)) {
    if (each.hop.stored)
      table.row({{name_of(each)}, {"stored, not cut through"}, {*each.hop.stored}, {{}, true}, {{}, true}});
    for (const ExplainedPart& part : each.hop.parts) {
      const std::string where = each.place_of(part);
      table.row({{where == last ? std::string() : where},
                 {part.words},
                 {behind(part)},
                 {readable(part.takes), true},
                 {share_of(part.takes, frame.takes), true}});
      last = where;
    }
  }
  return table.take();
}

}  // namespace

std::string ways_section(const WorstWays& ways) {
  const std::vector<const ExplainedFrame*> frames = ways.frames();
  if (frames.empty()) return {};
  std::array<bool, kinds.size()> occurs{};
  std::string bars;
  for (const ExplainedFrame* const frame : frames) {
    chart::StackedBar bar{label_of(*frame), {}};
    for (const ShownHop& shown : explain::shown_hops(*frame)) {
      add_groups(shown, frame->takes, bar.groups);
      for (const ExplainedPart& part : shown.hop.parts) occurs[kind_of(part)] |= part.takes > sim::Duration();
    }
    bars += fmt::format(
        "<h3>{}: {}</h3><p class=\"note way\">frame {} from {}, produced at {}, delivered at {}{}</p>\n",
        chart::escaped(frame->stream), readable(frame->takes), frame->sequence, chart::escaped(frame->talker),
        readable(frame->produced.since_start()), chart::escaped(frame->node),
        frame->hops.size() > explain::most_hops
            ? fmt::format(" over {} hops; in a row without much of a wait they are summed", frame->hops.size())
            : "");
    bars += chart::stacked_bar_element(bar) + "<details><summary>Its figures, hop by hop</summary>" + table_of(*frame) +
            "</details>\n";
  }
  std::vector<chart::StackedKey> legend;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    if (occurs[kind]) legend.push_back({kinds[kind].look, std::string(kinds[kind].words)});
  std::string text =
      chart::section("Where the time went",
                     "Of each stream the frame that took longest, the slowest stream first. A bar is the whole time of "
                     "one frame, from hop to hop; takt explain tells the same of any frame.");
  text += chart::stacked_legend(legend) + bars;
  if (ways.left_out() > 0)
    text += fmt::format("<p class=\"note\">and {} more stream{}, none of them slower</p>\n", ways.left_out(),
                        ways.left_out() == 1 ? "" : "s");
  return text;
}

}  // namespace takt::report
