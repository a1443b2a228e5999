// SPDX-License-Identifier: Apache-2.0
#include "synthesis/change_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "json/node.hpp"
#include "json/quantity.hpp"

namespace takt::synthesis {
namespace {

constexpr const char* fates[] = {"comes", "goes", "moves", "lost"};

std::optional<Duration> offset_of(const std::optional<scenario::Stream>& stream) {
  return stream && stream->offset ? std::optional<Duration>(stream->offset->value) : std::nullopt;
}

/// "0-5, 7" of the classes that are open.
std::string classes(const std::vector<std::uint64_t>& open) {
  std::string text;
  for (std::size_t i = 0; i < open.size(); ++i) {
    std::size_t last = i;
    while (last + 1 < open.size() && open[last + 1] == open[last] + 1) ++last;
    text += (text.empty() ? "" : ",") + std::to_string(open[i]) + (last == i ? "" : "-" + std::to_string(open[last]));
    i = last;
  }
  return text.empty() ? "none" : text;
}

std::string list_text(const std::vector<WrittenEntryRow>& entries) {
  constexpr std::size_t most = 8;  // the whole list stands in the transition's scenario and in the JSON
  std::string text;
  for (std::size_t i = 0; i < std::min(most, entries.size()); ++i)
    text += (i == 0 ? "" : ", ") + classes(entries[i].open) + " " + json::to_text(entries[i].interval);
  return entries.size() > most ? text + fmt::format(", and {} more", entries.size() - most) : text;
}

std::string way_text(const std::vector<std::string>& path) {
  std::string text;
  for (const std::string& node : path) text += (text.empty() ? "" : " ") + node;
  return text;
}

std::string text_of(const ChangedStreamRow& row) {
  std::string text = fmt::format("  {} {}", row.name, row.what == "lost" ? "has no other place" : row.what);
  if (row.was_cut) text += row.what == "lost" ? "; what has failed was on its way" : ", whose way has failed";
  if (row.path) text += ": " + way_text(*row.path);
  if (row.offset) text += fmt::format("{}offset {}", row.path ? ", " : ": ", json::to_text(*row.offset));
  if (row.offset_before && row.offset && row.offset_before != row.offset)
    text += fmt::format(" instead of {}", json::to_text(*row.offset_before));
  if (row.last) text += fmt::format("; last frame {}due at {}", row.first ? "there " : "", json::to_text(*row.last));
  if (row.first) text += fmt::format("; first frame {}due at {}", row.last ? "here " : "", json::to_text(*row.first));
  return text + "\n";
}

std::string table_of(const ChangeSummary& summary) {
  std::size_t widest = 4;
  std::uint64_t steps = 0;
  for (const WrittenListRow& each : summary.lists) {
    widest = std::max(widest, each.port.size());
    steps = std::max(steps, each.step);
  }
  for (const ChangedStreamRow& each : summary.changes) steps = std::max(steps, each.step.value_or(0));
  std::string text = fmt::format("  {:>4}  {:>12}  {:>10}  {:{}}  {:>8}  {}\n", "step", "at", "holds from", "port",
                                 widest, "cycle", "open classes, in turn");
  for (std::uint64_t step = 1; step <= steps; ++step) {
    for (const WrittenListRow& each : summary.lists)
      if (each.step == step)
        text += fmt::format("  {:>4}  {:>12}  {:>10}  {:{}}  {:>8}  {}\n", step, json::to_text(each.written),
                            json::to_text(each.holds_from), each.port, widest, json::to_text(each.cycle),
                            list_text(each.entries));
    for (const ChangedStreamRow& each : summary.changes)
      if (each.step == step)
        text += fmt::format("  {:>4}  {:>12}  {:>10}  {} {}\n", step,
                            json::to_text(each.first ? *each.first : each.last.value_or(Duration())), "",
                            json::quote(each.name), each.what == "lost" ? "goes" : each.what);
  }
  return text;
}

std::string names_text(const char* what, const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += fmt::format("  {}: {}\n", what, json::quote(name));
  return text;
}

}  // namespace

ChangeSummary summary_of(const std::string& scenario, const ScenarioChange& change) {
  ChangeSummary made;
  made.scenario = scenario;
  made.verdict = change.after == nullptr ? "undecided" : change.is_done ? "changed" : "partly";
  made.how = change.how;
  made.without_place = change.without_place;
  made.without_way = change.without_way;
  made.would_pause = change.would_pause;
  for (const StreamChange& each : change.changes) {
    ChangedStreamRow row{each.name,
                         fates[static_cast<std::size_t>(each.fate)],
                         each.was_cut,
                         {},
                         {},
                         offset_of(each.before),
                         offset_of(each.after),
                         {},
                         {},
                         {}};
    if (each.before) row.path_before = each.before->path;
    if (each.after) row.path = each.after->path;
    made.changes.push_back(std::move(row));
  }
  if (change.after == nullptr) return made;
  made.at = change.at;
  made.end = change.transition.end;
  made.duration = change.simulated.scenario.duration;
  made.frames = change.verdict.frames;
  made.streams = change.verdict.streams;
  for (std::size_t s = 0; s < change.transition.steps.size(); ++s) {
    for (const WrittenList& each : change.transition.steps[s].lists) {
      WrittenListRow row{
          s + 1, change.flows.problem.flows.ports[each.port].name, each.written, each.holds_from, each.list.cycle, {}};
      for (const scenario::GateList::Entry& entry : each.list.entries) {
        WrittenEntryRow& made_entry = row.entries.emplace_back();
        for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
          if ((entry.open >> q & 1) != 0) made_entry.open.push_back(q);
        made_entry.interval = entry.interval;
      }
      made.lists.push_back(std::move(row));
    }
    for (const TalkerSwitch& each : change.transition.steps[s].talkers) {
      const FlowChange& flow = change.flows.problem.changes[each.change];
      made.changes[each.change].step = s + 1;
      if (each.last) made.changes[each.change].last = *each.last - change.flows.lags[*flow.leaves];
      if (each.first) made.changes[each.change].first = *each.first - change.flows.lags[*flow.comes];
    }
  }
  return made;
}

std::string text_of(const ChangeSummary& summary) {
  std::string text =
      fmt::format("{}: {}{}", summary.scenario, summary.verdict, summary.how.empty() ? "" : " (" + summary.how + ")");
  if (summary.at)
    text += fmt::format(", from {} to {}, {} lists written", json::to_text(*summary.at), json::to_text(*summary.end),
                        summary.lists.size());
  text += "\n";
  text += names_text("no place for", summary.without_place) + names_text("would have to pause", summary.would_pause);
  if (summary.at) {
    std::uint64_t lost = 0;
    for (const CarriedStream& each : summary.streams) lost += each.lost;
    text += fmt::format(
        "  judged: {} frames of {} streams simulated, {}, none late; all ports end with the lists of the plant "
        "afterwards\n",
        summary.frames, summary.streams.size(),
        lost == 0 ? "none lost" : std::to_string(lost) + " lost to what has failed and no other");
  }
  for (const ChangedStreamRow& each : summary.changes) text += text_of(each);
  text += names_text("without windows, over what has failed, left as it is", summary.without_way);
  if (!summary.lists.empty()) text += table_of(summary);
  return text;
}

const json::Record& describe(json::Type<ChangedStreamRow>) {
  static constexpr json::Output outputs[] = {
      json::output<&ChangedStreamRow::name>("stream", "Its name."),
      json::output<&ChangedStreamRow::what>(
          "what", "comes, goes, moves (to another time or way) or lost (there is no other place for it, and it goes)."),
      json::output<&ChangedStreamRow::was_cut>("was_cut", "What has failed was on its way."),
      json::output<&ChangedStreamRow::path_before>("path_before",
                                                   "Its path before; null if it comes or takes the shortest."),
      json::output<&ChangedStreamRow::path>("path", "Its path afterwards; null if it goes, or has several listeners."),
      json::output<&ChangedStreamRow::offset_before>("offset_before_ps", "Its offset before; null if it comes."),
      json::output<&ChangedStreamRow::offset>("offset_ps", "Its offset afterwards; null if it goes."),
      json::output<&ChangedStreamRow::step>("step",
                                            "The step in which its talker changes over, from 1; of one that pauses the "
                                            "step in which it goes on. Null without a transition."),
      json::output<&ChangedStreamRow::last>("last_ps", "When its last frame at the old time is due; null if it comes."),
      json::output<&ChangedStreamRow::first>("first_ps",
                                             "When its first frame at the new time is due; null if it goes."),
  };
  static constexpr json::Record record{"changed_stream", "A stream that comes, goes or moves.", outputs};
  return record;
}

const json::Record& describe(json::Type<WrittenEntryRow>) {
  static constexpr json::Output outputs[] = {
      json::output<&WrittenEntryRow::open>("open", "Traffic classes whose gates are open."),
      json::output<&WrittenEntryRow::interval>("for_ps", "For how long."),
  };
  static constexpr json::Record record{"written_entry", "An entry of a gate control list.", outputs};
  return record;
}

const json::Record& describe(json::Type<WrittenListRow>) {
  static constexpr json::Output outputs[] = {
      json::output<&WrittenListRow::step>(
          "step", "From 1. Lists of one step are written at one instant; in the steps between talkers change over."),
      json::output<&WrittenListRow::port>("port", "The port, as \"sw1 to sw2\"."),
      json::output<&WrittenListRow::written>("written_ps", "When ConfigChange is set."),
      json::output<&WrittenListRow::holds_from>("holds_from_ps",
                                                "AdminBaseTime, which is ConfigChangeTime (IEEE 802.1Q 8.6.9.3.1)."),
      json::output<&WrittenListRow::cycle>("cycle_ps", "AdminCycleTime."),
      json::output<&WrittenListRow::entries>("entries", "AdminControlList."),
  };
  static constexpr json::Record record{"written_list", "An administrative list for a port.", outputs};
  return record;
}

const json::Record& describe(json::Type<CarriedStream>) {
  static constexpr json::Output outputs[] = {
      json::output<&CarriedStream::name>(
          "stream", "Its name in the scenario of the transition, where a stream that moves is two."),
      json::output<&CarriedStream::sent>("sent", "Frames that were sent."),
      json::output<&CarriedStream::delivered>("delivered", "Frames that came."),
      json::output<&CarriedStream::lost>("lost", "Frames that what failed has taken."),
      json::output<&CarriedStream::planned>("planned_ps",
                                            "The latency that its windows give it, from when a frame is due."),
      json::output<&CarriedStream::least>("least_ps", "The least latency of the run; null if nothing came."),
      json::output<&CarriedStream::greatest>("greatest_ps", "The greatest latency of the run; null if nothing came."),
  };
  static constexpr json::Record record{"carried_stream", "A stream with windows in the simulated transition.", outputs};
  return record;
}

const json::Record& describe(json::Type<ChangeSummary>) {
  static constexpr json::Output outputs[] = {
      json::output<&ChangeSummary::scenario>("scenario", "Its name."),
      json::output<&ChangeSummary::verdict>(
          "verdict",
          "changed; partly: some stream has no place any more, or gets none; or undecided: no transition is known."),
      json::output<&ChangeSummary::how>("how", "What stands in the way; empty if nothing does."),
      json::output_if_any<&ChangeSummary::at>("at_ps", "When the change begins, and what fails does so.",
                                              "with a transition"),
      json::output_if_any<&ChangeSummary::end>("end_ps", "From when on all lists are those of the plant afterwards.",
                                               "with a transition"),
      json::output_if_any<&ChangeSummary::duration>("simulated_ps", "How long the simulation is.", "with a transition"),
      json::output<&ChangeSummary::changes>("changes", "Streams that come, go or move."),
      json::output<&ChangeSummary::without_place>("without_place", "Streams that should come and get no place."),
      json::output<&ChangeSummary::without_way>("without_way",
                                                "Streams without windows whose way has failed; they stay as they are."),
      json::output<&ChangeSummary::would_pause>("would_pause", "Streams that no order of steps keeps running."),
      json::output<&ChangeSummary::lists>("lists", "What is written to ports, in order."),
      json::output<&ChangeSummary::frames>("frames", "Frames of streams with windows in the simulation."),
      json::output<&ChangeSummary::streams>("streams", "How the streams with windows fared there."),
  };
  static constexpr json::Record record{"scenario_change", "A scheduled scenario that changes while it runs.", outputs};
  return record;
}

}  // namespace takt::synthesis
