// SPDX-License-Identifier: Apache-2.0
// The industrial challenge of ECRTS'25: "NAME.key = value", periods in 10 ns, routes given. What is scheduled is class
// TC7, at 100 Mbit/s; the other classes are not read further. A stream is to be there within half a period, as its
// contestants read it.
#include <fmt/format.h>

#include <map>

#include "schedule_instances/lines.hpp"

namespace takt::schedule_instances {

using namespace schedule;

namespace {

constexpr std::int64_t rate = 100'000'000;

struct Field {
  std::string value;
  json::Place where;
};

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const std::size_t end = std::min(text.find_first_of(" \t,;"), text.size());
    if (end != 0) words.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(text.size(), end + 1));
  }
  return words;
}

}  // namespace

Instance read_ecrts(const TextFile& file, json::Diagnostics& diagnostics) {
  std::vector<std::string> order;
  std::map<std::string, std::map<std::string, Field>> fields;
  std::string_view rest = file.text;
  for (std::uint32_t number = 1; !rest.empty() && number <= most_lines; ++number) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = trimmed(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    const std::size_t equals = line.find('='), dot = line.rfind('.', equals);
    if (equals == std::string_view::npos || dot == std::string_view::npos || dot == 0) continue;
    const std::string name(trimmed(line.substr(0, dot)));
    if (!fields.contains(name)) order.push_back(name);
    fields[name][std::string(trimmed(line.substr(dot + 1, equals - dot - 1)))] = {
        std::string(trimmed(line.substr(equals + 1))), place_in(file, number, static_cast<std::uint32_t>(equals + 2))};
  }
  Builder builder(diagnostics);
  builder.problem().name = stem_of(file.name);
  builder.problem().source = "ECRTS'25 challenge";
  builder.problem().model.preamble = 0;
  builder.problem().model.gap = 0;
  builder.problem().model.is_strict = true;
  if (order.empty()) diagnostics.error(place_in(file, 1), "no stream is described");
  for (const std::string& name : order) {
    auto& of_stream = fields[name];
    const std::size_t mistakes = diagnostics.errors();
    const auto get = [&](const std::string& key) -> const Field& {
      const auto found = of_stream.find(key);
      if (found == of_stream.end())
        diagnostics.error(of_stream.begin()->second.where,
                          fmt::format("{} has no {}", json::quote(name), json::quote(key)));
      return found == of_stream.end() ? of_stream.begin()->second : found->second;
    };
    const auto whole = [&](const std::string& key, Range range) {
      const Field& field = get(key);
      const auto value = whole_of(field.value, range);
      if (!value && of_stream.contains(key))
        diagnostics.error(
            field.where, "not in range",
            {json::quote(field.value), fmt::format("a whole number from {} to {}", range.least, range.most)});
      return value.value_or(range.least);
    };
    const Field& path = get("path");
    const std::vector<std::string> nodes = words_of(path.value);
    if (nodes.size() < 2 && of_stream.contains("path")) diagnostics.error(path.where, "a path of fewer than two nodes");
    if (diagnostics.errors() != mistakes) continue;
    for (const std::string& each : nodes)
      if (!builder.has_node(each)) builder.add_node(each, each.starts_with("SW"), path.where);
    std::vector<LinkIndex> links;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      if (!builder.link_between(nodes[i], nodes[i + 1])) {
        Link link;
        link.octet = builder.octet_of(rate, path.where);
        builder.add_link(std::move(link), nodes[i], nodes[i + 1], path.where);
      }
      if (const auto link = builder.link_between(nodes[i], nodes[i + 1])) links.push_back(*link);
    }
    const Field& traffic_class = get("trafficClass");
    const std::string_view number = std::string_view(traffic_class.value).starts_with("TC")
                                        ? std::string_view(traffic_class.value).substr(2)
                                        : std::string_view();
    const auto is = whole_of(number, {0, 7});
    if (!is && of_stream.contains("trafficClass"))
      diagnostics.error(traffic_class.where, "not a traffic class", {json::quote(traffic_class.value), "TC0 to TC7"});
    Stream stream;
    stream.period = whole("period", {1, period_range.most / 10'000}) * 10'000;
    stream.octets = static_cast<std::uint32_t>(whole("maxFrameSize", octets_range));
    if (diagnostics.errors() != mistakes || *is != 7) continue;
    stream.name = name;
    stream.talker = builder.node(nodes.front(), path.where);
    stream.listeners = {builder.node(nodes.back(), path.where)};
    stream.latency = stream.period / 2;
    builder.set_route(stream, std::move(links), path.where);
    if (diagnostics.errors() == mistakes) builder.add_stream(std::move(stream), path.where);
  }
  return builder.take();
}

}  // namespace takt::schedule_instances
