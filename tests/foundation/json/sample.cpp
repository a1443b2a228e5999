// SPDX-License-Identifier: Apache-2.0
#include "sample.hpp"

#include <algorithm>

namespace takt::sample {

using json::optional;
using json::required;
using sim::operator""_B;
using sim::operator""_Mbps;

const json::Enumeration& describe(json::Type<Os>) {
  static constexpr json::EnumName names[] = {
      json::name(Os::preempt_rt, "preempt-rt", "Linux with PREEMPT_RT."),
      json::name(Os::general_purpose, "general-purpose", "An office computer."),
      json::name(Os::guest, "guest", "A virtual machine."),
  };
  static constexpr json::Enumeration table = json::enumeration<Os>("an operating system", names);
  return table;
}

const json::Object& describe(json::Type<Host>) {
  static constexpr json::Field fields[] = {
      optional<&Host::os>("os", "What it runs."),
      optional<&Host::ports>("ports", "The UDP ports that are open.",
                             {.max_items = 3, .unique = true, .items = {.min = 1024}}),
  };
  static constexpr json::Object table = json::object<Host>("host", "A computer.", fields);
  return table;
}

const json::Object& describe(json::Type<Switch>) {
  static constexpr json::Field fields[] = {
      optional<&Switch::queues>("queues", "How many queues a port has.", {.min = 1, .max = 8}),
      optional<&Switch::delay>("delay", "From the last octet in to the first out.", {.max = 1_ms}),
  };
  static constexpr json::Object table = json::object<Switch>("switch", "A bridge.", fields);
  return table;
}

const json::Tagged& describe(json::Type<NetworkNode>) {
  static constexpr auto options = json::options<NetworkNode>({"host", "switch"});
  static constexpr json::Tagged table =
      json::tagged<NetworkNode>("node", "What stands at the end of a link.", "kind", options);
  return table;
}

const json::Object& describe(json::Type<Link>) {
  static constexpr json::Field fields[] = {
      required<&Link::ends>("ends", "The two nodes that it joins.",
                            {.min_items = 2, .max_items = 2, .items = {.min_length = 1}}),
      optional<&Link::rate>("rate", "Bits a second in each direction.", {.min = 10_Mbps}),
      optional<&Link::length>("length", "Of the cable."),
      optional<&Link::loss>("loss", "How likely a frame is lost."),
  };
  static constexpr json::Object table = json::object<Link>("link", "A full-duplex cable.", fields);
  return table;
}

const json::Object& describe(json::Type<Oscillator>) {
  static constexpr json::Field fields[] = {
      optional<&Oscillator::offset>("offset", "From the nominal frequency."),
      optional<&Oscillator::drift>("drift", "Of the offset."),
  };
  static constexpr json::Object table =
      json::object<Oscillator>("oscillator", "What a clock counts.", fields, {.shorthand = "offset"});
  return table;
}

const json::Object& describe(json::Type<Fault>) {
  static constexpr json::Field fields[] = {
      required<&Fault::at>("at", "When it begins."),
      optional<&Fault::link_down>("link_down", "The ends of a link that fails.", {.min_items = 2, .max_items = 2}),
      optional<&Fault::crash>("crash", "A node that stops."),
  };
  static constexpr std::string_view kinds[] = {"link_down", "crash"};
  static constexpr json::Group groups[] = {json::exactly_one_of(kinds)};
  static constexpr json::Object table =
      json::object<Fault>("fault", "Something that breaks.", fields, {.groups = groups});
  return table;
}

namespace {

void decode_selection(const json::Node& node, Selection& selection, json::Reader& reader) {
  if (node.kind != json::Kind::string) return json::decode_value(node, selection.names, reader);
  selection.all = node.text == "all";
  if (!selection.all)
    reader.error(node, "not a selection", {json::quote(node.text), "\"all\" or an array of names", ""});
}

json::Node encode_selection(const Selection& selection) {
  return selection.all ? json::Node::of_string("all") : json::encode_value(selection.names);
}

json::Node selection_schema(json::SchemaBuilder& builder) {
  json::Node all = json::Node::object();
  all.add("const", json::Node::of_string("all"));
  json::Node either = json::Node::array();
  either.items.push_back(all);
  either.items.push_back(json::schema_value<std::vector<std::string>>(builder));
  json::Node schema = json::Node::object();
  schema.add("anyOf", either);
  return schema;
}

}  // namespace

const json::Custom& describe(json::Type<Selection>) {
  static constexpr json::Custom table = json::custom<Selection, decode_selection, encode_selection, selection_schema>();
  return table;
}

const json::Object& describe(json::Type<Group>) {
  static constexpr json::Field fields[] = {
      required<&Group::name>("name", "What it is called.", {.min_length = 1, .max_length = 20}),
      optional<&Group::parts>("parts", "What it consists of."),
  };
  static constexpr json::Object table = json::object<Group>("group", "Nodes that belong together.", fields);
  return table;
}

const json::Object& describe(json::Type<Sample>) {
  static constexpr json::Field fields[] = {
      required<&Sample::name>("name", "Of the sample.", {.min_length = 1}),
      optional<&Sample::seed>("seed", "Of all random numbers."),
      optional<&Sample::level>("level", "Any integer will do.", {.min = -5, .max = 5}),
      optional<&Sample::weight>("weight", "A share.", {.min = 0, .max = 1, .above_min = true}),
      optional<&Sample::traced>("traced", "Whether events are recorded."),
      optional<&Sample::duration>("duration", "How long it runs.",
                                  {.min = sim::Duration{}, .max = 3600_s, .above_min = true}),
      optional<&Sample::phase>("phase", "Where it starts.", {.min = -(1_s), .max = 1_s}),
      optional<&Sample::payload>("payload", "Of a frame.", {.min = 46_B, .max = 1500_B}),
      optional<&Sample::master>("master", "The node that leads."),
      optional<&Sample::nodes>("nodes", "By name."),
      optional<&Sample::links>("links", "Between the nodes."),
      optional<&Sample::oscillator>("oscillator", "Of all nodes."),
      optional<&Sample::faults>("faults", "In any order."),
      optional<&Sample::captured>("captured", "The links that are captured."),
      optional<&Sample::group>("group", "The whole plant."),
  };
  static constexpr json::Object table = json::object<Sample>("sample", "All kinds of fields.", fields);
  return table;
}

void check(const Sample& sample, json::Diagnostics& diagnostics) {
  const auto is_node = [&sample](const std::string& name) {
    return std::ranges::any_of(sample.nodes, [&name](const auto& node) { return node.first == name; });
  };
  for (const Link& link : sample.links)
    for (std::size_t end = 0; end < link.ends.size(); ++end)
      if (!is_node(link.ends[end]))
        diagnostics.error(link.where.at("ends", end), "no such node",
                          {json::quote(link.ends[end]), "the name of a node", ""});
}

const std::string_view full_text = R"({
  // every field once
  "$schema": "sample.schema.json",
  "name": "full", "seed": 18446744073709551615, "level": -5, "weight": 0.25, "traced": true,
  "duration": "1.5ms", "phase": "-20us", "payload": "1500B", "master": "a",
  "nodes": {
    "a": {"kind": "host", "os": "guest", "ports": [4840, 4841]},
    "b": {"kind": "host"},
    "sw": {"kind": "switch", "queues": 4, "delay": "0s"}
  },
  "links": [
    {"ends": ["a", "sw"], "rate": "2.5Gbps", "length": "20cm", "loss": "0.1%"},
    {"ends": ["sw", "b"], "loss": 1e-12}
  ],
  "oscillator": {"offset": "-50ppm", "drift": "1.5ppb/s"},
  "faults": [{"at": "5s", "link_down": ["a", "sw"]}, {"at": "1min", "crash": "b"}],
  "captured": "all",
  "group": {"name": "plant", "parts": [{"name": "cell", "parts": [{"name": "robot"}]}]}
}
)";

}  // namespace takt::sample
