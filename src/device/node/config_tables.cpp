// SPDX-License-Identifier: Apache-2.0
// The words of node files, besides the plant (src/foundation/plant).
#include "node/config.hpp"

namespace takt::node {
namespace {

using json::name;
using json::optional;
using json::required;
using namespace sim::literals;  // NOLINT: units in limits

}  // namespace

const json::Enumeration& describe(json::Type<ClockName>) {
  static constexpr json::EnumName names[] = {
      name(ClockName::monotonic, "monotonic", "CLOCK_MONOTONIC; shared by nodes on one machine"),
      name(ClockName::tai, "tai", "CLOCK_TAI; shared by machines that gPTP synchronises")};
  static constexpr json::Enumeration table = json::enumeration<ClockName>("a clock", names);
  return table;
}

const json::Object& describe(json::Type<UdpTransport>) {
  static constexpr json::Field fields[] = {
      optional<&UdpTransport::interface>("interface", "For multicast; the kernel's choice if absent.",
                                         {.min_length = 1, .max_length = 15}),
      optional<&UdpTransport::port>("port", "Own port, and that of destinations without one.", {.min = 1}),
      required<&UdpTransport::destinations>(
          "destinations", "IPv4 addresses, each alone or as \"address:port\". Multicast ones are joined.",
          {.min_items = 1, .max_items = 128}),
      optional<&UdpTransport::pcp>("pcp", "SO_PRIORITY, and DSCP class selector.", {.max = 7}),
  };
  static constexpr json::Object table = json::object<UdpTransport>("udp", "UADP over UDP and IPv4.", fields);
  return table;
}

const json::Object& describe(json::Type<EthernetTransport>) {
  static constexpr json::Field fields[] = {
      required<&EthernetTransport::interface>("interface", "The network interface.",
                                              {.min_length = 1, .max_length = 15}),
      optional<&EthernetTransport::destination>("destination",
                                                "MAC address that all messages go to; a group address is joined."),
      optional<&EthernetTransport::vlan>("vlan", "VLAN; frames carry a tag with it, without it none.", {.max = 4094}),
      optional<&EthernetTransport::pcp>("pcp", "SO_PRIORITY, and the priority in the tag.", {.max = 7}),
  };
  static constexpr json::Object table =
      json::object<EthernetTransport>("ethernet", "UADP over Ethernet, EtherType 0xB62C.", fields);
  return table;
}

const json::Tagged& describe(json::Type<Transport>) {
  static constexpr auto kinds = json::options<Transport>({"udp", "ethernet"});
  static constexpr json::Tagged table = json::tagged<Transport>("transport", "How messages travel.", "kind", kinds);
  return table;
}

const json::Enumeration& describe(json::Type<Membership>) {
  static constexpr json::EnumName names[] = {
      name(Membership::join, "join", "it announces its skills from now on"),
      name(Membership::leave, "leave", "it asks to be let go, and is silent from then on")};
  static constexpr json::Enumeration table =
      json::enumeration<Membership>("what a node that offers its skills does", names);
  return table;
}

const json::Object& describe(json::Type<ScriptEntry>) {
  static constexpr json::Field fields[] = {
      required<&ScriptEntry::at>("at", "After the start of this node.", {.max = 3600_s}),
      optional<&ScriptEntry::call>("call", "The method that is called here."),
      optional<&ScriptEntry::membership>("plug", "This node joins or leaves."),
      optional<&ScriptEntry::program>(
          "program", "Of which program; the only one that is not nested in another of this node, if absent."),
  };
  static constexpr std::string_view members[] = {"call", "plug"};
  static constexpr json::Group groups[] = {json::exactly_one_of(members)};
  static constexpr json::Object table = json::object<ScriptEntry>(
      "script_entry", "A method call, or a node that joins or leaves.", fields, {.groups = groups});
  return table;
}

const json::Enumeration& describe(json::Type<SourceKind>) {
  static constexpr json::EnumName names[] = {
      name(SourceKind::counter, "counter", "value, value + step, ... from message to message"),
      name(SourceKind::constant, "constant", "value"),
      name(SourceKind::sine, "sine", "value + amplitude * sin(2 pi t / period)")};
  static constexpr json::Enumeration table = json::enumeration<SourceKind>("a kind of source", names);
  return table;
}

const json::Object& describe(json::Type<Source>) {
  static constexpr json::Field fields[] = {
      required<&Source::data_set>("data_set", "A data set that this node publishes."),
      optional<&Source::program>("program", "Of which program; needed where several have a data set of this name."),
      optional<&Source::field>("field", "Only this field; all fields if absent."),
      required<&Source::kind>("kind", "What the values do."),
      optional<&Source::value>("value", "The constant, the counter's first value, or what the sine goes around."),
      optional<&Source::step>("step", "Of a counter."),
      optional<&Source::amplitude>("amplitude", "Of a sine."),
      optional<&Source::period>("period", "Of a sine.", {.min = 1_us, .max = 3600_s}),
  };
  static constexpr json::Object table =
      json::object<Source>("source", "Where values of an own data set come from.", fields);
  return table;
}

const json::Object& describe(json::Type<Config>) {
  static constexpr json::Field fields[] = {
      required<&Config::node>("node", "Which participant this node is."),
      optional<&Config::program>("program", "The Program, the same at all nodes."),
      optional<&Config::programs>("programs",
                                  "Several Programs instead, nested or not. Those that the node is not in are passed "
                                  "over, so all nodes may have the same list.",
                                  {.min_items = 1, .max_items = 256}),
      optional<&Config::offers>("offers",
                                "Skills that this node offers to the program with roles of which it is a candidate.",
                                {.min_items = 1, .max_items = 8}),
      optional<&Config::absent>("absent",
                                "This candidate announces itself only when takt ctl or the script lets it join."),
      required<&Config::transport>("transport", "How its messages travel."),
      optional<&Config::clock>("clock", "The clock that the nodes share."),
      optional<&Config::duration>("duration", "How long it runs; until a signal if absent.",
                                  {.min = 1_ms, .max = 3600_s}),
      optional<&Config::realtime>("realtime",
                                  "Ask for SCHED_FIFO and locked memory; a warning where that is not permitted."),
      optional<&Config::launch_lead>("launch_lead",
                                     "Publish so long before the cycle's instant and let the kernel hold the message "
                                     "back until then (SO_TXTIME); a warning where it cannot.",
                                     {.min = 1_us, .max = 1_s}),
      optional<&Config::control>(
          "control",
          "Path of the control socket; \"\" for none. If absent, takt-NODE.sock where the user's run-time files are.",
          {.max_length = 107}),
      optional<&Config::security>("security",
                                  "Messages of its programs are signed, or signed and encrypted; neither if absent."),
      optional<&Config::sources>("sources", "Values of own data sets; fields without a source are 0.",
                                 {.max_items = 10'000}),
      optional<&Config::log_values_every>(
          "log_values_every", "Log values that are received, each data set at most so often; 0 is each message.",
          {.max = 3600_s}),
      optional<&Config::script>("script", "Methods that are called at this node.", {.max_items = 10'000}),
      optional<&Config::server>("server", "An OPC UA server (opc.tcp) in front of its Programs; none if absent."),
  };
  static constexpr std::string_view members[] = {"program", "programs"};
  static constexpr json::Group groups[] = {json::exactly_one_of(members)};
  static constexpr json::Object table = json::object<Config>(
      "node", "A participant of one or several Programs on this machine.", fields, {.groups = groups});
  return table;
}

}  // namespace takt::node
