// SPDX-License-Identifier: Apache-2.0
// What holds for every network and every traffic.
#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <map>
#include <set>

#include "tests/experiments/property/random_network.hpp"

namespace takt::models::property {
namespace {

/// The references of those that live of the frames with these handles, and how many they are.
std::pair<std::uint64_t, std::size_t> references_of(const Traffic& traffic, const std::set<std::uint64_t>& handles) {
  std::pair<std::uint64_t, std::size_t> found;
  const auto add = [&](const Frame& frame) {
    found.first += frame.references;
    found.second += frame.references > 0 ? 1 : 0;
  };
#ifdef TAKT_LONE_SLOTS
  static_cast<void>(handles);  // of a frame that has ended nothing is left to look at
  traffic.for_each_live(add);
#else
  for (const std::uint64_t handle : handles) add(traffic.frame(FrameIndex{static_cast<std::uint32_t>(handle)}));
#endif
  return found;
}

// Conservation, at several times of the run: sent + copies = delivered + dropped + in flight for each stream
// (in_flight() is defined so), and what is in flight is what the live frames count as their copies.
TEST(NetworkProperty, Conservation) {
  EXPECT_TRUE(rc::check("frames in flight are the references of the live frames", [] {
    LiveScenario live(any_scenario());
    TraceLog trace;
    live.run.simulation.set_trace(&trace);
    std::set<std::uint64_t> handles;
    std::size_t read = 0;
    for (const Duration time : {0_us, 3_us, 17_us, 100_us, 333_us, 1_ms, scenario_end}) {
      live.run.until(time);
      const Traffic& traffic = live.run.network->traffic();
      for (; read < trace.records.size(); ++read)
        if (trace.records[read].kind == static_cast<std::uint32_t>(Occurrence::produced))
          handles.insert(trace.records[read].what);
      const auto [references, live_frames] = references_of(traffic, handles);
      std::uint64_t in_flight = 0;
      for (const Stream& stream : traffic.streams()) {
        RC_ASSERT(stream.delivered + stream.dropped_in_all() <= stream.sent + stream.copies);
        RC_ASSERT(stream.latency.count() == stream.delivered);
        in_flight += stream.in_flight();
      }
      RC_ASSERT(references == in_flight);
      RC_ASSERT(live_frames == traffic.live_frames());
    }
  }));
}

// Once the talkers fall silent everything ends: nothing is in flight, every pool entry is back.
TEST(NetworkProperty, EverythingEnds) {
  EXPECT_TRUE(rc::check("nothing stays in flight", [] {
    Scenario scenario = any_scenario();
    scenario.plan.talkers.clear();
    LiveScenario live(scenario);
    live.run.until(10_s);
    RC_ASSERT(live.run.network->traffic().live_frames() == 0u);
    RC_ASSERT(live.run.simulation.pending() == 0u);
    for (std::uint32_t node = 0; node < scenario.plan.nodes.size(); ++node)
      for (const EgressPort& port : live.run.network->ports(NodeIndex{node})) RC_ASSERT(port.queues().empty());
    for (const Stream& stream : live.run.network->traffic().streams()) {
      RC_ASSERT(stream.in_flight() == 0u);
      if (stream.listeners == 1) {
        RC_ASSERT(stream.copies == 0u);
      }
      RC_ASSERT(stream.dropped[static_cast<std::size_t>(DropReason::no_filtering_entry)] == 0u);
      RC_ASSERT(stream.copies <= stream.sent * (stream.listeners - 1));
      if (stream.dropped_in_all() == 0) {
        RC_ASSERT(stream.delivered == stream.sent * stream.listeners);
      }
    }
  }));
}

/// Follows the trace of one port.
class PortObserver {
 public:
  PortObserver() = default;
  PortObserver(Duration octet, const PortConfig& config) : octet_(octet), config_(&config) {}

  void started(TrueTime time, std::uint64_t frame, std::uint64_t length, Priority priority) {
    const TrafficClass q = config_->traffic_class_of_priority[priority];
    // No two frames overlap, and at least the gap of 12 octets lies between them.
    RC_ASSERT(time >= free_at_);
    std::deque<std::uint64_t>& queue = waiting_[q];
    if (!queue.empty()) {
      // Within a class in the order of arrival; and the medium was never idle while the frame waited.
      RC_ASSERT(queue.front() == frame);
      RC_ASSERT(time == free_at_);
      queue.pop_front();
    }
    for (std::size_t higher = q + std::size_t{1}; higher < waiting_.size(); ++higher)
      RC_ASSERT(waiting_[higher].empty());
    started_at_ = time;
    class_ = q;
    free_at_ = time + octet_ * static_cast<std::int64_t>(8 + length + 12);
  }
  void enqueued(TrueTime time, std::uint64_t frame, std::uint64_t traffic_class, Priority priority) {
    RC_ASSERT(traffic_class == config_->traffic_class_of_priority[priority]);
    // A frame waits only while the medium is busy, and one that starts in this very instant is at least as urgent.
    RC_ASSERT(free_at_ > time);
    if (started_at_ == time) {
      RC_ASSERT(traffic_class <= class_);
    }
    waiting_[traffic_class].push_back(frame);
    RC_ASSERT(waiting_[traffic_class].size() <= config_->queue_limits[traffic_class].frames);
  }

 private:
  Duration octet_;
  const PortConfig* config_ = nullptr;
  TrueTime free_at_;
  TrueTime started_at_ = TrueTime::never();
  TrafficClass class_ = 0;
  std::array<std::deque<std::uint64_t>, traffic_class_count> waiting_;
};

TEST(NetworkProperty, TheWire) {
  EXPECT_TRUE(rc::check("no overlap, gaps, first in first out within a class, strict priority, no idling", [] {
    const Scenario scenario = any_scenario();
    LiveScenario live(scenario);
    TraceLog trace;
    live.run.simulation.set_trace(&trace);
    live.run.until(scenario_end);

    std::map<std::uint32_t, PortObserver> ports;  // by component id
    const NetworkPlan& plan = scenario.plan;
    for (const LinkPlan& link : plan.links)
      for (const LinkPlan::End& end : {link.a, link.b})
        ports[live.run.port(end.node, end.port).id().index] =
            PortObserver(link.rate.octet_time(), plan.port_configs[plan.nodes[end.node.value].port_config]);
    std::map<std::uint64_t, Priority> priority_of;  // by handle, as last produced
    std::uint64_t started = 0;
    TrueTime last;
    for (const sim::TraceRecord& record : trace.records) {
      RC_ASSERT(record.time >= last);
      last = record.time;
      switch (static_cast<Occurrence>(record.kind)) {
        case Occurrence::produced:
          priority_of[record.what] = plan.streams[record.detail].priority.value_or(0);
          break;
        case Occurrence::started:
          ports.at(record.where.index)
              .started(record.time, record.what, models::TransmissionDetail::unpack(record.detail).octets,
                       priority_of.at(record.what));
          ++started;
          break;
        case Occurrence::enqueued:
          ports.at(record.where.index).enqueued(record.time, record.what, record.detail, priority_of.at(record.what));
          break;
        default:
          break;
      }
    }
    std::uint64_t sent = 0;
    for (std::uint32_t node = 0; node < plan.nodes.size(); ++node)
      for (const EgressPort& port : live.run.network->ports(NodeIndex{node})) sent += port.frames_sent();
    RC_ASSERT(started == sent);
    RC_CLASSIFY(trace.of(Occurrence::enqueued).size() > 50, "many frames waited");
    RC_CLASSIFY(!trace.of(Occurrence::drop).empty(), "frames were dropped");
  }));
}

// A stream has one priority and one path: its frames arrive in the order in which they were sent, whatever gets lost.
TEST(NetworkProperty, StreamsStayInOrder) {
  EXPECT_TRUE(rc::check("sequence numbers rise at every listener", [] {
    LiveScenario live(any_scenario());
    live.run.until(10_ms);
    std::size_t arrivals = 0;
    for (const Listener* listener : live.listeners) {
      std::map<StreamIndex, std::uint64_t> next;
      LocalTime last;
      for (const Listener::Arrival& arrival : listener->arrivals) {
        RC_ASSERT(arrival.time >= last);
        last = arrival.time;
        RC_ASSERT(arrival.sequence >= next[arrival.stream]);
        next[arrival.stream] = arrival.sequence + 1;
        ++arrivals;
      }
    }
    RC_CLASSIFY(arrivals > 20, "more than 20 arrivals");
  }));
}

}  // namespace
}  // namespace takt::models::property
