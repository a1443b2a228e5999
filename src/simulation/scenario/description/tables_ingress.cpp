// SPDX-License-Identifier: Apache-2.0
// The vocabulary of what comes in: identification, policing, shaping by ATS, CQF, and redundant streams. See
// tables.cpp.
#include "models/egress/cyclic_schedule.hpp"
#include "models/ethernet/sizes.hpp"
#include "scenario/description/ingress.hpp"

namespace takt::scenario {
namespace {

using json::name;
using json::optional;
using json::required;
using namespace sim::literals;  // NOLINT: units in limits

constexpr std::size_t most_entries = 4'096;
constexpr Duration longest_interval = 3600_s;
constexpr DataRate highest_rate{1'000'000'000'000};

}  // namespace

const json::Enumeration& describe(json::Type<TaggedFrames>) {
  static constexpr json::EnumName names[] = {
      name(TaggedFrames::tagged, "tagged", "with a VLAN tag whose identifier is not 0"),
      name(TaggedFrames::priority, "priority", "untagged, or with VLAN identifier 0"),
      name(TaggedFrames::all, "all", "either"),
  };
  static constexpr json::Enumeration table = json::enumeration<TaggedFrames>("a kind of frames", names);
  return table;
}

const json::Object& describe(json::Type<NullIdentity>) {
  static constexpr json::Field fields[] = {
      optional<&NullIdentity::destination>("destination", "Frames to the address of this host."),
      optional<&NullIdentity::stream>("stream", "Frames to the address of this stream."),
      optional<&NullIdentity::vlan>("vlan", "Only in this VLAN; 0: in any.", {.max = 4094}),
      optional<&NullIdentity::tagged>("tagged", "Which frames are looked at."),
  };
  static constexpr std::string_view either[] = {"destination", "stream"};
  static constexpr json::Group groups[] = {json::exactly_one_of(either)};
  static constexpr json::Object table = json::object<NullIdentity>(
      "null_identification", "Null stream identification (IEEE 802.1CB 6.4): destination address and VLAN.", fields,
      {.groups = groups});
  return table;
}

const json::Object& describe(json::Type<SourceIdentity>) {
  static constexpr json::Field fields[] = {
      required<&SourceIdentity::source>("source", "Frames from the address of this host."),
      optional<&SourceIdentity::vlan>("vlan", "Only in this VLAN; 0: in any.", {.max = 4094}),
      optional<&SourceIdentity::tagged>("tagged", "Which frames are looked at."),
  };
  static constexpr json::Object table = json::object<SourceIdentity>(
      "source_identification", "Source MAC and VLAN stream identification (IEEE 802.1CB 6.5).", fields,
      {.shorthand = "source"});
  return table;
}

const json::Object& describe(json::Type<MaskIdentity>) {
  static constexpr json::Field fields[] = {
      optional<&MaskIdentity::destination>("destination", "What the masked destination address must be.",
                                           {.min_length = 17, .max_length = 17}),
      optional<&MaskIdentity::destination_mask>("destination_mask", "The bits of it that count.",
                                                {.min_length = 17, .max_length = 17}),
      optional<&MaskIdentity::source>("source", "What the masked source address must be.",
                                      {.min_length = 17, .max_length = 17}),
      optional<&MaskIdentity::source_mask>("source_mask", "The bits of it that count.",
                                           {.min_length = 17, .max_length = 17}),
  };
  static constexpr json::Object table =
      json::object<MaskIdentity>("mask_identification",
                                 "Mask-and-match stream identification (IEEE 802.1CBdb) of addresses: 02-00-5E and the "
                                 "index for nodes, 03-00-5E for groups.",
                                 fields);
  return table;
}

const json::Object& describe(json::Type<IdentifiedStream>) {
  static constexpr json::Field fields[] = {
      required<&IdentifiedStream::name>("name", "What filters call it; unique in the switch.",
                                        {.min_length = 1, .max_length = 200}),
      optional<&IdentifiedStream::null>("null", "By destination address and VLAN."),
      optional<&IdentifiedStream::source>("source", "By source address and VLAN."),
      optional<&IdentifiedStream::mask>("mask", "By some bits of the addresses."),
  };
  static constexpr std::string_view kinds[] = {"null", "source", "mask"};
  static constexpr json::Group groups[] = {json::exactly_one_of(kinds)};
  static constexpr json::Object table = json::object<IdentifiedStream>(
      "identified_stream", "An entry of the stream identity table; the first that matches names the stream.", fields,
      {.groups = groups});
  return table;
}

const json::Object& describe(json::Type<StreamFilterEntry>) {
  static constexpr json::Field fields[] = {
      optional<&StreamFilterEntry::stream>("stream",
                                           "Frames of this stream: a name under \"streams\" of this ingress, or a "
                                           "stream of the scenario (null identification). Any frame if absent."),
      optional<&StreamFilterEntry::pcp>("pcp", "Frames of this priority; any if absent. Untagged frames have 0.",
                                        {.max = 7}),
      optional<&StreamFilterEntry::max_sdu>("max_sdu", "Most octets after the EtherType; longer frames are dropped.",
                                            {.min = Octets{1}, .max = models::largest_msdu + models::r_tag}),
      optional<&StreamFilterEntry::block_oversize>(
          "block_oversize", "After one frame that is too long drop all (StreamBlockedDueToOversizeFrame)."),
      optional<&StreamFilterEntry::gate>("gate",
                                         "The stream gate that frames pass; \"cqf\" is the one that CQF makes."),
      optional<&StreamFilterEntry::meter>("meter", "The flow meter that frames pass."),
      optional<&StreamFilterEntry::ats>("ats", "The ATS scheduler that gives frames their eligibility time."),
  };
  static constexpr json::Object table = json::object<StreamFilterEntry>(
      "stream_filter", "A stream filter (IEEE 802.1Q 8.6.5.3); the first that matches a frame is the frame's.", fields);
  return table;
}

const json::Object& describe(json::Type<StreamGateStep>) {
  static constexpr json::Field fields[] = {
      required<&StreamGateStep::open>("open", "Whether frames pass; they are dropped otherwise."),
      optional<&StreamGateStep::ipv>(
          "ipv", "Internal priority value: decides about the queue instead of the frame's priority.", {.max = 7}),
      required<&StreamGateStep::interval>("for", "How long the entry lasts.", {.min = 1_ns, .max = longest_interval}),
      optional<&StreamGateStep::octets>(
          "octets", "Most octets (after the EtherType) that pass while it lasts (IntervalOctetMax)."),
  };
  static constexpr json::Object table =
      json::object<StreamGateStep>("stream_gate_entry", "One entry of a stream gate's control list.", fields);
  return table;
}

const json::Object& describe(json::Type<StreamGateEntryList>) {
  static constexpr json::Field fields[] = {
      required<&StreamGateEntryList::name>("name", "Unique in the switch.", {.min_length = 1, .max_length = 200}),
      optional<&StreamGateEntryList::open>("open",
                                           "AdminGateStates: its state without a list, or before the list runs."),
      optional<&StreamGateEntryList::ipv>("ipv", "AdminIPV: the internal priority value then.", {.max = 7}),
      optional<&StreamGateEntryList::cycle>("cycle", "AdminCycleTime; the sum of the entries if absent.",
                                            {.min = 1_ns, .max = longest_interval}),
      optional<&StreamGateEntryList::base_time>("base_time",
                                                "AdminBaseTime, when the first cycle begins; may lie in the past.",
                                                {.min = -(longest_interval), .max = longest_interval}),
      optional<&StreamGateEntryList::running>(
          "running",
          "The list was set long before the start: if its base time lies in the past it is in force from the start, "
          "somewhere in its cycle. Otherwise it begins with the first cycle after the start, as one that is set then "
          "does."),
      optional<&StreamGateEntryList::extension>(
          "extension", "AdminCycleTimeExtension: how much the last cycle before a change may be longer.",
          {.max = longest_interval}),
      optional<&StreamGateEntryList::entries>("entries", "The control list; without one the gate stays as it is.",
                                              {.max_items = models::CyclicIntervals::entry_limit}),
      optional<&StreamGateEntryList::block_invalid_rx>(
          "block_invalid_rx", "A frame that comes while it is closed closes it for good (GateClosedDueToInvalidRx)."),
      optional<&StreamGateEntryList::block_octets_exceeded>(
          "block_octets_exceeded",
          "A frame beyond the octets of an entry closes it for good (GateClosedDueToOctetsExceeded)."),
  };
  static constexpr json::Object table = json::object<StreamGateEntryList>(
      "stream_gate", "A stream gate (IEEE 802.1Q 8.6.5.4). It sees a frame when its last bit is in.", fields);
  return table;
}

const json::Object& describe(json::Type<Meter>) {
  static constexpr json::Field fields[] = {
      required<&Meter::name>("name", "Unique in the switch.", {.min_length = 1, .max_length = 200}),
      required<&Meter::cir>("cir", "Committed information rate, frames counted from DA to FCS.", {.max = highest_rate}),
      required<&Meter::cbs>("cbs", "Committed burst size."),
      optional<&Meter::eir>("eir", "Excess information rate.", {.max = highest_rate}),
      optional<&Meter::ebs>("ebs", "Excess burst size."),
      optional<&Meter::coupling>("coupling", "Committed tokens that overflow fill the excess bucket."),
      optional<&Meter::color_aware>("color_aware", "A frame that comes drop eligible is yellow at best."),
      optional<&Meter::drop_on_yellow>("drop_on_yellow", "Drop yellow frames instead of marking them drop eligible."),
      optional<&Meter::block_red>("block_red", "After one frame that is dropped drop all (MarkAllFramesRed)."),
  };
  static constexpr json::Object table = json::object<Meter>(
      "flow_meter", "A flow meter (IEEE 802.1Q 8.6.5.5, MEF 10.3): two rates, three colours.", fields);
  return table;
}

const json::Enumeration& describe(json::Type<LengthOf>) {
  static constexpr json::EnumName names[] = {
      name(LengthOf::wire, "wire", "with preamble and inter-packet gap, 20 octets more than the frame"),
      name(LengthOf::frame, "frame", "from destination address to FCS"),
  };
  static constexpr json::Enumeration table = json::enumeration<LengthOf>("what counts as length", names);
  return table;
}

const json::Object& describe(json::Type<AtsEntry>) {
  static constexpr json::Field fields[] = {
      required<&AtsEntry::name>("name", "Unique in the switch.", {.min_length = 1, .max_length = 200}),
      required<&AtsEntry::rate>("rate", "Committed information rate.", {.min = DataRate{1}, .max = highest_rate}),
      required<&AtsEntry::burst>("burst", "Committed burst size, at least the longest frame.", {.min = Octets{1}}),
      optional<&AtsEntry::length>("length", "What rate and burst count."),
      optional<&AtsEntry::group>(
          "group", "A group under \"ats_groups\"; that of the reception port and traffic class if absent."),
  };
  static constexpr json::Object table =
      json::object<AtsEntry>("ats_scheduler",
                             "A scheduler of asynchronous traffic shaping (IEEE 802.1Q 8.6.5.6, Qcr). Ports hold its "
                             "frames in classes with ATS.",
                             fields);
  return table;
}

const json::Object& describe(json::Type<TalkerAts>) {
  static constexpr json::Field fields[] = {
      required<&TalkerAts::stream>("stream",
                                   "A stream that the node sends; its class is one of \"ats\" in \"egress\"."),
      required<&TalkerAts::rate>("rate", "Committed information rate.", {.min = DataRate{1}, .max = highest_rate}),
      required<&TalkerAts::burst>("burst", "Committed burst size, at least the longest frame.", {.min = Octets{1}}),
      optional<&TalkerAts::length>("length", "What rate and burst count."),
  };
  static constexpr json::Object table = json::object<TalkerAts>(
      "talker_ats",
      "An ATS scheduler of a stream at its talker (IEEE 802.1Q 8.6.5.6 in an end station), alone in its group.",
      fields);
  return table;
}

const json::Object& describe(json::Type<AtsGroupEntry>) {
  static constexpr json::Field fields[] = {
      required<&AtsGroupEntry::name>("name", "Unique in the switch.", {.min_length = 1, .max_length = 200}),
      optional<&AtsGroupEntry::max_residence_time>(
          "max_residence_time", "Frames that would be held longer are dropped; that of the ingress if absent.",
          {.min = 1_ns, .max = longest_interval}),
  };
  static constexpr json::Object table =
      json::object<AtsGroupEntry>("ats_group", "ATS schedulers whose frames stay in order.", fields);
  return table;
}

const json::Object& describe(json::Type<Cqf>) {
  static constexpr json::Field fields[] = {
      required<&Cqf::cycle>("cycle",
                            "What is received in one cycle is sent in the next (with k buffers k-1 cycles later).",
                            {.min = 1_us, .max = 1_s}),
      required<&Cqf::classes>("classes", "The traffic classes whose queues are the buffers, one for each.",
                              {.min_items = 2, .max_items = 7, .unique = true, .items = {.max = 7}}),
      optional<&Cqf::buffers>("buffers", "The number of buffers; must be that of the classes.", {.min = 2, .max = 7}),
      optional<&Cqf::pcp>("pcp", "The priorities of the frames; those of the classes if absent.",
                          {.max_items = 8, .unique = true, .items = {.max = 7}}),
      optional<&Cqf::base_time>("base_time", "When the first cycle begins; the same in all switches.",
                                {.min = -(longest_interval), .max = longest_interval}),
      optional<&Cqf::dead_time>("dead_time",
                                "How long before the end of a cycle sending stops. If absent: with two buffers the "
                                "longest cable's delay and 1 ns, else none.",
                                {.max = 1_s}),
      optional<&Cqf::offset>("offset",
                             "How much later than sending, receiving goes to the next buffer; with three buffers and "
                             "more. The longest cable's delay and 1 ns if absent.",
                             {.max = 1_s}),
  };
  static constexpr json::Object table = json::object<Cqf>("cqf",
                                                          "Cyclic queuing and forwarding (IEEE 802.1Q Annex T, Qch): "
                                                          "becomes a stream gate and the gate lists of all ports.",
                                                          fields);
  return table;
}

const json::Object& describe(json::Type<Ingress>) {
  static constexpr json::Field fields[] = {
      optional<&Ingress::streams>("streams", "Streams that are not those of the scenario.",
                                  {.max_items = most_entries}),
      optional<&Ingress::filters>("filters", "Stream filters.", {.max_items = most_entries}),
      optional<&Ingress::gates>("gates", "Stream gates.", {.max_items = most_entries}),
      optional<&Ingress::meters>("meters", "Flow meters.", {.max_items = most_entries}),
      optional<&Ingress::ats>("ats", "ATS schedulers.", {.max_items = most_entries}),
      optional<&Ingress::ats_groups>("ats_groups", "Groups of ATS schedulers.", {.max_items = most_entries}),
      optional<&Ingress::max_residence_time>(
          "max_residence_time", "Frames that an ATS scheduler would hold longer are dropped; no limit if absent.",
          {.min = 1_ns, .max = longest_interval}),
      optional<&Ingress::cqf>("cqf", "Cyclic queuing and forwarding."),
  };
  static constexpr json::Object table =
      json::object<Ingress>("ingress",
                            "What a switch does to frames that come in: identification, filtering, policing, shaping "
                            "(IEEE 802.1Q 8.6.5, Qci).",
                            fields);
  return table;
}

const json::Enumeration& describe(json::Type<Recovery>) {
  static constexpr json::EnumName names[] = {
      name(Recovery::vector, "vector", "remembers the last numbers"),
      name(Recovery::match, "match", "remembers one number, for streams with one frame in flight"),
  };
  static constexpr json::Enumeration table = json::enumeration<Recovery>("a recovery algorithm", names);
  return table;
}

const json::Object& describe(json::Type<LatentErrors>) {
  static constexpr json::Field fields[] = {
      optional<&LatentErrors::difference>(
          "difference", "The greatest number of copies that may be missing (or too many) without an error."),
      optional<&LatentErrors::period>("period", "Between two tests.", {.min = 1_ms, .max = longest_interval}),
      optional<&LatentErrors::reset_period>("reset_period", "After which what is missing is forgiven.",
                                            {.min = 1_ms, .max = longest_interval}),
  };
  static constexpr json::Object table = json::object<LatentErrors>(
      "latent_errors", "Latent error detection (IEEE 802.1CB 7.4.4): do as many copies come as there are paths?",
      fields);
  return table;
}

const json::Object& describe(json::Type<Redundancy>) {
  static constexpr json::Field fields[] = {
      optional<&Redundancy::count>("count",
                                   "So many disjoint paths are looked for: they share no switch between the first and "
                                   "the last one, or at least no link. 2 if neither this nor paths is given.",
                                   {.min = 2, .max = 8}),
      optional<&Redundancy::paths>("paths",
                                   "The paths, each with all nodes from sender to receiver; \"sw1:2\" leaves sw1 by "
                                   "port 2, where several links lead to the next node.",
                                   {.min_items = 2, .max_items = 8}),
      optional<&Redundancy::vlans>("vlans",
                                   "The VLAN of each path, for tagged streams; that of the stream if absent. Each path "
                                   "has a group address of its own anyway.",
                                   {.max_items = 8, .items = {.max = 4094}}),
      optional<&Redundancy::ladder>(
          "ladder",
          "Of paths that meet and part again: wherever they meet copies are taken out, and wherever they part each "
          "frame is copied anew, so that a frame is lost only if no way through the links of all paths is left."),
      optional<&Redundancy::number>("number",
                                    "The node that numbers the frames, if not the one that copies them: the sender or "
                                    "a switch before it. From there they carry their R-TAG."),
      optional<&Redundancy::split>(
          "split",
          "The node that copies the frames, and numbers them: the sender or a switch. Where the paths part if absent."),
      optional<&Redundancy::merge>(
          "merge", "The node that takes out the copies: the receiver or a switch. Where the paths meet if absent."),
      optional<&Redundancy::algorithm>("algorithm", "How copies are recognised."),
      optional<&Redundancy::history>(
          "history",
          "How many numbers the vector algorithm remembers; more than the frames by which one path can be ahead.",
          {.min = 2, .max = 1024}),
      optional<&Redundancy::reset_timeout>("reset_timeout", "Without a frame for so long any number is taken again.",
                                           {.min = 1_us, .max = longest_interval}),
      optional<&Redundancy::individual>("individual", "Also recover each path by itself before (individual recovery)."),
      optional<&Redundancy::take_untagged>("take_untagged", "Pass frames without a sequence number (TakeNoSequence)."),
      optional<&Redundancy::latent_errors>("latent_errors", "Detect that a path has failed although all frames come."),
      optional<&Redundancy::keep_tag>("keep_tag", "Frames keep their R-TAG behind the merge."),
  };
  static constexpr std::string_view either[] = {"count", "paths"};
  static constexpr json::Group groups[] = {json::at_most_one_of(either)};
  static constexpr json::Object table =
      json::object<Redundancy>("redundancy", "Frame replication and elimination (IEEE 802.1CB).", fields,
                               {.groups = groups, .shorthand = "count"});
  return table;
}

}  // namespace takt::scenario
