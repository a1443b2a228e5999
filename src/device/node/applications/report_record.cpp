// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "json/record.hpp"
#include "node/applications/host.hpp"

namespace takt::node {
namespace {

struct Age {
  const gateway::AgeFigures* of = nullptr;
  std::int64_t least() const { return of->least.ps() / 1000; }
  std::int64_t mean() const { return of->mean().ps() / 1000; }
  std::int64_t greatest() const { return of->greatest.ps() / 1000; }
};

const json::Record& describe(json::Type<Age>) {
  static constexpr json::Output outputs[] = {
      json::output<&Age::least>("min_ns", "The least; 0 of none.", {.unit = "ns"}),
      json::output<&Age::mean>("mean_ns", "The mean; 0 of none.", {.unit = "ns"}),
      json::output<&Age::greatest>("max_ns", "The greatest; 0 of none.", {.unit = "ns"}),
  };
  static constexpr json::Record record{"age", "How long values that were forwarded have waited.", outputs};
  return record;
}

/// Durations in ns.
struct Durations {
  const application::DurationFigures* of = nullptr;
  std::uint64_t count() const { return of->count(); }
  std::int64_t least() const { return of->least().ps() / 1000; }
  std::int64_t mean() const { return of->count() == 0 ? 0 : of->mean().ps() / 1000; }
  std::int64_t greatest() const { return of->greatest().ps() / 1000; }
  std::int64_t deviation() const {
    return of->count() == 0 ? 0 : static_cast<std::int64_t>(std::sqrt(of->variance_ns2()) + 0.5);
  }
};

const json::Record& describe(json::Type<Durations>) {
  static constexpr json::Output outputs[] = {
      json::output<&Durations::count>("count", "How many."),
      json::output<&Durations::least>("min_ns", "The least; 0 of none.", {.unit = "ns"}),
      json::output<&Durations::mean>("mean_ns", "The mean; 0 of none.", {.unit = "ns"}),
      json::output<&Durations::greatest>("max_ns", "The greatest; 0 of none.", {.unit = "ns"}),
      json::output<&Durations::deviation>("deviation_ns", "The standard deviation; 0 of none.", {.unit = "ns"}),
  };
  static constexpr json::Record record{"durations", "Durations of happenings of one kind.", outputs};
  return record;
}

std::int64_t nominal_of(const SignalStatistics& signal) { return signal.pulse.ps() / 1000; }
std::uint64_t edges_of(const SignalStatistics& signal) { return signal.figures.latency.count(); }
Durations latency_of(const SignalStatistics& signal) { return {&signal.figures.latency}; }
Durations pulses_of(const SignalStatistics& signal) { return {&signal.figures.pulses}; }
Durations periods_of(const SignalStatistics& signal) { return {&signal.figures.periods}; }
std::uint64_t irregular_pulses_of(const SignalStatistics& signal) { return signal.figures.irregular_pulses; }
std::uint64_t irregular_periods_of(const SignalStatistics& signal) { return signal.figures.irregular_periods; }

struct Buffer {
  const gateway::ChannelFigures* of = nullptr;
  std::uint64_t received() const { return of->received(); }
  std::uint64_t forwarded() const { return of->buffer.forwarded; }
  std::uint64_t overwritten() const { return of->buffer.overwritten; }
  std::uint64_t dropped() const { return of->buffer.dropped; }
  std::uint64_t stale() const { return of->buffer.stale; }
  std::uint64_t mapping_errors() const { return of->mapping_error_total(); }
  Age age() const { return {&of->age}; }
};

const json::Record& describe(json::Type<Buffer>) {
  static constexpr json::Output outputs[] = {
      json::output<&Buffer::received>("received", "Values that came."),
      json::output<&Buffer::forwarded>("forwarded", "Values that were sent on."),
      json::output<&Buffer::overwritten>("overwritten", "Values that made room for a newer one."),
      json::output<&Buffer::dropped>("dropped", "Values for which there was no room."),
      json::output<&Buffer::stale>("stale", "Values that had waited for too long."),
      json::output<&Buffer::mapping_errors>("mapping_errors", "Values that are none of the other protocol's type."),
      json::output<&Buffer::age>("age", "How long they waited."),
  };
  static constexpr json::Record record{"buffer", "The buffer between the two protocols.", outputs};
  return record;
}

bool takes(const ThreadStatistics& thread) { return thread.value_windows.tests + thread.value_windows.discarded > 0; }
Buffer buffer_of_gateway(const ApplicationStatistics& gateway) { return {&*gateway.channel}; }
bool has_buffer(const ApplicationStatistics& application) { return application.channel.has_value(); }

std::vector<ApplicationStatistics> those(const ApplicationsReport& report, bool are_gateways) {
  std::vector<ApplicationStatistics> some;
  std::ranges::copy_if(report.all, std::back_inserter(some),
                       [&](const ApplicationStatistics& each) { return each.is_gateway == are_gateways; });
  return some;
}
std::vector<ApplicationStatistics> applications_of(const ApplicationsReport& report) { return those(report, false); }
std::vector<ApplicationStatistics> gateways_of(const ApplicationsReport& report) { return those(report, true); }

}  // namespace

const json::Record& describe(json::Type<SignalStatistics>) {
  static constexpr json::Output outputs[] = {
      json::output<&SignalStatistics::name>("name", "Its name."),
      json::output<&nominal_of>("nominal_ns", "Length of a pulse; a period is twice that.", {.unit = "ns"}),
      json::output<&edges_of>("edges", "Changes of its level, which is low at the beginning."),
      json::output<&latency_of>(
          "latency", "Of each edge: from the activation whose call took the sample until the level changed."),
      json::output<&pulses_of>("pulses", "Whole pulses, from rise to fall."),
      json::output<&periods_of>("periods", "From rise to rise."),
      json::output<&irregular_pulses_of>("irregular_pulses", "Pulses that are more than 10 % off."),
      json::output<&irregular_periods_of>("irregular_periods", "Periods that are more than 10 % off."),
  };
  static constexpr json::Record record{"signal", "A digital output, by the clock of the node.", outputs};
  return record;
}

const json::Record& describe(json::Type<ThreadStatistics>) {
  using T = ThreadStatistics;
  static constexpr json::Output outputs[] = {
      json::output<&T::name>("name", "Its name."),
      json::output<&T::role>("role", "publish or subscribe; of a gateway receive or send."),
      json::output<&T::topic>("topic", "What it publishes or takes."),
      json::output<&T::every_ns>("every_ns", "From activation to activation.", {.unit = "ns"}),
      json::output<&T::window_ns>("window_ns", "The window of its criteria.", {.unit = "ns"}),
      json::output<&T::calls>("calls", "Activations that it answered."),
      json::output<&T::missed>(
          "missed", "Activations that were over before it was let run, or before their drawn response time was."),
      json::output<&T::sent>("sent", "Samples that the protocol took."),
      json::output<&T::timed_out>("timed_out",
                                  "Samples of DDS that found no room for max_blocking_time, and were not sent."),
      json::output<&T::not_sent>("not_sent", "Samples that the protocol or the socket refused."),
      json::output<&T::taken>("taken", "Samples that came."),
      json::output<&T::lost>("lost", "Numbers of messages that were jumped over, of OPC UA."),
      json::output<&T::late>(
          "late",
          "Waking up, against when it had to: from an activation, or from the end of the response time drawn for it."),
      json::output<&T::response>("response", "From an activation to the call that answers it."),
      json::output<&T::call_windows>("criterion_1", "Calls, window by window."),
      json::only_if<&takes>(
          json::output<&T::value_windows>("criterion_2", "Samples that its buffer took, window by window."),
          "of a thread that takes samples"),
      json::output_if_any<&T::signal>("signal", "The digital output that it drives.", "of a thread with one"),
  };
  static constexpr json::Record record{"thread", "What a thread did.", outputs};
  return record;
}

const json::Record& describe(json::Type<ApplicationStatistics>) {
  static constexpr json::Output outputs[] = {
      json::output<&ApplicationStatistics::name>("name", "Its name."),
      json::output<&ApplicationStatistics::threads>("threads", "Each of its threads."),
      json::only_if<&has_buffer>(json::output<&buffer_of_gateway>("buffer", "Between its threads."), "of a gateway"),
  };
  static constexpr json::Record record{"application", "An application or gateway.", outputs};
  return record;
}

const json::Record& describe(json::Type<ApplicationsReport>) {
  static constexpr json::Output outputs[] = {
      json::output<&ApplicationsReport::node>("node", "Its name."),
      json::output<&applications_of>("applications", "Its applications."),
      json::output<&gateways_of>("gateways", "Its gateways."),
      json::output<&ApplicationsReport::sources>(
          "sources",
          "Whom it has heard over OPC UA, and what was refused of them; 64 senders at most, and the others together."),
      json::output_if_any<&ApplicationsReport::security>("security", "Its secured messages.",
                                                         "of a node whose topics are secured"),
  };
  static constexpr json::Record record{"statistics", "What the applications and gateways of a node did.", outputs};
  return record;
}

std::string to_json(const ApplicationsReport& report) {
  return json::compact(json::ShapeOf<ApplicationsReport>::write(report));
}

}  // namespace takt::node
