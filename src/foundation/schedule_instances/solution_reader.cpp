// SPDX-License-Identifier: Apache-2.0
// Neutral solutions, and streams that come to a problem.
#include <fmt/format.h>

#include <algorithm>

#include "schedule_instances/formats.hpp"
#include "schedule_instances/solutions.hpp"

namespace takt::schedule_instances {

using namespace schedule;
using json::Node;

namespace {

void read_placement(json::Reader& reader, const Builder& builder, const Pick& pick, const Stream& stream,
                    std::optional<Placement>& made) {
  Placement placement;
  const std::size_t mistakes = reader.diagnostics().errors();
  if (pick.find("route") != nullptr) {
    if (const Node* const route = pick.need_array("route"))
      for (const Node& each : route->items) {
        const std::string name = text_of(reader, each);
        if (const auto link = builder.link(name))
          placement.route.push_back(*link);
        else
          reader.error(each, "there is no link " + json::quote(name));
      }
  } else if (stream.route) {
    placement.route = *stream.route;
  } else {
    reader.error(pick.node(), "missing \"route\"");
  }
  constexpr Range starts{-longest_time, longest_time};
  if (const Node* const list = pick.need_array("start"))
    for (const Node& each : list->items) {
      auto& of_link = placement.starts.emplace_back();
      if (each.kind != json::Kind::array)
        of_link.push_back(whole_of(reader, each, starts));
      else
        for (const Node& one : each.items) of_link.push_back(whole_of(reader, one, starts));
      if (of_link.empty()) reader.error(each, "no start");
    }
  const Node* const classes = pick.find("class");
  constexpr Range class_range{0, 7};
  placement.classes.assign(placement.route.size(), stream.traffic_class);
  if (classes != nullptr && classes->kind != json::Kind::array) {
    std::fill(placement.classes.begin(), placement.classes.end(),
              static_cast<std::uint8_t>(whole_of(reader, *classes, class_range)));
  } else if (classes != nullptr) {
    placement.classes.clear();
    for (const Node& each : classes->items)
      placement.classes.push_back(static_cast<std::uint8_t>(whole_of(reader, each, class_range)));
  }
  if (reader.diagnostics().errors() != mistakes) return;
  if (placement.route.empty() || placement.starts.size() != placement.route.size() ||
      placement.classes.size() != placement.route.size())
    return reader.error(pick.node(), "not as many starts and classes as links",
                        {fmt::format("{} links, {} starts, {} classes", placement.route.size(), placement.starts.size(),
                                     placement.classes.size()),
                         "as many of each"});
  made = std::move(placement);
}

}  // namespace

Solution read_solution(const json::Document& document, const Problem& problem, json::Diagnostics& diagnostics) {
  json::Reader reader(document, diagnostics);
  const Pick top(reader, document.root());
  Builder builder(problem, diagnostics);
  Solution solution;
  solution.streams.resize(problem.streams.size());
  if (top.find("timing") != nullptr) {
    const std::string timing = top.text("timing");
    if (timing != "held" && timing != "flowing")
      reader.error(*top.find("timing"), "not a timing", {json::quote(timing), "\"held\" or \"flowing\""});
    solution.timing = timing == "flowing" ? GateTiming::flowing : GateTiming::held;
  }
  const Node* const streams = top.need("streams");
  if (streams == nullptr) return solution;
  if (streams->kind != json::Kind::object) reader.wrong_type(*streams, "an object");
  for (const json::Member& member : streams->members) {
    const auto index = builder.stream(member.key);
    if (!index) {
      reader.error_at_key(member, "there is no stream " + json::quote(member.key));
      continue;
    }
    read_placement(reader, builder, Pick(reader, member.value), problem.streams[*index], solution.streams[*index]);
  }
  return solution;
}

std::vector<Stream> read_streams(const json::Document& document, const Problem& problem,
                                 json::Diagnostics& diagnostics) {
  json::Reader reader(document, diagnostics);
  const Pick top(reader, document.root());
  Builder builder(problem, diagnostics);
  if (const Node* const streams = top.need_array("streams"))
    for (const Node& each : streams->items) read_neutral_stream(Pick(reader, each), reader, builder);
  const auto& all = builder.problem().streams;
  return {all.begin() + static_cast<std::ptrdiff_t>(problem.streams.size()), all.end()};
}

}  // namespace takt::schedule_instances
