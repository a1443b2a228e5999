// SPDX-License-Identifier: Apache-2.0
// tsnkit: tasks and a topology as CSV, times in ns, rates in bits per ns; sizes as they are sent. A node with one link
// in each direction is an end station; what it takes to process a frame there counts as latency.
#include <map>

#include "schedule_instances/lines.hpp"

namespace takt::schedule_instances {

using namespace schedule;

namespace {

constexpr double ps_per_ns = 1'000;

void read_topology(const TextFile& file, Builder& builder, json::Diagnostics& diagnostics) {
  enum Column : std::size_t { link_column, rate, processing, propagation };
  const Csv csv(file, {"link", "rate", "t_proc", "t_prop"}, diagnostics);
  std::map<std::int64_t, int> ends;  // nodes in order of their numbers
  std::vector<std::pair<std::string, std::string>> links;
  for (const Line& row : csv.rows()) {
    const auto pair = list_of(csv.cell(row, link_column).text);
    constexpr Range numbers{0, 1'000'000'000};
    const auto a = pair && pair->size() == 2 ? whole_of((*pair)[0], numbers) : std::nullopt;
    const auto b = pair && pair->size() == 2 ? whole_of((*pair)[1], numbers) : std::nullopt;
    if (!a || !b) {
      diagnostics.error(csv.place(row, link_column), "not a link",
                        {json::quote(csv.cell(row, link_column).text), "two numbers of nodes, such as \"(0, 1)\""});
      links.emplace_back();
      continue;
    }
    ++ends[*a];
    ++ends[*b];
    links.emplace_back(std::to_string(*a), std::to_string(*b));
  }
  for (const auto& [number, count] : ends) builder.add_node(std::to_string(number), count > 2, place_in(file, 1));
  for (std::size_t i = 0; i < csv.rows().size(); ++i) {
    if (links[i].first.empty()) continue;
    const Line& row = csv.rows()[i];
    Link link;
    link.name = "(" + links[i].first + ", " + links[i].second + ")";
    link.octet = builder.octet_of(csv.scaled(row, rate, 1e9, rate_range), csv.place(row, rate));
    link.propagation = csv.scaled(row, propagation, ps_per_ns, delay_range);
    link.forwarding = csv.scaled(row, processing, ps_per_ns, delay_range);
    builder.add_link(std::move(link), links[i].first, links[i].second, csv.place(row, link_column));
  }
}

}  // namespace

Instance read_tsnkit(const TextFile& tasks, const TextFile& topology, json::Diagnostics& diagnostics) {
  Builder builder(diagnostics);
  std::string name = stem_of(tasks.name);
  for (const std::string_view ending : {"_task", "-task", "task"})
    if (name.size() > ending.size() && name.ends_with(ending)) {
      name.resize(name.size() - ending.size());
      break;
    }
  builder.problem().name = name;
  builder.problem().source = "tsnkit";
  builder.problem().model.preamble = 0;
  builder.problem().model.gap = 0;
  builder.problem().model.is_strict = true;
  read_topology(topology, builder, diagnostics);
  if (diagnostics.has_errors()) return {};
  enum Column : std::size_t { stream_column, source, destination, size, period, deadline, jitter };
  const Csv csv(tasks, {"stream", "src", "dst", "size", "period", "deadline", "jitter"}, diagnostics);
  for (const Line& row : csv.rows()) {
    const std::size_t mistakes = diagnostics.errors();
    Stream stream;
    stream.name = trimmed(csv.cell(row, stream_column).text);
    if (stream.name.empty()) diagnostics.error(csv.place(row, stream_column), "a stream without a name");
    stream.talker = builder.node(std::string(trimmed(csv.cell(row, source).text)), csv.place(row, source));
    const auto listeners = list_of(csv.cell(row, destination).text);
    if (!listeners || listeners->empty())
      diagnostics.error(csv.place(row, destination), "not a list of nodes",
                        {json::quote(csv.cell(row, destination).text), "a list such as \"[3, 4]\""});
    else
      for (const std::string& each : *listeners)
        stream.listeners.push_back(builder.node(each, csv.place(row, destination)));
    stream.octets = static_cast<std::uint32_t>(csv.whole(row, size, octets_range));
    stream.period = csv.scaled(row, period, ps_per_ns, period_range);
    stream.latency = csv.scaled(row, deadline, ps_per_ns, time_range);
    // A jitter as long as the deadline is no limit.
    if (const Ps limit = csv.scaled(row, jitter, ps_per_ns, time_range); limit < *stream.latency) stream.jitter = limit;
    if (diagnostics.errors() == mistakes) builder.add_stream(std::move(stream), csv.place(row, stream_column));
  }
  return builder.take();
}

}  // namespace takt::schedule_instances
