// SPDX-License-Identifier: Apache-2.0
// The clocks of a scenario and what keeps them together: plain structs, one for each JSON object. See description.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/fields.hpp"
#include "plant/latency.hpp"
#include "sim/time.hpp"
#include "sim/units.hpp"

namespace takt::scenario {

/// A frequency that is the same for all nodes, or drawn for each.
struct FrequencyRange {
  json::Source where;
  std::optional<sim::FrequencyOffset> fixed;
  std::optional<sim::FrequencyOffset> from;
  std::optional<sim::FrequencyOffset> to;
  bool operator==(const FrequencyRange&) const = default;
};

struct TemperatureWave {
  sim::FrequencyOffset amplitude;
  sim::Duration period;
  double phase = 0;
  bool any_phase = false;
  bool operator==(const TemperatureWave&) const = default;
};

struct RandomWalk {
  sim::FrequencyOffset step;
  sim::FrequencyOffset bound;
  bool operator==(const RandomWalk&) const = default;
};

struct FrequencyAt {
  sim::Duration at;
  sim::FrequencyOffset frequency;
  bool operator==(const FrequencyAt&) const = default;
};

/// One node's oscillator and the counter behind it.
struct Clock {
  Clock();
  Clock(const Clock&);
  Clock(Clock&&) noexcept;
  Clock& operator=(const Clock&);
  Clock& operator=(Clock&&) noexcept;
  ~Clock();

  json::Source where;
  bool ideal = false;
  FrequencyRange offset;
  FrequencyRange drift;  ///< in a second
  std::optional<TemperatureWave> temperature;
  std::optional<RandomWalk> walk;
  std::vector<FrequencyAt> table;
  sim::Duration update = sim::Duration::from_ps(10'000'000'000);
  sim::Duration initial;
  sim::Duration granularity = sim::Duration::from_ps(1);
  sim::Duration jitter;
  sim::Duration tx_latency;
  sim::Duration rx_latency;
  std::optional<sim::Duration> tx_correction;
  std::optional<sim::Duration> rx_correction;
  bool operator==(const Clock&) const = default;
};

enum class ServoAlgorithm : std::uint8_t { pi, drift_tracking };

struct ServoSettings {
  json::Source where;
  ServoAlgorithm algorithm = ServoAlgorithm::pi;
  sim::Duration first_step_threshold = sim::Duration::from_ps(20'000'000);
  sim::Duration step_threshold;
  sim::FrequencyOffset max_frequency{900'000'000'000};
  bool operator==(const ServoSettings&) const = default;
};

enum class GptpRole : std::uint8_t { time_transmitter, time_receiver, passive, disabled };

/// The role of a port where BMCA does not choose.
struct GptpPortRole {
  json::Source where;
  std::string to;
  GptpRole role = GptpRole::time_transmitter;
  bool operator==(const GptpPortRole&) const = default;
};

enum class LeapSecond : std::uint8_t { none, leap59, leap61 };

/// What a grandmaster announces of its time.
struct AnnouncedTime {
  json::Source where;
  std::int16_t utc_offset = 37;
  bool utc_offset_valid = false;
  LeapSecond leap = LeapSecond::none;
  bool time_traceable = false;
  bool frequency_traceable = false;
  std::uint8_t source = 0xA0;
  bool operator==(const AnnouncedTime&) const = default;
};

/// What differs for one node.
struct GptpNode {
  json::Source where;
  std::optional<std::uint8_t> priority1;  ///< 248; with hot standby 255
  std::uint8_t priority2 = 248;
  std::uint8_t clock_class = 248;
  std::uint8_t clock_accuracy = 0xFE;
  std::optional<std::vector<GptpPortRole>> roles;
  std::optional<bool> boundary = {};
  std::optional<AnnouncedTime> time = {};
  bool operator==(const GptpNode&) const = default;
};

struct GptpDomain {
  json::Source where;
  std::uint8_t domain = 0;
  json::NameMap<GptpNode> nodes;
  bool operator==(const GptpDomain&) const = default;
};

/// When a domain of a hot standby is synced, and when two are redundant. IEEE 802.1ASdm, PtpInstanceSyncDS and
/// HotStandbySystemDS.
struct StandbyThresholds {
  json::Source where;
  sim::Duration offset_max = sim::Duration::from_ps(1'000'000);
  std::uint16_t offset_met = 4;
  std::uint16_t offset_exceeded = 2;
  std::uint16_t rx_sync_count = 4;
  sim::Duration primary_secondary_offset = sim::Duration::from_ps(1'000'000);
  sim::Duration waiting_time;
  bool operator==(const StandbyThresholds&) const = default;
};

/// A node asks its neighbour for other intervals: once, by Signaling with the message-interval request TLV.
struct IntervalRequest {
  json::Source where;
  sim::Duration at;
  std::string node;
  std::string to;
  std::uint8_t domain = 0;
  std::optional<std::int8_t> sync = {};
  std::optional<std::int8_t> announce = {};
  std::optional<std::int8_t> link_delay = {};
  bool operator==(const IntervalRequest&) const = default;
};

struct Gptp {
  Gptp();
  Gptp(const Gptp&);
  Gptp(Gptp&&) noexcept;
  Gptp& operator=(const Gptp&);
  Gptp& operator=(Gptp&&) noexcept;
  ~Gptp();

  json::Source where;
  std::int8_t log_sync_interval = -3;
  std::int8_t log_announce_interval = 0;
  std::int8_t log_pdelay_interval = 0;
  std::optional<std::int8_t> log_gptp_capable_interval = {};
  std::uint8_t sync_receipt_timeout = 3;
  std::uint8_t announce_receipt_timeout = 3;
  bool one_step = false;
  bool sync_locked = true;
  bool boundary = false;
  std::optional<plant::Latency> processing = {};  ///< 5 us
  bool drift_tracking = false;
  std::uint16_t rate_ratio_window = 8;
  std::uint16_t average_link_delay = 1;
  std::uint16_t drift_window = 0;
  std::optional<sim::Duration> link_delay_threshold = {};  ///< that of the medium
  ServoSettings servo;
  json::NameMap<GptpNode> nodes;
  std::vector<GptpDomain> domains;
  bool hot_standby = false;
  std::optional<StandbyThresholds> standby_thresholds = {};
  std::vector<IntervalRequest> interval_requests = {};
  sim::Duration report_every = sim::Duration::from_ps(10'000'000'000);
  std::vector<std::string> without;
  bool operator==(const Gptp&) const = default;
};

enum class ClockModel : std::uint8_t { ideal, free_running };

struct Clocks {
  json::Source where;
  ClockModel model = ClockModel::ideal;
  std::optional<Clock> all;
  json::NameMap<Clock> nodes;
  std::optional<Gptp> gptp;
  bool operator==(const Clocks&) const = default;
};

const json::Object& describe(json::Type<FrequencyRange>);
const json::Object& describe(json::Type<TemperatureWave>);
const json::Object& describe(json::Type<RandomWalk>);
const json::Object& describe(json::Type<FrequencyAt>);
const json::Object& describe(json::Type<Clock>);
const json::Enumeration& describe(json::Type<LeapSecond>);
const json::Object& describe(json::Type<AnnouncedTime>);
const json::Enumeration& describe(json::Type<ServoAlgorithm>);
const json::Object& describe(json::Type<ServoSettings>);
const json::Object& describe(json::Type<StandbyThresholds>);
const json::Object& describe(json::Type<IntervalRequest>);
const json::Enumeration& describe(json::Type<GptpRole>);
const json::Object& describe(json::Type<GptpPortRole>);
const json::Object& describe(json::Type<GptpNode>);
const json::Object& describe(json::Type<GptpDomain>);
const json::Object& describe(json::Type<Gptp>);
const json::Enumeration& describe(json::Type<ClockModel>);
const json::Object& describe(json::Type<Clocks>);

}  // namespace takt::scenario
