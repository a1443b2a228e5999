// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "explain/explanation.hpp"
#include "explain/shown_hops.hpp"
#include "json/page_text.hpp"
#include "json/quantity.hpp"

namespace takt::explain {
namespace {

std::string blame_of(const ExplainedPart& part) {
  std::string text = part.words;
  if (part.stream) text += fmt::format(": {} frame {}", *part.stream, *part.sequence);
  if (part.gate_entry) text += fmt::format(" (entry {})", *part.gate_entry);
  if (part.missing_bits) text += fmt::format(" ({} bits missing)", *part.missing_bits);
  return text;
}

std::string share_of(Duration part, Duration whole) {
  return whole > Duration()
             ? fmt::format("{:.1f} %", 100.0 * static_cast<double>(part.ps()) / static_cast<double>(whole.ps()))
             : "";
}

std::string name_of(const ExplainedHop& hop) {
  return fmt::format("{}:{} to {}", hop.node, hop.port.value_or(0), hop.to.value_or("nothing"));
}

std::string end_of(const ExplainedFrame& frame) {
  const std::string where = frame.port ? fmt::format("{}:{}", frame.node, *frame.port) : frame.node;
  if (frame.reason) return fmt::format("dropped at {}: {}", where, *frame.reason);
  return frame.end == "delivered" ? "delivered at " + where : "under way at the end, at " + where;
}

/// Of the two columns of text of a table.
struct Widths {
  std::size_t where = 5, what = 4;  // their titles
  void hold(std::string_view a, std::string_view b) {
    where = std::max(where, a.size());
    what = std::max(what, b.size());
  }
};

void add_frame(std::string& page, const ExplainedFrame& frame, std::string_view indent) {
  const std::vector<ShownHop> shown = shown_hops(frame);
  Widths widths;
  for (const ShownHop& each : shown)
    for (const ExplainedPart& part : each.hop.parts) widths.hold(each.place_of(part), blame_of(part));
  page += fmt::format("{}{} frame {} from {}: {}, {} after it was produced at {}\n", indent, frame.stream,
                      frame.sequence, frame.talker, end_of(frame), json::to_page_text(frame.takes),
                      json::to_page_text(frame.produced.since_start()));
  std::string last = "-";
  for (const ShownHop& each : shown) {
    if (each.hop.stored) {
      last = name_of(each.hop);
      page += fmt::format("{}  {:<{}} stored, not cut through: {}\n", indent, last, widths.where, *each.hop.stored);
    }
    for (const ExplainedPart& part : each.hop.parts) {
      std::string where = each.place_of(part);
      const bool is_same = where == last;
      last = where;
      page +=
          fmt::format("{}  {:<{}} {:<{}} {:>14} {:>7}\n", indent, is_same ? "" : where, widths.where, blame_of(part),
                      widths.what, json::to_page_text(part.takes), share_of(part.takes, frame.takes));
    }
  }
  if (shown.size() < frame.hops.size())
    page += fmt::format("{}  {} hops; in a row without much of a wait they are summed, --format json has each\n",
                        indent, frame.hops.size());
}

void add_reaction(std::string& page, const ExplainedReaction& reaction) {
  page += fmt::format("Program {}: {} from {} at {} took {}\n", reaction.program, reaction.kind, reaction.cause,
                      json::to_page_text(reaction.began.since_start()), json::to_page_text(reaction.takes));
  Widths widths;
  for (const ExplainedStep& step : reaction.steps) widths.hold(step.who, step.what);
  for (const ExplainedStep& step : reaction.steps) {
    page += fmt::format("  {:<{}} {:<{}} {:>14} {:>7}\n", step.who, widths.where, step.what, widths.what,
                        json::to_page_text(step.takes), share_of(step.takes, reaction.takes));
    if (step.message) add_frame(page, *step.message, "      ");
  }
}

}  // namespace

std::string place_of(const ExplainedHop& hop, const ExplainedPart& part) {
  if (!hop.port) return hop.node;
  const bool at_next =
      part.cause == "forwarding" || part.cause == "jitter" || part.cause == "os_receive" || part.cause == "processor";
  return at_next ? hop.to.value_or("") : name_of(hop);
}

std::string text_of(const Explanation& explanation) {
  std::string page = fmt::format("{}: {}\n\n", explanation.scenario, explanation.question);
  if (explanation.reaction) add_reaction(page, *explanation.reaction);
  for (const ExplainedFrame& frame : explanation.frames) add_frame(page, frame, "");
  if (explanation.bound) {
    Widths widths;
    for (const ExplainedShare& share : explanation.shares) widths.hold(share.where, share.what);
    page += fmt::format("{}Bound {}\n  {:<{}} {:<{}} {:>14} {:>14}\n", page.ends_with("\n\n") ? "" : "\n",
                        json::to_page_text(*explanation.bound), "where", widths.where, "what", widths.what, "bound",
                        "worst run");
    for (const ExplainedShare& share : explanation.shares)
      page += fmt::format("  {:<{}} {:<{}} {:>14} {:>14}\n", share.where, widths.where, share.what, widths.what,
                          share.bound ? json::to_page_text(*share.bound) : "",
                          share.run ? json::to_page_text(*share.run) : "");
  }
  return page;
}

}  // namespace takt::explain
