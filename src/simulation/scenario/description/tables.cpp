// SPDX-License-Identifier: Apache-2.0
// The vocabulary of scenario files: for each struct of description.hpp the table of its fields. Decoding, the resolved
// copy and the JSON Schema are all made from these tables. Networks have a file of their own.
#include "json/prose.hpp"
#include "models/ethernet/sizes.hpp"
#include "plant/limits.hpp"
#include "scenario/description/description.hpp"
#include "scenario/description/limits.hpp"

namespace takt::scenario {
namespace {

using json::name;
using json::optional;
using json::required;
using plant::longest;
using plant::longest_step;
using plant::most_names;

constexpr Duration longest_mean_gap = 3600_s;  // random gaps may be 44 times their mean

}  // namespace

const json::Enumeration& describe(json::Type<Encapsulation>) {
  static constexpr json::EnumName names[] = {
      name(Encapsulation::udp, "udp", "IPv4 and UDP headers, 28 octets, before the payload"),
      name(Encapsulation::ethernet, "ethernet", "the payload follows the EtherType"),
  };
  static constexpr json::Enumeration table = json::enumeration<Encapsulation>("an encapsulation", names);
  return table;
}

const json::Object& describe(json::Type<ExponentialGaps>) {
  static constexpr json::Field fields[] = {
      required<&ExponentialGaps::mean>("mean", "Mean gap between two frames.", {.min = 1_ns, .max = longest_mean_gap}),
  };
  static constexpr json::Object table =
      json::object<ExponentialGaps>("exponential_gaps", "Frames at random.", fields, {.shorthand = "mean"});
  return table;
}

const json::Object& describe(json::Type<NormalGaps>) {
  static constexpr json::Field fields[] = {
      required<&NormalGaps::mean>("mean", "Mean of the distribution before it is cut off.",
                                  {.min = 1_ns, .max = longest_mean_gap}),
      required<&NormalGaps::deviation>("deviation", "Its standard deviation.",
                                       {.min = Duration::from_ps(1), .max = longest_mean_gap}),
      optional<&NormalGaps::min>("min", "The least gap, at most the mean. More than 0s: the stream has a bound.",
                                 {.max = longest_mean_gap}),
      optional<&NormalGaps::max>("max", "The greatest gap, at least the mean; no limit if absent.",
                                 {.min = 1_ns, .max = longest_mean_gap}),
  };
  static constexpr json::Object table =
      json::object<NormalGaps>("normal_gaps",
                               "Frames at random: gaps of a truncated normal distribution. What lies outside of min "
                               "and max is left out, not moved to them.",
                               fields);
  return table;
}

const json::Object& describe(json::Type<Bursts>) {
  static constexpr json::Field fields[] = {
      required<&Bursts::frames>("frames", "Frames of a burst.", {.min = 1, .max = 1'000'000}),
      required<&Bursts::every>("every", "From burst to burst.", {.min = 1_ns, .max = longest_step}),
      optional<&Bursts::spacing>("spacing", "From frame to frame within a burst; 0s: all at once.",
                                 {.max = longest_step}),
  };
  static constexpr json::Object table = json::object<Bursts>("bursts", "Frames in bursts.", fields);
  return table;
}

namespace {

void decode_names(const json::Node& node, Names& value, json::Reader& reader) {
  value.names.clear();
  if (node.kind == json::Kind::string) {
    value.names.push_back(node.text);
    return;
  }
  if (node.kind != json::Kind::array || node.items.empty()) {
    reader.wrong_type(node, "the name of a host or an array of names");
    return;
  }
  for (const json::Node& item : node.items) {
    if (item.kind == json::Kind::string)
      value.names.push_back(item.text);
    else
      reader.wrong_type(item, "the name of a host");
  }
}

json::Node encode_names(const Names& value) {
  if (value.names.size() == 1) return json::Node::of_string(value.names.front());
  return json::encode_value(value.names);
}

json::Node schema_names(json::SchemaBuilder& builder) {
  json::Node any = json::Node::array();
  any.items.push_back(json::schema_value<std::string>(builder));
  any.items.push_back(json::schema_value<std::vector<std::string>>(builder, {.min_items = 1}));
  json::Node schema = json::Node::object();
  schema.add("anyOf", std::move(any));
  return schema;
}

}  // namespace

const json::Enumeration& describe(json::Type<Route>) {
  static constexpr json::EnumName names[] = {
      json::name(Route::automatic, "auto", "one that is searched for"),
  };
  static constexpr json::Enumeration table = json::enumeration<Route>("a route", names);
  return table;
}

const json::Custom& describe(json::Type<Names>) {
  static constexpr json::Custom table = json::custom<Names, decode_names, encode_names, schema_names>();
  return table;
}

const json::Object& describe(json::Type<Stream>) {
  static constexpr json::Field fields[] = {
      required<&Stream::name>("name", "Unique among streams and programs.", {.min_length = 1, .max_length = 200}),
      required<&Stream::from>("from", "The host that sends."),
      required<&Stream::to>("to", "The host that receives, or several (multicast)."),
      optional<&Stream::payload>(
          "payload",
          "Octets of user data in each frame; with all headers at most the \"mtu\" of each node on the path.",
          {.max = models::largest_msdu}),
      optional<&Stream::encapsulation>("encapsulation", "What stands before the payload."),
      optional<&Stream::pcp>("pcp", "Priority in a VLAN tag; untagged, priority 0, if absent.", {.max = 7}),
      optional<&Stream::host_priority>("host_priority",
                                       "Priority by which the sender's own interface queues untagged frames; they do "
                                       "not bear it, so that switches take them for priority 0.",
                                       {.max = 7}),
      optional<&Stream::vlan>("vlan", "VLAN identifier in the tag; 0 is a priority tag.", {.max = 4094}),
      optional<&Stream::every>("every", "Period.", {.min = 1_ns, .max = longest_step}),
      optional<&Stream::exponential>("exponential", "Random gaps with this mean."),
      optional<&Stream::normal>("normal", "Random gaps of a truncated normal distribution."),
      optional<&Stream::burst>("burst", "Bursts of frames."),
      optional<&Stream::trace>("trace",
                               "A CSV file with the columns time and payload (e.g. 12.5us,100B), beside the scenario."),
      optional<&Stream::offset>("offset",
                                "When the first period begins; 0 in a run if absent, and then any for the search for "
                                "the worst case. \"auto\": takt chooses one at which its frames meet no others.",
                                {.max = longest_step}),
      optional<&Stream::until>(
          "until", "When the stream ends: only frames that are due before are produced, by the clock of the sender.",
          {.min = 1_ns, .max = longest_step}),
      optional<&Stream::jitter>("jitter", "Each frame comes up to this much later, uniformly; at most the period.",
                                {.max = longest_step}),
      optional<&Stream::launch>("launch",
                                "Launch time of each frame, this long after it was due: the network interface sends it "
                                "then, or drops it if it comes later.",
                                {.max = longest_step}),
      optional<&Stream::path>(
          "path",
          "All nodes from sender to receiver, instead of the shortest path. \"sw1:2\" leaves sw1 by port 2, where "
          "several links lead to the next node; by the first of them without a port.",
          {.min_items = 2, .max_items = most_names}),
      optional<&Stream::route>("route",
                               "In place of a path: takt schedule searches for one and writes it. Until then, and for "
                               "all other commands, it is the shortest path."),
      optional<&Stream::redundancy>("redundancy",
                                    "Every frame takes several paths (IEEE 802.1CB): their number, or an object."),
  };
  static constexpr std::string_view schedules[] = {"every", "exponential", "normal", "burst", "trace"};
  static constexpr json::Group groups[] = {json::exactly_one_of(schedules)};
  static constexpr json::Object table =
      json::object<Stream>("stream", "Frames from one host to others, without a protocol.", fields, {.groups = groups});
  return table;
}

const json::Object& describe(json::Type<SetGates>) {
  static constexpr json::Field fields[] = {
      required<&SetGates::node>("node", "The node whose gates are set."),
      optional<&SetGates::to>("to",
                              "Only the port to this neighbour; \"sw2:1\": of several links to it the one to its port "
                              "1. All ports of the node if absent."),
      required<&SetGates::gates>("gates",
                                 "The new gates; they run from their base time on, as IEEE 802.1Q 8.6.9.3 says."),
  };
  static constexpr json::Object table = json::object<SetGates>("set_gates", "Another gate list at run time.", fields);
  return table;
}

const json::Object& describe(json::Type<ScriptEntry>) {
  static constexpr json::Field fields[] = {
      required<&ScriptEntry::at>("at", "When.", {.max = longest}),
      optional<&ScriptEntry::program>("program", "The program whose method is called."),
      optional<&ScriptEntry::call>("call", "The method."),
      optional<&ScriptEntry::on>("on", "The participant on which it is called; the master if absent."),
      optional<&ScriptEntry::join>("join", "A candidate of a program's roles that begins to announce itself."),
      optional<&ScriptEntry::leave>("leave", "A candidate that leaves; if it has a role, the group halts first."),
      optional<&ScriptEntry::set_gates>("set_gates", "Another gate list for ports."),
  };
  static constexpr std::string_view actions[] = {"call", "set_gates", "join", "leave"};
  static constexpr json::Group groups[] = {json::exactly_one_of(actions)};
  static constexpr json::Object table = json::object<ScriptEntry>(
      "script_entry", "Something that is done at a certain time.", fields, {.groups = groups});
  return table;
}

const json::Object& describe(json::Type<Scenario>) {
  static constexpr json::Field fields[] = {
      optional<&Scenario::schema>("$schema", "The JSON Schema, for editors."),
      required<&Scenario::name>("name", "The name of the scenario.", {.min_length = 1, .max_length = 200}),
      json::optional_prose<&Scenario::description>("description", "What it shows."),
      optional<&Scenario::seed>("seed", "The seed of all chance."),
      required<&Scenario::duration>("duration", "How long is simulated.", {.min = 1_ns, .max = longest}),
      optional<&Scenario::warm_up>("warm_up",
                                   "Requirements and figures count what begins at this instant or later; of a "
                                   "requirement with its own after, from that.",
                                   {.max = longest}),
      required<&Scenario::network>("network", "Nodes and links."),
      optional<&Scenario::clocks>("clocks", "The clocks of the nodes."),
      optional<&Scenario::programs>("programs", "Distributed OPC UA Programs.", {.max_items = 10'000}),
      optional<&Scenario::topics>("topics", "Data that applications publish and subscribe to.", {.max_items = 10'000}),
      optional<&Scenario::domains>("domains", "Domains of DDS; those that are not here have simple discovery.",
                                   {.max_items = 233}),
      optional<&Scenario::applications>("applications", "Applications with threads that publish and subscribe.",
                                        {.max_items = 10'000}),
      optional<&Scenario::gateways>("gateways", "Between topics of different protocols.", {.max_items = 10'000}),
      optional<&Scenario::persistence>("persistence", "Persistence services of DDS.", {.max_items = 100}),
      optional<&Scenario::streams>("streams", "Other traffic.", {.max_items = most_streams}),
      optional<&Scenario::script>("script", "What is done when.", {.max_items = most_names}),
      optional<&Scenario::faults>("faults", "What goes wrong.", {.max_items = most_names}),
      optional<&Scenario::rerouting>(
          "rerouting", "How long the switches take to forward around what is down; they do not if absent."),
      optional<&Scenario::gates>(
          "gates",
          "The gates of the whole network: \"auto\" lays them along the paths of what is published at known times."),
      optional<&Scenario::require>("require", "What must hold for the run to pass.", {.max_items = most_names}),
      optional<&Scenario::allow_overload>(
          "allow_overload", "A link that is asked for more than it can carry is an error unless this is true."),
  };
  static constexpr json::Object table =
      json::object<Scenario>("scenario", "A network, its Programs and its traffic, and what must hold.", fields);
  return table;
}

}  // namespace takt::scenario

namespace takt::handshake {

const json::Enumeration& describe(json::Type<Cause>) {
  using json::name;
  static constexpr json::EnumName names[] = {
      name(Cause::command, "command", "a method was called"),
      name(Cause::crash, "crash", "the node of a participant failed"),
      name(Cause::restart, "restart", "a node is back without its memory, before anybody found it silent"),
      name(Cause::cut, "cut", "a link or a switch between participants failed"),
      name(Cause::silence, "silence",
           "words of a peer stayed away, without a crash or a cut that explains it; from the last one that came"),
      name(Cause::leave, "leave", "a node with a role left"),
      name(Cause::mismatch, "mismatch", "a participant was told what it cannot follow"),
      name(Cause::nested, "nested", "the group around this one, or within it, did the same"),
  };
  static constexpr json::Enumeration table = json::enumeration<Cause>("the cause of a reaction", names);
  return table;
}

}  // namespace takt::handshake
