// SPDX-License-Identifier: Apache-2.0
// The vocabulary of faults. See tables.cpp.
#include "plant/limits.hpp"
#include "scenario/description/faults.hpp"

namespace takt::scenario {

using json::name;
using json::optional;
using json::required;
using plant::longest;
using namespace sim::literals;  // NOLINT: units in limits

const json::Object& describe(json::Type<LinkDown>) {
  static constexpr json::Field fields[] = {
      required<&LinkDown::link>("link", "The two ends of the link, as \"node\" or \"node:port\".",
                                {.min_items = 2, .max_items = 2}),
      required<&LinkDown::at>("at", "When it goes down. What is on it or waits for it is lost.", {.max = longest}),
      optional<&LinkDown::lasts>("for", "When it comes back after that; never if absent.",
                                 {.min = 1_ns, .max = longest}),
  };
  static constexpr json::Object table = json::object<LinkDown>("link-down", "A link goes down.", fields);
  return table;
}

const json::Object& describe(json::Type<BurstLoss>) {
  static constexpr json::Field fields[] = {
      required<&BurstLoss::good_to_bad>("good_to_bad", "Probability, for each frame, that a good channel becomes bad.",
                                        {.min = 0.0, .max = 1.0}),
      required<&BurstLoss::bad_to_good>("bad_to_good", "Probability, for each frame, that a bad channel becomes good.",
                                        {.min = 0.0, .max = 1.0}),
      optional<&BurstLoss::loss_in_good>("loss_in_good", "Share of the frames that a good channel loses.",
                                         {.min = 0.0, .max = 1.0}),
      optional<&BurstLoss::loss_in_bad>("loss_in_bad", "Share of the frames that a bad channel loses.",
                                        {.min = 0.0, .max = 1.0}),
  };
  static constexpr json::Object table = json::object<BurstLoss>(
      "burst_loss", "Losses in bursts: a channel of Gilbert and Elliott that begins good.", fields);
  return table;
}

const json::Object& describe(json::Type<FrameErrors>) {
  static constexpr json::Field fields[] = {
      required<&FrameErrors::link>("link", "The two ends of the link, as \"node\" or \"node:port\".",
                                   {.min_items = 2, .max_items = 2}),
      optional<&FrameErrors::towards>("towards", "Only frames to this end; both directions if absent."),
      optional<&FrameErrors::loss>("loss", "Share of the frames that are lost, independently.",
                                   {.min = 0.0, .max = 1.0}),
      optional<&FrameErrors::burst_loss>("burst_loss", "Losses in bursts."),
      optional<&FrameErrors::corruption>(
          "corruption",
          "Share of the frames that are damaged: dropped where they are stored, passed on where they are cut through.",
          {.min = 0.0, .max = 1.0}),
      optional<&FrameErrors::bit_error_rate>("bit_error_rate", "Share of the bits that are damaged, independently.",
                                             {.min = 0.0, .max = 1.0}),
      optional<&FrameErrors::duplication>("duplication", "Share of the frames that come twice.",
                                          {.min = 0.0, .max = 1.0}),
      optional<&FrameErrors::at>("at", "From when on.", {.max = longest}),
      optional<&FrameErrors::lasts>("for", "For how long; to the end if absent.", {.min = 1_ns, .max = longest}),
  };
  static constexpr std::string_view losses[] = {"loss", "burst_loss"};
  static constexpr std::string_view damages[] = {"corruption", "bit_error_rate"};
  static constexpr json::Group groups[] = {json::at_most_one_of(losses), json::at_most_one_of(damages)};
  static constexpr json::Object table =
      json::object<FrameErrors>("frame-errors", "Chance harms the frames on a link.", fields, {.groups = groups});
  return table;
}

const json::Object& describe(json::Type<Crash>) {
  static constexpr json::Field fields[] = {
      required<&Crash::node>("node", "The host or switch."),
      required<&Crash::at>("at",
                           "When it fails: its links go down, its queues are lost, its programs lose their memory.",
                           {.max = longest}),
      optional<&Crash::lasts>("for", "When it starts again after that; never if absent.",
                              {.min = 1_ns, .max = longest}),
  };
  static constexpr json::Object table = json::object<Crash>("crash", "A node crashes and starts again.", fields);
  return table;
}

const json::Object& describe(json::Type<Babble>) {
  static constexpr json::Field fields[] = {
      required<&Babble::stream>("stream", "The stream whose talker goes wild. Its frames count as sent."),
      required<&Babble::at>("at", "When it begins.", {.max = longest}),
      optional<&Babble::lasts>("for", "For how long; to the end if absent.", {.min = 1_ns, .max = longest}),
      optional<&Babble::every>("every", "A frame more each time that this is over; as fast as its link goes if absent.",
                               {.min = 1_ns, .max = longest}),
  };
  static constexpr json::Object table = json::object<Babble>("babble", "A babbling talker.", fields);
  return table;
}

const json::Enumeration& describe(json::Type<GateFault>) {
  static constexpr json::EnumName names[] = {
      name(GateFault::open, "open", "stuck open"),
      name(GateFault::closed, "closed", "stuck closed"),
  };
  static constexpr json::Enumeration table = json::enumeration<GateFault>("how a gate is stuck", names);
  return table;
}

const json::Object& describe(json::Type<StuckGate>) {
  static constexpr json::Field fields[] = {
      required<&StuckGate::node>("node", "The node."),
      optional<&StuckGate::to>("to",
                               "Only the port to this neighbour; \"sw2:1\": of several links to it the one to its port "
                               "1. All ports of the node if absent."),
      required<&StuckGate::traffic_class>("class", "The traffic class whose gate does not move.", {.max = 7}),
      required<&StuckGate::state>("state", "How it stays."),
      required<&StuckGate::at>("at", "From when on.", {.max = longest}),
      optional<&StuckGate::lasts>("for", "For how long; to the end if absent.", {.min = 1_ns, .max = longest}),
  };
  static constexpr json::Object table =
      json::object<StuckGate>("stuck-gate", "A transmission gate that does not follow its list.", fields);
  return table;
}

const json::Object& describe(json::Type<ClockFault>) {
  static constexpr json::Field fields[] = {
      required<&ClockFault::node>("node", "The node, which has a clock of its own."),
      required<&ClockFault::at>("at", "When.", {.max = longest}),
      optional<&ClockFault::step>("step", "The clock jumps by this.", {.min = -(3600_s), .max = 3600_s}),
      optional<&ClockFault::offset>(
          "offset", "The frequency offset of the oscillator from then on.",
          {.min = sim::FrequencyOffset{-1'000'000'000}, .max = sim::FrequencyOffset{1'000'000'000}}),
  };
  static constexpr std::string_view kinds[] = {"step", "offset"};
  static constexpr json::Group groups[] = {json::exactly_one_of(kinds)};
  static constexpr json::Object table =
      json::object<ClockFault>("clock", "A clock jumps, or its frequency does.", fields, {.groups = groups});
  return table;
}

const json::Tagged& describe(json::Type<Fault>) {
  static constexpr auto kinds =
      json::options<Fault>({"link-down", "frame-errors", "crash", "babble", "stuck-gate", "clock"});
  static constexpr json::Tagged table = json::tagged<Fault>("fault", "Something that goes wrong.", "kind", kinds);
  return table;
}

const json::Object& describe(json::Type<Rerouting>) {
  static constexpr json::Field fields[] = {
      required<&Rerouting::delay>("delay",
                                  "So long after a link or a node has gone down or come back, the switches forward "
                                  "along the shortest paths that are left.",
                                  {.max = longest}),
  };
  static constexpr json::Object table = json::object<Rerouting>(
      "rerouting", "Static backup paths for what faults take away.", fields, {.shorthand = "delay"});
  return table;
}

}  // namespace takt::scenario
