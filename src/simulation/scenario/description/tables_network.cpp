// SPDX-License-Identifier: Apache-2.0
// The vocabulary of networks: nodes, ports, links, generators. See tables.cpp.
#include "models/egress/cyclic_schedule.hpp"
#include "models/ethernet/sizes.hpp"
#include "plant/limits.hpp"
#include "scenario/description/description.hpp"
#include "scenario/description/limits.hpp"

namespace takt::scenario {

using json::name;
using json::optional;
using json::required;
using plant::longest_step;
using plant::most_names;

const json::Enumeration& describe(json::Type<OsProfile>) {
  static constexpr json::EnumName names[] = {
      name(OsProfile::none, "none", "no delay at all"),
      name(OsProfile::preempt_rt, "preempt-rt", "x86 with PREEMPT_RT, real-time thread"),
      name(OsProfile::preempt_rt_isolated, "preempt-rt-isolated", "the same on an isolated core"),
      name(OsProfile::preempt_rt_arm, "preempt-rt-arm", "ARM with PREEMPT_RT"),
      name(OsProfile::general_purpose, "general-purpose", "a stock x86 kernel under load"),
      name(OsProfile::virtual_machine, "virtual-machine", "a guest on an ordinary host"),
      name(OsProfile::virtual_machine_rt, "virtual-machine-rt", "a guest with pinned processors on a real-time host"),
  };
  static constexpr json::Enumeration table = json::enumeration<OsProfile>("an operating system", names);
  return table;
}

const json::Object& describe(json::Type<Processing>) {
  static constexpr json::Field fields[] = {
      optional<&Processing::per_message>("per_message", "For each message."),
      optional<&Processing::per_field>("per_field", "Besides, for each value in it; drawn once for a message."),
  };
  static constexpr json::Object table = json::object<Processing>(
      "processing",
      "How long the application of a Program works at process data before it replies; one message after the other.",
      fields);
  return table;
}

const json::Object& describe(json::Type<OperatingSystem>) {
  static constexpr json::Field fields[] = {
      optional<&OperatingSystem::profile>("profile", "Where the delays come from that are not given here."),
      optional<&OperatingSystem::transmit>("transmit", "From the application's send to the network interface."),
      optional<&OperatingSystem::receive>(
          "receive", "From the last bit at the network interface to the application; a fixed one is at most 10 s."),
      optional<&OperatingSystem::wake_up>("wake_up", "From a timer's expiry to the application."),
  };
  static constexpr json::Object table =
      json::object<OperatingSystem>("operating_system", "The operating system of a host: a profile or single delays.",
                                    fields, {.shorthand = "profile"});
  return table;
}

const json::Enumeration& describe(json::Type<FullQueue>) {
  static constexpr json::EnumName names[] = {
      name(FullQueue::newest, "newest", "the frame that comes (tail drop)"),
      name(FullQueue::oldest, "oldest",
           "those at the head of the queue, until the one that comes has room; in a class that sends by eligibility "
           "times those with the earliest ones"),
  };
  static constexpr json::Enumeration table =
      json::enumeration<FullQueue>("which frame is lost when a queue is full", names);
  return table;
}

const json::Object& describe(json::Type<Queues::PerClass>) {
  static constexpr json::Field fields[] = {
      required<&Queues::PerClass::traffic_class>("class", "The traffic class, 7 is the most urgent.", {.max = 7}),
      optional<&Queues::PerClass::frames>("frames", "Most frames that wait.", {.min = 1}),
      optional<&Queues::PerClass::octets>("octets", "Most octets that wait, DA to FCS.", {.min = Octets{64}}),
      optional<&Queues::PerClass::drop>(
          "drop", "Which frame is lost when the queue is full; as in the other queues if absent."),
  };
  static constexpr json::Object table =
      json::object<Queues::PerClass>("queue_of_class", "The limits of one queue.", fields);
  return table;
}

const json::Object& describe(json::Type<Queues>) {
  static constexpr json::Field fields[] = {
      optional<&Queues::frames>("frames", "Most frames that wait in each queue; no limit if absent.", {.min = 1}),
      optional<&Queues::octets>("octets", "Most octets that wait in each queue, DA to FCS; no limit if absent.",
                                {.min = Octets{64}}),
      optional<&Queues::drop>("drop", "Which frame is lost when a queue is full."),
      optional<&Queues::classes>("classes", "Other limits for single traffic classes.", {.max_items = 8}),
  };
  static constexpr json::Object table = json::object<Queues>(
      "queues", "What the eight queues of a port hold. The frame that is being sent does not count.", fields);
  return table;
}

const json::Enumeration& describe(json::Type<MacOperation>) {
  static constexpr json::EnumName names[] = {
      name(MacOperation::none, "none", "the MAC goes on as it is (SetGateStates)"),
      name(MacOperation::hold, "hold",
           "preemptable frames are held from the beginning of the entry on (Set-And-Hold-MAC)"),
      name(MacOperation::release, "release", "they are no longer held (Set-And-Release-MAC)"),
  };
  static constexpr json::Enumeration table = json::enumeration<MacOperation>("what an entry asks of the MAC", names);
  return table;
}

const json::Object& describe(json::Type<GateEntry>) {
  static constexpr json::Field fields[] = {
      required<&GateEntry::open>("open", "The traffic classes whose gates are open.",
                                 {.max_items = 8, .unique = true, .items = {.max = 7}}),
      required<&GateEntry::interval>("for", "How long the entry lasts.", {.min = 1_ns, .max = 3600_s}),
      optional<&GateEntry::mac>("mac", "Whether preemptable frames are held; without preemption it means nothing."),
  };
  static constexpr json::Object table =
      json::object<GateEntry>("gate_entry", "One entry of a gate control list.", fields);
  return table;
}

const json::Object& describe(json::Type<Gates>) {
  static constexpr json::Field fields[] = {
      optional<&Gates::cycle>("cycle", "AdminCycleTime; the sum of the entries if absent.",
                              {.min = 1_ns, .max = 3600_s}),
      optional<&Gates::base_time>("base_time", "AdminBaseTime, when the first cycle begins; may lie in the past.",
                                  {.min = -(3600_s), .max = 3600_s}),
      optional<&Gates::running>("running",
                                "The list was set long before the start: if its base time lies in the past it is in "
                                "force from the start, somewhere in its cycle. Otherwise it begins with the first "
                                "cycle after the start, as one that is set then does."),
      optional<&Gates::extension>("extension",
                                  "AdminCycleTimeExtension: how much the last cycle before a change may be longer.",
                                  {.max = 3600_s}),
      required<&Gates::entries>("entries", "The gate control list.",
                                {.min_items = 1, .max_items = models::CyclicIntervals::entry_limit}),
  };
  static constexpr json::Object table =
      json::object<Gates>("gates", "Transmission gates (IEEE 802.1Q 8.6.8.4, Qbv).", fields);
  return table;
}

const json::Object& describe(json::Type<GateLimits>) {
  static constexpr json::Field fields[] = {
      optional<&GateLimits::entries>("entries", "Most entries of a list.",
                                     {.min = 2, .max = models::CyclicIntervals::entry_limit}),
      optional<&GateLimits::least_interval>("least_interval", "No entry is shorter; 1 ns if absent.",
                                            {.min = 1_ns, .max = 1_s}),
      optional<&GateLimits::granularity>("granularity", "Cycles and entries are multiples of it; 1 ns if absent.",
                                         {.min = 1_ns, .max = 1_s}),
      optional<&GateLimits::queues>("queues", "Most traffic classes that frames of one port are in; 8 if absent.",
                                    {.min = 1, .max = 8}),
  };
  static constexpr json::Object table = json::object<GateLimits>(
      "gate_limits",
      "What a device can do with gates. Automatic gates keep to it, other lists are refused if they do not.", fields);
  return table;
}

const json::Enumeration& describe(json::Type<SlopeOf>) {
  static constexpr json::EnumName names[] = {
      name(SlopeOf::cycle, "cycle", "over the whole gate cycle: credit grows faster while the gate is open"),
      name(SlopeOf::window, "window", "while the gate is open"),
  };
  static constexpr json::Enumeration table = json::enumeration<SlopeOf>("what an idle slope refers to", names);
  return table;
}

const json::Object& describe(json::Type<Shaper>) {
  static constexpr json::Field fields[] = {
      required<&Shaper::traffic_class>("class", "The traffic class.", {.max = 7}),
      required<&Shaper::idle_slope>("idle_slope",
                                    "Bandwidth of the class, preamble and gap counted; at most the link's rate.",
                                    {.min = DataRate{1}, .max = DataRate{100'000'000'000}}),
      optional<&Shaper::of>("of", "Whether that is the bandwidth of the whole gate cycle or of the open window."),
  };
  static constexpr json::Object table =
      json::object<Shaper>("shaper", "A credit-based shaper (IEEE 802.1Q 8.6.8.2, Qav).", fields);
  return table;
}

const json::Object& describe(json::Type<Share>) {
  static constexpr json::Field fields[] = {
      required<&Share::traffic_class>("class", "The traffic class.", {.max = 7}),
      required<&Share::bandwidth>("bandwidth", "Percent of the bandwidth that is shared; those of a port sum to 100.",
                                  {.min = 1, .max = 100}),
  };
  static constexpr json::Object table = json::object<Share>(
      "share", "The share of a class by enhanced transmission selection (IEEE 802.1Q 8.6.8.3).", fields);
  return table;
}

const json::Object& describe(json::Type<MaxSdu>) {
  static constexpr json::Field fields[] = {
      required<&MaxSdu::traffic_class>("class", "The traffic class.", {.max = 7}),
      required<&MaxSdu::size>("size", "Most octets after the EtherType; longer frames are dropped.",
                              {.min = Octets{1}, .max = models::largest_msdu}),
  };
  static constexpr json::Object table = json::object<MaxSdu>("max_sdu", "queueMaxSDU of a class.", fields);
  return table;
}

const json::Object& describe(json::Type<Preemption>) {
  static constexpr json::Field fields[] = {
      required<&Preemption::preemptable>("preemptable",
                                         "The traffic classes whose frames may be cut; the others are express.",
                                         {.min_items = 1, .max_items = 8, .unique = true, .items = {.max = 7}}),
      optional<&Preemption::add_frag_size>(
          "add_frag_size", "addFragSize: a fragment that is not the last has at least 64 * (1 + this) octets.",
          {.max = 3}),
      optional<&Preemption::hold_advance>(
          "hold_advance",
          "How long before an entry that holds the MAC is told; as long as an express frame waits at most if absent.",
          {.max = 1_s}),
      optional<&Preemption::release_advance>("release_advance",
                                             "How long before an entry that releases the MAC is told.", {.max = 1_s}),
  };
  static constexpr json::Object table = json::object<Preemption>(
      "preemption", "Frame preemption (IEEE 802.3 clause 99, IEEE 802.1Q 6.7.2, Qbu).", fields);
  return table;
}

const json::Object& describe(json::Type<Egress>) {
  static constexpr json::Field fields[] = {
      optional<&Egress::to>("to",
                            "Only the port to this neighbour; \"sw2:1\": of several links to it the one to its port 1. "
                            "All ports of the node if absent."),
      optional<&Egress::gates>("gates", "Transmission gates."),
      optional<&Egress::shapers>("shapers", "Credit-based shapers.", {.max_items = 8}),
      optional<&Egress::max_sdu>("max_sdu", "Longest SDU of single classes.", {.max_items = 8}),
      optional<&Egress::ats>("ats", "The traffic classes that send by the eligibility times of ATS schedulers (Qcr).",
                             {.max_items = 8, .unique = true, .items = {.max = 7}}),
      optional<&Egress::ets>("ets",
                             "Enhanced transmission selection (Qaz): these traffic classes share, in proportion to "
                             "their percentages, what all others leave, whatever their numbers. A class that has "
                             "nothing to send leaves its share to the others.",
                             {.max_items = 8}),
      optional<&Egress::preemption>("preemption", "Which frames may be cut for others."),
      optional<&Egress::cut_through>("cut_through",
                                     "The traffic classes whose frames begin to leave before they have wholly come, "
                                     "where the port is free and the link they come from as fast.",
                                     {.max_items = 8, .unique = true, .items = {.max = 7}}),
      optional<&Egress::untagged>("untagged", "Frames leave without their VLAN tag; for ports to hosts."),
  };
  static constexpr json::Object table = json::object<Egress>("egress", "What ports do beyond strict priority.", fields);
  return table;
}

namespace {

// The fields of the parts of a node, wherever they are.
template <class Owner>
constexpr json::Field os_field =
    optional<&EndStation::os, Owner>("os", "The operating system: a profile's name or an object.");
template <class Owner>
constexpr json::Field processing_field =
    optional<&EndStation::processing, Owner>("processing", "How long Programs work at process data before they reply.");
template <class Owner>
constexpr json::Field cryptography_field = optional<&EndStation::cryptography, Owner>(
    "cryptography", "How long it takes to secure messages of programs; no time if absent.");
template <class Owner>
constexpr json::Field ats_field = optional<&EndStation::ats, Owner>(
    "ats", "ATS schedulers of streams that the node itself sends.", {.max_items = 4096});
template <class Owner>
constexpr json::Field offers_field = optional<&EndStation::offers, Owner>(
    "offers", "Skills that the node announces to programs with roles that need one of them.", {.max_items = 8});
template <class Owner>
constexpr json::Field cpu_field = optional<&EndStation::cpu, Owner>(
    "cpu", "Its processor: threads that take time and delay each other. Nothing takes time if absent.");
template <class Owner>
constexpr json::Field traffic_classes_field = optional<&NodePorts::traffic_classes, Owner>(
    "traffic_classes",
    "Which priority is sent in which queue, or how many queues there are: fewer than 8 by the column of IEEE 802.1Q "
    "Table 8-5; with 1 no priority is looked at.");
template <class Owner>
constexpr json::Field gate_limits_field = optional<&NodePorts::gate_limits, Owner>("gate_limits",
                                                                                   "What its gates can do.");
template <class Owner>
constexpr json::Field device_field = optional<&NodePorts::device, Owner>(
    "device",
    "A file with the type of the node, relative to this one. What the node says itself wins over it; what it asks of "
    "the device that this has not is an error.",
    {.min_length = 1, .max_length = 4096});
template <class Owner>
constexpr json::Field no_gates_field = optional<&NodePorts::gates, Owner>("gates",
                                                                          "Its ports have no transmission gates.");
template <class Owner>
constexpr json::Field mtu_field =
    optional<&NodePorts::mtu, Owner>("mtu",
                                     "Most octets after the EtherType of a frame that its ports pass, tags not "
                                     "counted: more than 1500 are jumbo frames. As the network says if absent.",
                                     {.min = models::maximum_msdu, .max = models::largest_msdu});
template <class Owner>
constexpr json::Field forwarding_delay_field = optional<&Relay::forwarding_delay, Owner>(
    "forwarding_delay", "From the last bit in (cut through: the header) to the egress queue.", {.max = 1_s});
template <class Owner>
constexpr json::Field forwarding_jitter_field = optional<&Relay::forwarding_jitter, Owner>(
    "forwarding_jitter",
    "A random time besides, of at most 1 s, drawn for each frame. Frames that come in by one port do not overtake each "
    "other: one that has drawn less waits for those before it.");
template <class Owner>
constexpr json::Field cut_through_header_field = optional<&Relay::cut_through_header, Owner>(
    "cut_through_header",
    "What must be in of an untagged frame before it is cut through, preamble included; tags add to it.",
    {.min = Octets{14}, .max = Octets{72}});
template <class Owner>
constexpr json::Field ingress_field = optional<&Relay::ingress, Owner>("ingress",
                                                                       "Policing, ATS and CQF of frames that come in.");

}  // namespace

const json::Enumeration& describe(json::Type<NoGates>) {
  static constexpr json::EnumName names[] = {
      name(NoGates::none, "none",
           "lists of gates are refused, and scheduled streams of automatic gates may not pass it"),
  };
  static constexpr json::Enumeration table = json::enumeration<NoGates>("what a node has instead of gates", names);
  return table;
}

const json::Object& describe(json::Type<HostNode>) {
  static constexpr json::Field fields[] = {
      device_field<HostNode>,
      os_field<HostNode>,
      traffic_classes_field<HostNode>,
      optional<&NodePorts::queues, HostNode>("queues", "The queues of each network interface."),
      optional<&NodePorts::egress, HostNode>("egress", "Gates and shapers of the network interfaces.",
                                             {.max_items = 16}),
      gate_limits_field<HostNode>,
      no_gates_field<HostNode>,
      mtu_field<HostNode>,
      processing_field<HostNode>,
      cryptography_field<HostNode>,
      offers_field<HostNode>,
      cpu_field<HostNode>,
      ats_field<HostNode>,
  };
  static constexpr json::Object table = json::object<HostNode>("host", "An end station.", fields);
  return table;
}

const json::Object& describe(json::Type<SwitchNode>) {
  static constexpr json::Field fields[] = {
      device_field<SwitchNode>,
      forwarding_delay_field<SwitchNode>,
      forwarding_jitter_field<SwitchNode>,
      cut_through_header_field<SwitchNode>,
      traffic_classes_field<SwitchNode>,
      optional<&NodePorts::queues, SwitchNode>("queues", "The queues of each port."),
      optional<&NodePorts::egress, SwitchNode>(
          "egress", "Gates and shapers of ports; an entry for a neighbour takes the place of one for all.",
          {.max_items = 4096}),
      gate_limits_field<SwitchNode>,
      no_gates_field<SwitchNode>,
      mtu_field<SwitchNode>,
      ingress_field<SwitchNode>,
  };
  static constexpr json::Object table =
      json::object<SwitchNode>("switch", "A bridge: stores and forwards, or cuts through.", fields);
  return table;
}

const json::Object& describe(json::Type<StationNode>) {
  static constexpr json::Field fields[] = {
      device_field<StationNode>,
      os_field<StationNode>,
      forwarding_delay_field<StationNode>,
      forwarding_jitter_field<StationNode>,
      cut_through_header_field<StationNode>,
      traffic_classes_field<StationNode>,
      optional<&NodePorts::queues, StationNode>("queues", "The queues of each port."),
      optional<&NodePorts::egress, StationNode>(
          "egress", "Gates and shapers of ports; an entry for a neighbour takes the place of one for all.",
          {.max_items = 16}),
      gate_limits_field<StationNode>,
      no_gates_field<StationNode>,
      mtu_field<StationNode>,
      ingress_field<StationNode>,
      optional<&StationNode::bypass>("bypass", "A relay joins the cables at ports 0 and 1 while the station is down."),
      optional<&StationNode::bypass_switching>(
          "bypass_switching",
          "How long the relay takes, after the crash and when the station is back; all is dark meanwhile.",
          {.min = 1_us, .max = 10_s}),
      processing_field<StationNode>,
      cryptography_field<StationNode>,
      offers_field<StationNode>,
      cpu_field<StationNode>,
      ats_field<StationNode>,
  };
  static constexpr json::Object table =
      json::object<StationNode>("station",
                                "A bridged end station: a host whose interface is a bridge of up to eight ports, with "
                                "one clock and one power supply. What it sends itself competes with what it forwards.",
                                fields);
  return table;
}

const json::Tagged& describe(json::Type<Node>) {
  static constexpr auto kinds = json::options<Node>({"host", "switch", "station"});
  static constexpr json::Tagged table =
      json::tagged<Node>("node", "A host, a switch, or a station that is both.", "kind", kinds);
  return table;
}

const json::Object& describe(json::Type<Link>) {
  static constexpr json::Field fields[] = {
      required<&Link::ends>("ends", "The two nodes that it joins: \"sw1\" takes the next free port, \"sw1:3\" port 3.",
                            {.min_items = 2, .max_items = 2}),
      optional<&Link::rate>("rate", "Bits a second in each direction.",
                            {.min = DataRate{10'000'000}, .max = DataRate{100'000'000'000}}),
      optional<&Link::length>("length", "Length of the cable at 5 ns/m; 10 m if neither length nor delay is given.",
                              {.max = Length{100'000'000}}),
      optional<&Link::delay>("delay", "Propagation delay, instead of a length.", {.max = 1_s}),
      optional<&Link::medium>("medium", "What it is made of; its rate follows. Delays of devices may depend on it."),
  };
  static constexpr std::string_view either[] = {"length", "delay"};
  static constexpr json::Group groups[] = {json::at_most_one_of(either)};
  static constexpr json::Object table = json::object<Link>("link", "A full-duplex cable.", fields, {.groups = groups});
  return table;
}

const json::Enumeration& describe(json::Type<Shape>) {
  static constexpr json::EnumName names[] = {
      name(Shape::line, "line", "switches in a row"),
      name(Shape::ring, "ring", "switches in a circle"),
      name(Shape::star, "star", "a central switch, the others around it"),
      name(Shape::tree, "tree", "depth levels of switches below a root, fanout below each; hosts at the leaves"),
      name(Shape::mesh, "mesh", "rows x columns as a grid, or every switch joined to every other"),
      name(Shape::comb, "comb", "a line of switches, from each of which hangs a line of \"teeth\" more"),
      name(Shape::random, "random", "a random connected graph with this mean degree and no double links"),
      name(Shape::dual_star, "dual-star",
           "two cores, each joined to every other switch: two paths without a common switch, for redundant streams"),
  };
  static constexpr json::Enumeration table = json::enumeration<Shape>("a topology", names);
  return table;
}

const json::Object& describe(json::Type<Generator>) {
  static constexpr std::uint64_t most = 1'000'000'000'000;  // so that too many nodes are refused with their number
  static constexpr json::Field fields[] = {
      required<&Generator::shape>("topology", "The shape."),
      optional<&Generator::switches>("switches",
                                     "Number of switches (line, ring, star, full mesh, random; comb: of the spine; "
                                     "dual-star: besides the two cores).",
                                     {.min = 1, .max = most}),
      optional<&Generator::depth>("depth", "Levels of switches below the root (tree).", {.min = 0, .max = 64}),
      optional<&Generator::fanout>("fanout", "Switches below each switch (tree).", {.min = 1, .max = most}),
      optional<&Generator::rows>("rows", "Rows of the grid (mesh).", {.min = 1, .max = most}),
      optional<&Generator::columns>("columns", "Columns of the grid (mesh).", {.min = 1, .max = most}),
      optional<&Generator::teeth>("teeth", "Switches of each tooth (comb).", {.max = most}),
      optional<&Generator::degree>("degree", "Mean number of links of a switch to others (random).",
                                   {.min = 1.0, .max = 1000.0}),
      optional<&Generator::seed>("seed", "The seed of the graph (random); 1 if absent."),
      optional<&Generator::stations>("stations",
                                     "Instead of switches and hosts: so many bridged end stations (line, ring).",
                                     {.min = 1, .max = most}),
      optional<&Generator::hosts_per_switch>(
          "hosts_per_switch", "Hosts at each switch (tree: at each leaf; star and dual-star: not at the cores).",
          {.max = most}),
      optional<&Generator::switch_prefix>("switch_prefix", "Switches are named by it and a number from 1.",
                                          {.min_length = 1, .max_length = 64}),
      optional<&Generator::host_prefix>("host_prefix", "Hosts are named by it and a number from 1.",
                                        {.min_length = 1, .max_length = 64}),
      optional<&Generator::station_prefix>("station_prefix", "Stations are named by it and a number from 1.",
                                           {.min_length = 1, .max_length = 64}),
      optional<&Generator::rate>("rate", "Rate of the links.",
                                 {.min = DataRate{10'000'000}, .max = DataRate{100'000'000'000}}),
      optional<&Generator::host_rate>("host_rate", "Rate of the links to hosts, if it differs.",
                                      {.min = DataRate{10'000'000}, .max = DataRate{100'000'000'000}}),
      optional<&Generator::length>("length", "Length of each link.", {.max = Length{100'000'000}}),
      optional<&Generator::forwarding_delay>("forwarding_delay", "Of the switches or stations.", {.max = 1_s}),
      optional<&Generator::forwarding_jitter>(
          "forwarding_jitter", "Of the switches or stations: a random time besides, drawn for each frame."),
      optional<&Generator::os>("os", "Of the hosts or stations."),
      optional<&Generator::queues>("queues", "Of all ports."),
      optional<&Generator::traffic_classes>("traffic_classes", "Of all ports."),
      optional<&Generator::egress>("egress", "Gates and shapers of all ports of the switches or stations.",
                                   {.max_items = 1}),
      optional<&Generator::gate_limits>("gate_limits", "What the gates of the switches or stations can do."),
      optional<&Generator::host_gate_limits>("host_gate_limits", "What the gates of the hosts can do."),
      optional<&Generator::mtu>("mtu", "Of all its nodes, as that of a node.",
                                {.min = models::maximum_msdu, .max = models::largest_msdu}),
      optional<&Generator::gates>("gates", "The ports of the switches or stations have no transmission gates."),
      optional<&Generator::device>("device", "A file with the type of the switches or stations, as that of a node.",
                                   {.min_length = 1, .max_length = 4096}),
      optional<&Generator::ingress>("ingress", "Policing, ATS and CQF of the switches or stations."),
  };
  static constexpr json::Object table = json::object<Generator>("generator", "A whole topology.", fields);
  return table;
}

const json::Object& describe(json::Type<NetworkSection>) {
  static constexpr json::Field fields[] = {
      optional<&NetworkSection::nodes>("nodes", "Hosts, switches and stations by name.", {.max_items = most_nodes}),
      optional<&NetworkSection::links>("links", "The cables between them.", {.max_items = most_links}),
      optional<&NetworkSection::generate>("generate", "Generated topologies; nodes and links may add to them.",
                                          {.max_items = 64}),
      optional<&NetworkSection::mtu>("mtu", "Of nodes that do not say it themselves.",
                                     {.min = models::maximum_msdu, .max = models::largest_msdu}),
  };
  static constexpr json::Object table = json::object<NetworkSection>("network", "The network.", fields);
  return table;
}

}  // namespace takt::scenario
