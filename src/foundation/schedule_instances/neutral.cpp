// SPDX-License-Identifier: Apache-2.0
// The neutral problem: every field of the model by its name, times in ps.
#include "schedule_instances/formats.hpp"

namespace takt::schedule_instances {

using namespace schedule;
using json::Node;

namespace {

void read_model(const Pick& pick, Model& model) {
  model.preamble = static_cast<std::uint32_t>(pick.whole("preamble", {0, 1000}, 8));
  model.gap = static_cast<std::uint32_t>(pick.whole("gap", {0, 1000}, 12));
  model.is_strict = pick.truth("strict", false);
  model.no_wait = pick.truth("no_wait", false);
  model.margin = pick.whole("margin", {0, 1'000'000'000'000}, 0);
  model.tick = pick.whole("tick", {1, 1'000'000'000'000}, 1'000);
  model.guard_octets = static_cast<std::uint32_t>(pick.whole("guard_octets", {0, 100'000}, 0));
}

void read_link(const Pick& pick, json::Reader& reader, Builder& builder) {
  const json::Place where = reader.source(pick.node()).place();
  Link link;
  if (pick.find("name") != nullptr) link.name = pick.text("name");
  link.octet = builder.octet_of(pick.whole("rate", rate_range), where);
  link.propagation = pick.whole("propagation", delay_range, 0);
  link.forwarding = pick.whole("forwarding", delay_range, 0);
  if (const auto cut = pick.whole_if_any("cut_through", {0, octets_range.most}))
    link.cut_through = static_cast<std::uint32_t>(*cut);
  link.entries = static_cast<std::uint32_t>(pick.whole("entries", {1, 1'000'000}, 1024));
  builder.add_link(std::move(link), pick.text("from"), pick.text("to"), where);
}

}  // namespace

void read_neutral_stream(const Pick& pick, json::Reader& reader, Builder& builder) {
  const json::Place where = reader.source(pick.node()).place();
  const std::size_t mistakes = builder.diagnostics().errors();
  Stream stream;
  stream.name = pick.text("name");
  stream.talker = builder.node(pick.text("talker"), where);
  if (const Node* const listeners = pick.need_array("listeners")) {
    if (listeners->items.empty()) reader.error(*listeners, "a stream without listeners");
    for (const Node& each : listeners->items)
      stream.listeners.push_back(builder.node(text_of(reader, each), reader.source(each).place()));
  }
  stream.octets = static_cast<std::uint32_t>(pick.whole("octets", octets_range));
  stream.frames = static_cast<std::uint32_t>(pick.whole("frames", frames_range, 1));
  stream.period = pick.whole("period", period_range);
  stream.release = pick.whole("release", time_range, 0);
  stream.deadline = pick.whole_if_any("deadline", time_range);
  stream.latency = pick.whole_if_any("latency", time_range);
  stream.jitter = pick.whole_if_any("jitter", time_range);
  stream.traffic_class = static_cast<std::uint8_t>(pick.whole("class", {0, 7}, 7));
  if (builder.diagnostics().errors() != mistakes) return;
  if (pick.find("route") != nullptr) {
    std::vector<LinkIndex> links;
    if (const Node* const route = pick.need_array("route"))
      for (const Node& each : route->items) {
        const std::string name = text_of(reader, each);
        if (const auto link = builder.link(name))
          links.push_back(*link);
        else
          reader.error(each, "there is no link " + json::quote(name));
      }
    if (builder.diagnostics().errors() == mistakes)
      builder.set_route(stream, std::move(links), reader.source(*pick.find("route")).place());
  }
  builder.add_stream(std::move(stream), where);
}

Instance read_neutral(const json::Document& document, json::Diagnostics& diagnostics) {
  json::Reader reader(document, diagnostics);
  const Pick top(reader, document.root());
  Builder builder(diagnostics);
  // For people: whatever it is.
  const auto words = [&](std::string_view key) {
    return top.find(key) != nullptr ? top.find(key)->text : std::string();
  };
  builder.problem().name = words("name").empty() ? stem_of(document.file_name()) : words("name");
  builder.problem().source = words("source");
  if (const Node* const model = top.find("model")) read_model(Pick(reader, *model), builder.problem().model);
  if (const Node* const nodes = top.need_array("nodes"))
    for (const Node& each : nodes->items) {
      const Pick pick(reader, each);
      builder.add_node(pick.text("name"), pick.truth("bridge"), reader.source(each).place());
    }
  if (const Node* const links = top.need_array("links"))
    for (const Node& each : links->items) read_link(Pick(reader, each), reader, builder);
  if (diagnostics.has_errors()) return {};
  if (const Node* const streams = top.need_array("streams"))
    for (const Node& each : streams->items) read_neutral_stream(Pick(reader, each), reader, builder);
  return builder.take();
}

}  // namespace takt::schedule_instances
