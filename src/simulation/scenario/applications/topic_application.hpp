// SPDX-License-Identifier: Apache-2.0
// An application of several threads on a simulated host: each publishes to a topic or subscribes to one, in its own
// rhythm.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "application/round_trips.hpp"
#include "application/topic_values.hpp"
#include "models/host/application.hpp"
#include "scenario/applications/activations.hpp"
#include "scenario/applications/application_monitor.hpp"
#include "scenario/applications/topic_port.hpp"
#include "scenario/applications/window_counter.hpp"

namespace takt::scenario {

/// What was seen of a thread.
struct ThreadFigures {
  std::uint64_t activations = 0;
  std::uint64_t done = 0;
  DurationFigures response;                       ///< of the calls that took place, on the clock of the host
  plant::CriterionFigures calls;                  ///< criterion 1
  std::uint64_t published = 0;                    ///< samples that the protocol took, at once or when there was room
  std::uint64_t refused = 0;                      ///< samples that the protocol could not take
  std::uint64_t timed_out = 0;                    ///< samples that waited for room for too long, and were not published
  std::uint64_t arrived = 0;                      ///< samples that a call found
  std::uint64_t buffered = 0;                     ///< of them, those that the buffer held
  std::uint64_t overwritten = 0;                  ///< of them, those that newer ones displaced
  std::uint64_t lost = 0;                         ///< on the way
  std::optional<std::uint64_t> filtered = {};     ///< samples that a content filter kept out, where there is one
  std::optional<plant::CriterionFigures> values;  ///< criterion 2, of a subscription that gets all
  std::optional<DurationFigures> round_trip;  ///< of a subscription to which values come back, on the clock of the host
};

class DdsNode;
class GatewayBridge;

class TopicApplication final : public models::Application {
 public:
  /// `number` tells applications apart. `writers` and `readers` stand by thread, one of the two. All references outlive
  /// it.
  struct Settings {
    std::uint32_t number = 0;
    const ResolvedApplication* application = nullptr;
    const std::vector<ResolvedTopic>* topics = nullptr;
    std::vector<std::unique_ptr<TopicWriter>> writers;
    std::vector<std::unique_ptr<TopicReader>> readers;
    std::vector<std::unique_ptr<DdsNode>> nodes;  ///< that they use
    std::unique_ptr<GatewayBridge> bridge;        ///< of a gateway
    std::string path;                             ///< in the random streams: host, '/', application
    std::uint64_t seed = 0;
    std::vector<sim::Duration> instants = {sim::Duration()};  ///< from which figures are kept, by the clock of the host
  };
  TopicApplication(Settings settings, ApplicationMonitor& monitor);
  ~TopicApplication() override;

  models::AlarmId alarm_count() const override { return static_cast<models::AlarmId>(job_alarm(threads_.size())); }
  void start(models::HostServices& host) override;
  void restart(models::HostServices& host) override;
  void receive(models::HostServices& host, models::StreamIndex stream, std::span<const std::byte> payload) override;
  void wake(models::HostServices& host, models::AlarmId alarm) override;
  /// The host has crashed: the application is gone, with its memory. It comes back with `restart`.
  void crash();

  /// What was seen until then, on the clock of the host, of the activations that were due at `from` or later.
  ThreadFigures figures(std::size_t thread, sim::LocalTime now, sim::Duration from) const;
  /// Its participants of DDS.
  const std::vector<std::unique_ptr<DdsNode>>& nodes() const { return nodes_; }
  /// Null but in a gateway.
  const GatewayBridge* bridge() const { return bridge_.get(); }

 private:
  struct Live {
    Live(const ResolvedThread& thread, const Settings& of, const application::TopicShape& shape);
    /// The windows of all accounts are told the same.
    template <class Tell>
    void report_windows(Tell&& tell) {
      for (Windows& each : windows) {
        tell(each.calls);
        if (each.values) tell(*each.values);
      }
    }

    const ResolvedThread* settings;
    const application::TopicShape* topic;
    Activations activations;
    std::optional<Activations::Call> working;  // on a processor
    std::optional<Activations::Call> waiting;  // the last one whose time came meanwhile
    struct Windows {
      sim::Duration from;
      WindowCounter calls;
      std::optional<WindowCounter> values;
    };
    std::vector<Windows> windows;  // by instant
    std::unique_ptr<TopicWriter> writer;
    std::unique_ptr<TopicReader> reader;
    std::optional<application::Publication> publication;  // of the two that which the thread has
    std::optional<application::Subscription> subscription;
    std::vector<std::byte> newest;  // fields that were taken last; empty before
    /// What was seen, and what the protocol had lost when that began.
    struct Seen {
      ThreadFigures figures;
      std::optional<std::uint64_t> lost_before = {};
      std::uint64_t displaced_before = 0;
      std::uint64_t filtered_before = 0;
      application::RoundTrips round_trips = {};
    };
    Accounts<Seen, sim::LocalTime> seen;
  };

  /// Tells the thread that its processor has done what it does when it acts.
  models::AlarmId job_alarm(std::size_t thread) const {
    return static_cast<models::AlarmId>(1 + nodes_.size() + thread);
  }
  void begin(models::HostServices& host, std::uint32_t thread, const Activations::Call& call);
  void job_is_done(models::HostServices& host, std::uint32_t thread);
  void call(models::HostServices& host, std::uint32_t thread, sim::LocalTime now, sim::Duration response);
  void publish(models::HostServices& host, Live& live, sim::LocalTime now, sim::LocalTime due);
  /// What the thread publishes now, if anything.
  std::optional<uadp::Octets> next_of(Live& live, sim::LocalTime now);
  static void count(Live& live, sim::LocalTime began, WriteOutcome outcome);
  /// What participants want to send is sent, and they are woken when they want to be.
  void settle(models::HostServices& host);
  void take(models::HostServices& host, std::uint32_t thread, sim::LocalTime now, sim::LocalTime due);
  void plan(models::HostServices& host);

  std::uint32_t number_;
  ApplicationMonitor* monitor_;
  std::vector<Live> threads_;
  std::vector<std::uint32_t> order_;  // at one instant: those that subscribe, then those that publish
  std::vector<std::pair<models::StreamIndex, std::uint32_t>>
      heard_;  // ascending; the thread, or behind the threads the participant
  std::vector<std::unique_ptr<DdsNode>> nodes_;
  std::unique_ptr<GatewayBridge> bridge_;
  models::HostServices* host_ = nullptr;
  bool has_crashed_ = false;
};

}  // namespace takt::scenario
