// SPDX-License-Identifier: Apache-2.0
// The vocabulary of clocks and gPTP. See tables.cpp.
#include "plant/limits.hpp"
#include "scenario/description/clocks.hpp"

namespace takt::scenario {
namespace {

using json::name;
using json::optional;
using json::required;
using plant::most_names;
using sim::FrequencyOffset;
using namespace sim::literals;  // NOLINT: units in limits

constexpr FrequencyOffset most_offset{1'000'000'000};  // 1000 ppm
constexpr FrequencyOffset least_offset{-1'000'000'000};

}  // namespace

const json::Object& describe(json::Type<FrequencyRange>) {
  static constexpr json::Field fields[] = {
      optional<&FrequencyRange::fixed>("fixed", "The same for all.", {.min = least_offset, .max = most_offset}),
      optional<&FrequencyRange::from>("from", "The least that is drawn, with \"to\".",
                                      {.min = least_offset, .max = most_offset}),
      optional<&FrequencyRange::to>("to", "The greatest that is drawn, with \"from\".",
                                    {.min = least_offset, .max = most_offset}),
  };
  static constexpr json::Object table =
      json::object<FrequencyRange>("frequency", "A frequency offset, or a range from which each node draws its own.",
                                   fields, {.shorthand = "fixed"});
  return table;
}

const json::Object& describe(json::Type<TemperatureWave>) {
  static constexpr json::Field fields[] = {
      required<&TemperatureWave::amplitude>("amplitude", "How far the frequency goes up and down.",
                                            {.min = FrequencyOffset{0}, .max = most_offset}),
      required<&TemperatureWave::period>("period", "How long one wave takes.", {.min = 1_ms, .max = 24 * 3600_s}),
      optional<&TemperatureWave::phase>("phase", "Where in the wave the node begins, in turns.",
                                        {.min = 0.0, .max = 1.0}),
      optional<&TemperatureWave::any_phase>("any_phase",
                                            "Where it begins is drawn for each node, evenly, and phase added to it."),
  };
  static constexpr json::Object table =
      json::object<TemperatureWave>("temperature", "Temperature that goes up and down.", fields);
  return table;
}

const json::Object& describe(json::Type<RandomWalk>) {
  static constexpr json::Field fields[] = {
      required<&RandomWalk::step>("step", "Greatest step at each update.",
                                  {.min = FrequencyOffset{0}, .max = most_offset}),
      required<&RandomWalk::bound>("bound", "How far the walk goes.", {.min = FrequencyOffset{0}, .max = most_offset}),
  };
  static constexpr json::Object table = json::object<RandomWalk>("walk", "A random walk of the frequency.", fields);
  return table;
}

const json::Object& describe(json::Type<FrequencyAt>) {
  static constexpr json::Field fields[] = {
      required<&FrequencyAt::at>("at", "When.", {.max = 24 * 3600_s}),
      required<&FrequencyAt::frequency>("frequency", "The frequency offset then.",
                                        {.min = least_offset, .max = most_offset}),
  };
  static constexpr json::Object table =
      json::object<FrequencyAt>("frequency_at", "A point of a measured frequency.", fields);
  return table;
}

const json::Object& describe(json::Type<Clock>) {
  static constexpr json::Field fields[] = {
      optional<&Clock::ideal>("ideal", "The node knows true time; nothing else counts then."),
      optional<&Clock::offset>("offset", "Frequency offset at the start."),
      optional<&Clock::drift>("drift", "Change of the frequency in a second."),
      optional<&Clock::temperature>("temperature", "A sinusoidal change of the frequency."),
      optional<&Clock::walk>("walk", "A random walk of the frequency."),
      optional<&Clock::table>("table", "A measured frequency, linear between its points, on top of the others.",
                              {.max_items = most_names}),
      optional<&Clock::update>("update", "How often a frequency that changes is worked out.",
                               {.min = 10_us, .max = 10_s}),
      optional<&Clock::initial>("initial", "What the node's time is ahead of true time at the start.",
                                {.min = -(3600_s), .max = 3600_s}),
      optional<&Clock::granularity>("granularity", "The counter behind time stamps goes on in steps of this.",
                                    {.min = 1_ps, .max = 1_ms}),
      optional<&Clock::jitter>("jitter", "Greatest random error of a time stamp, either way, uniform.", {.max = 1_ms}),
      optional<&Clock::tx_latency>("tx_latency", "From the place where a frame that leaves is stamped to the wire.",
                                   {.max = 1_ms}),
      optional<&Clock::rx_latency>("rx_latency", "From the wire to the place where a frame that comes is stamped.",
                                   {.max = 1_ms}),
      optional<&Clock::tx_correction>("tx_correction", "What the node believes tx_latency to be; rightly, if absent.",
                                      {.max = 1_ms}),
      optional<&Clock::rx_correction>("rx_correction", "What the node believes rx_latency to be; rightly, if absent.",
                                      {.max = 1_ms}),
  };
  static constexpr json::Object table =
      json::object<Clock>("clock", "An oscillator and the counter behind it.", fields);
  return table;
}

const json::Enumeration& describe(json::Type<ServoAlgorithm>) {
  static constexpr json::EnumName names[] = {
      name(ServoAlgorithm::pi, "pi", "proportional and integral, with the gains of linuxptp"),
      name(ServoAlgorithm::drift_tracking, "drift-tracking",
           "follows a frequency that goes on changing without an offset"),
  };
  static constexpr json::Enumeration table = json::enumeration<ServoAlgorithm>("a servo", names);
  return table;
}

const json::Object& describe(json::Type<ServoSettings>) {
  static constexpr json::Field fields[] = {
      optional<&ServoSettings::algorithm>("algorithm", "How offsets become frequencies."),
      optional<&ServoSettings::first_step_threshold>(
          "first_step_threshold", "A first offset beyond it is stepped away; 0s: never.", {.max = 3600_s}),
      optional<&ServoSettings::step_threshold>("step_threshold", "A later offset beyond it is stepped away; 0s: never.",
                                               {.max = 3600_s}),
      optional<&ServoSettings::max_frequency>("max_frequency", "How far the clock can be trimmed.",
                                              {.min = FrequencyOffset{1}, .max = FrequencyOffset{900'000'000'000}}),
  };
  static constexpr json::Object table =
      json::object<ServoSettings>("servo", "What disciplines the clocks.", fields, {.shorthand = "algorithm"});
  return table;
}

const json::Enumeration& describe(json::Type<GptpRole>) {
  static constexpr json::EnumName names[] = {
      name(GptpRole::time_transmitter, "time-transmitter", "sends Sync"),
      name(GptpRole::time_receiver, "time-receiver", "takes Sync; one port of a node"),
      name(GptpRole::passive, "passive", "neither"),
      name(GptpRole::disabled, "disabled", "no gPTP"),
  };
  static constexpr json::Enumeration table = json::enumeration<GptpRole>("the role of a port", names);
  return table;
}

const json::Object& describe(json::Type<GptpPortRole>) {
  static constexpr json::Field fields[] = {
      required<&GptpPortRole::to>("to", "The neighbour at the port."),
      required<&GptpPortRole::role>("role", "What the port does."),
  };
  static constexpr json::Object table = json::object<GptpPortRole>("gptp_role", "The role of one port.", fields);
  return table;
}

const json::Enumeration& describe(json::Type<LeapSecond>) {
  static constexpr json::EnumName names[] = {
      name(LeapSecond::none, "none", "the last minute of the day has 60 seconds"),
      name(LeapSecond::leap59, "59", "it has 59"),
      name(LeapSecond::leap61, "61", "it has 61"),
  };
  static constexpr json::Enumeration table = json::enumeration<LeapSecond>("a leap second", names);
  return table;
}

const json::Object& describe(json::Type<AnnouncedTime>) {
  static constexpr json::Field fields[] = {
      optional<&AnnouncedTime::utc_offset>("utc_offset", "currentUtcOffset: TAI less UTC in seconds.",
                                           {.min = -1000, .max = 1000}),
      optional<&AnnouncedTime::utc_offset_valid>("utc_offset_valid", "currentUtcOffsetValid."),
      optional<&AnnouncedTime::leap>("leap", "leap59 or leap61."),
      optional<&AnnouncedTime::time_traceable>("time_traceable", "timeTraceable: to a primary reference."),
      optional<&AnnouncedTime::frequency_traceable>("frequency_traceable", "frequencyTraceable."),
      optional<&AnnouncedTime::source>("source", "timeSource; 0x20 (32) is GNSS, 0xA0 (160) an internal oscillator."),
  };
  static constexpr json::Object table = json::object<AnnouncedTime>(
      "announced_time", "What a grandmaster announces of its time; all others pass it on (IEEE 1588 timePropertiesDS).",
      fields);
  return table;
}

const json::Object& describe(json::Type<GptpNode>) {
  static constexpr json::Field fields[] = {
      optional<&GptpNode::priority1>(
          "priority1",
          "The smaller the better; 255: never grandmaster. Without it 248; in the two domains of a hot standby 255 "
          "(unless \"roles\" say who transmits): who may be grandmaster there is named."),
      optional<&GptpNode::priority2>("priority2", "Decides where priority1 and quality are equal."),
      optional<&GptpNode::clock_class>("clock_class", "clockClass; 6 is a primary reference."),
      optional<&GptpNode::clock_accuracy>("clock_accuracy", "clockAccuracy; 0x20 (32) is 25 ns, 0xFE (254) unknown."),
      optional<&GptpNode::time>("time", "What it announces of its time when it is grandmaster."),
      optional<&GptpNode::boundary>("boundary", "Whether the node is a boundary clock; as \"gptp\" says if absent."),
      optional<&GptpNode::roles>("roles",
                                 "Roles of the ports instead of the best-time-transmitter algorithm (external port "
                                 "configuration); ports that are not named transmit.",
                                 {.max_items = 4096}),
  };
  static constexpr json::Object table =
      json::object<GptpNode>("gptp_node", "What the best-time-transmitter algorithm knows of a node.", fields);
  return table;
}

const json::Object& describe(json::Type<GptpDomain>) {
  static constexpr json::Field fields[] = {
      required<&GptpDomain::domain>("domain", "domainNumber.", {.max = 127}),
      optional<&GptpDomain::nodes>("nodes", "What is particular to nodes in this domain.", {.max_items = most_names}),
  };
  static constexpr json::Object table = json::object<GptpDomain>("gptp_domain", "A gPTP domain.", fields);
  return table;
}

const json::Object& describe(json::Type<StandbyThresholds>) {
  static constexpr json::Field fields[] = {
      optional<&StandbyThresholds::offset_max>("offset_max", "How far from its grandmaster's time a domain is synced.",
                                               {.min = 1_ns, .max = 1_s}),
      optional<&StandbyThresholds::offset_met>("offset_met", "So many offsets in a row within it make a domain synced.",
                                               {.min = 1, .max = 1000}),
      optional<&StandbyThresholds::offset_exceeded>(
          "offset_exceeded", "So many in a row beyond it and it is so no longer.", {.min = 1, .max = 1000}),
      optional<&StandbyThresholds::rx_sync_count>("rx_sync_count", "So many Syncs must have come first.",
                                                  {.min = 1, .max = 1000}),
      optional<&StandbyThresholds::primary_secondary_offset>(
          "primary_secondary_offset", "Domains whose times differ by more are no standby for each other.",
          {.max = 1_s}),
      optional<&StandbyThresholds::waiting_time>(
          "waiting_time", "How long a better state must have lasted before it counts; 0s: not at all.",
          {.max = 3600_s}),
  };
  static constexpr json::Object table = json::object<StandbyThresholds>(
      "standby_thresholds", "When a domain of a hot standby is synced, and when two are redundant (IEEE 802.1ASdm).",
      fields);
  return table;
}

const json::Object& describe(json::Type<IntervalRequest>) {
  static constexpr json::Field fields[] = {
      required<&IntervalRequest::at>("at", "When it asks.", {.max = 24 * 3600_s}),
      required<&IntervalRequest::node>("node", "Who asks."),
      required<&IntervalRequest::to>(
          "to", "The neighbour that is asked. It does what it can, 2^-7 s to 2^4 s, until the link goes down."),
      optional<&IntervalRequest::domain>("domain", "domainNumber. The link's delay is of no domain."),
      optional<&IntervalRequest::sync>(
          "sync", "timeSyncInterval: Sync every 2^this seconds; 126: as at the beginning, 127: none.",
          {.min = -24, .max = 127}),
      optional<&IntervalRequest::announce>("announce", "announceInterval: Announce, likewise.",
                                           {.min = -24, .max = 127}),
      optional<&IntervalRequest::link_delay>("link_delay", "linkDelayInterval: Pdelay_Req, likewise.",
                                             {.min = -24, .max = 127}),
  };
  static constexpr json::Object table =
      json::object<IntervalRequest>("interval_request",
                                    "A node asks its neighbour for other message intervals, by Signaling with the "
                                    "message-interval request TLV (IEEE 802.1AS-2020 10.6.4.3).",
                                    fields);
  return table;
}

const json::Object& describe(json::Type<Gptp>) {
  static constexpr json::Field fields[] = {
      optional<&Gptp::log_sync_interval>("log_sync_interval", "Sync every 2^this seconds.", {.min = -7, .max = 4}),
      optional<&Gptp::log_announce_interval>("log_announce_interval", "Announce every 2^this seconds.",
                                             {.min = -7, .max = 4}),
      optional<&Gptp::log_pdelay_interval>("log_pdelay_interval", "Pdelay_Req every 2^this seconds.",
                                           {.min = -7, .max = 4}),
      optional<&Gptp::log_gptp_capable_interval>(
          "log_gptp_capable_interval",
          "Signaling with the gPTP-capable TLV every 2^this seconds; a neighbour that has sent none for nine of its "
          "intervals is not capable. If absent none is sent, and neighbours are taken at their word.",
          {.min = -7, .max = 4}),
      optional<&Gptp::sync_receipt_timeout>("sync_receipt_timeout", "After so many intervals without Sync it is lost.",
                                            {.min = 2}),
      optional<&Gptp::announce_receipt_timeout>(
          "announce_receipt_timeout", "After so many intervals without Announce the grandmaster is lost.", {.min = 2}),
      optional<&Gptp::one_step>("one_step", "Sync carries its time itself."),
      optional<&Gptp::sync_locked>("sync_locked",
                                   "A bridge sends Sync on when it has got one, not at intervals of its own."),
      optional<&Gptp::boundary>("boundary",
                                "All nodes that hand Sync on are boundary clocks, as with ptp4l: each gives the time "
                                "of its own clock, at its own interval, instead of relaying what it has got."),
      optional<&Gptp::processing>("processing",
                                  "From the decision to send a message to the queue of its port, of at most 1 s: "
                                  "residence and turn-around time. 5 us if absent."),
      optional<&Gptp::drift_tracking>("drift_tracking",
                                      "Sync carries the Drift_Tracking TLV (IEEE 802.1ASdm): how fast the sender's "
                                      "rate ratio changes, to which each adds what its link shows."),
      optional<&Gptp::rate_ratio_window>("rate_ratio_window",
                                         "Pdelay exchanges from which the neighbour's rate ratio is worked out.",
                                         {.min = 1, .max = 64}),
      optional<&Gptp::average_link_delay>(
          "average_link_delay", "Pdelay exchanges over which the link delay is averaged.", {.min = 1, .max = 1024}),
      optional<&Gptp::drift_window>(
          "drift_window",
          "Syncs from which the drift of the rate ratio is worked out and made up for; 0: not at all. Even.",
          {.max = 1024}),
      optional<&Gptp::link_delay_threshold>(
          "link_delay_threshold",
          "A link that seems longer is not capable of gPTP. If absent, that of its medium: 800 ns for copper, none for "
          "fibre, which a link of more than 100 m (500 ns) is taken for.",
          {.max = 1_s}),
      optional<&Gptp::servo>("servo", "The servo of all nodes."),
      optional<&Gptp::nodes>("nodes", "What is particular to nodes (domain 0).", {.max_items = most_names}),
      optional<&Gptp::domains>("domains", "Further domains.", {.max_items = 4}),
      optional<&Gptp::hot_standby>("hot_standby",
                                   "The first of \"domains\" is secondary to domain 0 (IEEE 802.1ASdm): time comes "
                                   "from the primary while it is synced, otherwise from the secondary. Both have a "
                                   "grandmaster of their own, by \"roles\" or as the nodes that have a \"priority1\"."),
      optional<&Gptp::standby_thresholds>("standby_thresholds", "Of the hot standby of every node."),
      optional<&Gptp::interval_requests>("interval_requests", "What nodes ask of their neighbours, once each.",
                                         {.max_items = most_names}),
      optional<&Gptp::report_every>("report_every", "How often offsets are looked at for the report.",
                                    {.min = 1_us, .max = 3600_s}),
      optional<&Gptp::without>("without", "Nodes without gPTP.", {.max_items = most_names}),
  };
  static constexpr json::Object table = json::object<Gptp>("gptp", "Time synchronisation, IEEE 802.1AS-2020.", fields);
  return table;
}

const json::Enumeration& describe(json::Type<ClockModel>) {
  static constexpr json::EnumName names[] = {
      name(ClockModel::ideal, "ideal", "every node knows true time"),
      name(ClockModel::free_running, "free-running", "every node has an oscillator of its own"),
  };
  static constexpr json::Enumeration table = json::enumeration<ClockModel>("a clock model", names);
  return table;
}

const json::Object& describe(json::Type<Clocks>) {
  static constexpr json::Field fields[] = {
      optional<&Clocks::model>("model",
                               "Of the nodes that nothing else is said of; free-running if anything else is said."),
      optional<&Clocks::all>("all", "The clock of every node."),
      optional<&Clocks::nodes>("nodes", "The clocks of single nodes, instead.", {.max_items = most_names}),
      optional<&Clocks::gptp>("gptp", "What keeps them together; they run free if absent."),
  };
  static constexpr json::Object table =
      json::object<Clocks>("clocks", "The clocks of the nodes. Gates, launch times, talkers and programs run by them.",
                           fields, {.shorthand = "model"});
  return table;
}

}  // namespace takt::scenario
