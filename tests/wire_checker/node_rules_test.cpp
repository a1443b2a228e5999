// SPDX-License-Identifier: Apache-2.0
// Hand-made records of a small network, right and wrong: each rule about frames between ports must be able to fail.
//
// h1 - sw - h2, 1 Gb/s, no delays: a frame of 100 octets that starts at 0 is in the switch at (8 + 100) * 8 ns = 864
// ns.
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <span>

#include "tests/models/network_fixture.hpp"
#include "tests/wire_checker/wire_checker.hpp"

namespace takt::wire_checker {
namespace {

using models::DropReason;
using models::Occurrence;
using models::test::PlanBuilder;

constexpr Ps ns = 1'000;
// Components: nodes are 0, 1, 2; the ports follow.
constexpr std::uint32_t h1_port = 10, sw_to_h1 = 11, sw_to_h2 = 12, sw = 1, h2 = 2;

class Records {
 public:
  explicit Records(models::IngressConfig ingress = {}, std::vector<Change> changes = {}) {
    const auto a = builder_.host("h1"), b = builder_.bridge("sw"), c = builder_.host("h2");
    builder_.link(a, b);
    builder_.link(b, c);
    models::test::StreamOptions options;
    options.priority = 5;
    builder_.stream(a, {c}, options);
    builder_.plan.port_configs[0].traffic_class_of_priority = models::identity_traffic_classes;
    builder_.plan.ingress_configs.push_back(std::move(ingress));
    builder_.plan.nodes[1].ingress = 0;
    builder_.plan.port_configs[0].shaping.selection[5] = models::TimeBased{};
    changes_ = std::move(changes);
  }
  models::NetworkPlan& plan() { return builder_.plan; }

  /// Another frame under the handle; the first use of a sequence number produces it.
  Records& frame(std::uint32_t handle, std::uint64_t sequence, std::optional<std::uint16_t> r_tag = {}) {
    models::Frame& frame = frames_[handle];
    frame.stream = models::StreamIndex{0};
    frame.destination = models::AddressIndex{2};
    frame.source = models::AddressIndex{0};
    frame.sequence = sequence;
    frame.length = 100;
    frame.msdu = 78;
    frame.tagged = true;
    frame.priority = frame.queue_priority = 5;
    frame.r_tagged = r_tag.has_value();
    frame.r_tag_sequence = r_tag.value_or(0);
    return *this;
  }
  /// From here on the frame bears that eligibility time.
  Records& mark(std::uint32_t handle, Ps eligible) {
    frames_[handle].marked = true;
    frames_[handle].eligible = sim::LocalTime::from_ps(eligible);
    return *this;
  }
  Records& produced(Ps time, std::uint32_t handle) { return add(time, Occurrence::produced, 99, handle, 0); }
  Records& started(Ps time, std::uint32_t port, std::uint32_t handle) {
    return add(time, Occurrence::started, port, handle, models::TransmissionDetail{frames_[handle].length, 5}.pack());
  }
  Records& enqueued(Ps time, std::uint32_t port, std::uint32_t handle) {
    return add(time, Occurrence::enqueued, port, handle, 5);
  }
  Records& dequeued(Ps time, std::uint32_t port, std::uint32_t handle) {
    return add(time, Occurrence::dequeued, port, handle, 5);
  }
  Records& dropped(Ps time, std::uint32_t where, std::uint32_t handle, DropReason reason) {
    return add(time, Occurrence::drop, where, handle, static_cast<std::uint64_t>(reason));
  }
  /// The frame of sequence number n all the way, from `time` on.
  Records& all_the_way(Ps time, std::uint32_t handle) {
    return produced(time, handle).started(time, h1_port, handle).started(time + 864 * ns, sw_to_h2, handle);
  }

  std::string until(Ps end) {
    check(end);
    return checker_->violations().all();
  }
  /// The same, and what the model counted.
  std::string until(Ps end, const models::Stream& counted) {
    check(end);
    checker_->compare(std::span(&counted, 1));
    return checker_->violations().all();
  }

 private:
  struct Line {
    sim::TraceRecord record;
    models::Frame frame;
  };
  Records& add(Ps time, Occurrence occurrence, std::uint32_t where, std::uint32_t handle, std::uint64_t detail) {
    lines_.push_back({{sim::TrueTime::from_ps(time), static_cast<std::uint32_t>(occurrence), {where}, handle, detail},
                      frames_[handle]});
    return *this;
  }
  void check(Ps end) {
    const Directory directory{{{{0}}, {{1}}, {{2}}}, {{{h1_port}}, {{sw_to_h1}, {sw_to_h2}}, {{13}}}};
    checker_ = std::make_shared<WireChecker>(builder_.plan, changes_, directory,
                                             [this](models::FrameIndex) -> const models::Frame& { return present_; });
    for (const Line& line : lines_) {
      present_ = line.frame;
      checker_->record(line.record);
    }
    checker_->finish(end);
  }
  PlanBuilder builder_;
  std::vector<Change> changes_;
  std::map<std::uint32_t, models::Frame> frames_;
  std::vector<Line> lines_;
  models::Frame present_;
  std::shared_ptr<WireChecker> checker_;
};

#define EXPECT_FOUND(found, what) EXPECT_NE((found).find(what), std::string::npos) << (found)
#define EXPECT_NOTHING(found) EXPECT_EQ(found, "")

models::Stream counted(std::uint64_t sent, std::uint64_t delivered) {
  models::Stream stream;
  stream.name = "s";
  stream.sent = sent;
  stream.delivered = delivered;
  return stream;
}

TEST(NodeRules, AFrameGoesItsWay) {
  EXPECT_NOTHING(Records().frame(1, 0).all_the_way(0, 1).until(9'000 * ns, counted(1, 1)));
  EXPECT_FOUND(Records().frame(1, 0).produced(0, 1).started(0, h1_port, 1).until(9'000 * ns),
               "has arrived and neither goes on nor is dropped");
  EXPECT_NOTHING(Records()
                     .frame(1, 0)
                     .produced(0, 1)
                     .started(0, h1_port, 1)
                     .dropped(864 * ns, sw, 1, DropReason::no_filtering_entry)
                     .until(9'000 * ns));
  EXPECT_FOUND(Records().frame(1, 0).all_the_way(0, 1).started(3'000 * ns, sw_to_h2, 1).until(9'000 * ns),
               "comes from nowhere");
  EXPECT_FOUND(
      Records().frame(1, 0).produced(0, 1).started(0, h1_port, 1).started(863 * ns, sw_to_h2, 1).until(9'000 * ns),
      "comes from nowhere");
  EXPECT_FOUND(Records().frame(1, 0).started(0, h1_port, 1).until(800 * ns), "leaves a host that has not produced it");
}

TEST(NodeRules, AccountsAgree) {
  const auto records = [] {
    return Records().frame(1, 0).frame(2, 1).all_the_way(0, 1).produced(2'000 * ns, 2).started(2'000 * ns, h1_port, 2);
  };
  EXPECT_NOTHING(records().until(2'500 * ns, counted(2, 1)));  // the second one is on the first link
  EXPECT_FOUND(records().until(2'500 * ns, counted(2, 2)), "frames delivered: 1 on the wire, 2 counted");
  EXPECT_FOUND(records().until(2'500 * ns, counted(3, 1)), "frames sent: 2 on the wire, 3 counted");
  EXPECT_FOUND(records().until(2'500 * ns, counted(3, 1)), "frames in flight: 1 on the wire, 2 counted");
  models::Stream with_a_drop = counted(2, 1);
  with_a_drop.dropped[static_cast<std::size_t>(DropReason::link_loss)] = 1;
  EXPECT_FOUND(records().until(2'500 * ns, with_a_drop), "frames dropped for link_loss: 0 on the wire, 1 counted");
}

TEST(NodeRules, FramesArriveInOrder) {
  EXPECT_FOUND(Records()
                   .frame(1, 0)
                   .frame(2, 1)
                   .produced(0, 1)
                   .produced(0, 2)
                   .started(0, h1_port, 2)
                   .started(864 * ns, sw_to_h2, 2)
                   .started(1'000 * ns, h1_port, 1)
                   .started(1'864 * ns, sw_to_h2, 1)
                   .until(9'000 * ns),
               "arrives after a later one");
}

TEST(NodeRules, LinksThatFailLoseWithAReason) {
  const std::vector<Change> down = {{500 * ns, Change::LinkState{0, false}}};
  EXPECT_NOTHING(Records({}, down)
                     .frame(1, 0)
                     .produced(0, 1)
                     .started(0, h1_port, 1)
                     .dropped(864 * ns, h1_port, 1, DropReason::link_down)
                     .until(9'000 * ns));
  EXPECT_FOUND(Records({}, down)
                   .frame(1, 0)
                   .produced(700 * ns, 1)
                   .started(700 * ns, h1_port, 1)
                   .dropped(1'564 * ns, h1_port, 1, DropReason::link_down)
                   .until(9'000 * ns),
               "starts on a link that is down");
}

// 8 Mb/s and a burst of 120 octets: the first frame passes at once, the next 120 octets later = 120 us.
models::IngressConfig shaped(sim::Duration residence = sim::Duration::max()) {
  models::IngressConfig config;
  config.ats_schedulers.push_back({"a", sim::DataRate{8'000'000}, models::Octets{120}, true, {}});
  config.maximum_residence_time = residence;
  models::StreamFilterConfig filter;
  filter.ats_scheduler = models::AtsSchedulerIndex{0};
  config.stream_filters.push_back(filter);
  return config;
}

Records two_frames(models::IngressConfig config) {
  Records records(std::move(config));
  records.frame(1, 0).frame(2, 1).all_the_way(0, 1).produced(1'000 * ns, 2).started(1'000 * ns, h1_port, 2);
  return records;
}

TEST(NodeRules, AsynchronousTrafficShaping) {
  const Ps eligible = 864 * ns + 120'000 * ns;
  const auto records = [](sim::Duration residence) {
    Records all(shaped(residence));
    all.frame(1, 0).frame(2, 1).produced(0, 1).started(0, h1_port, 1).mark(1, 864 * ns).started(864 * ns, sw_to_h2, 1);
    all.produced(1'000 * ns, 2).started(1'000 * ns, h1_port, 2);
    return all;
  };
  const auto starting = [&](Ps start, Ps marked) {
    Records all = records(sim::Duration::max());
    all.mark(2, marked).enqueued(1'864 * ns, sw_to_h2, 2).dequeued(start, sw_to_h2, 2).started(start, sw_to_h2, 2);
    return all;
  };
  EXPECT_NOTHING(starting(eligible, eligible).until(200'000 * ns));
  EXPECT_FOUND(starting(eligible, eligible + 1).until(200'000 * ns),
               "is eligible at 120864001 ps instead of 120864000");
  EXPECT_FOUND(starting(eligible - 1, eligible).until(200'000 * ns), "starts 1 ps before its eligibility time");
  EXPECT_FOUND(starting(eligible + 1, eligible).until(200'000 * ns), "120864000 ps, sw:1 to h2: the medium is idle");
  // It would stay for 119 us.
  const auto limited = [&](Ps residence) { return records(sim::Duration::from_ps(residence)); };
  EXPECT_FOUND(limited(118'999 * ns).mark(2, eligible).enqueued(1'864 * ns, sw_to_h2, 2).until(10'000 * ns),
               "is not dropped for residence_time");
  EXPECT_NOTHING(limited(118'999 * ns).dropped(1'864 * ns, sw, 2, DropReason::residence_time).until(10'000 * ns));
  EXPECT_FOUND(limited(119'000 * ns).dropped(1'864 * ns, sw, 2, DropReason::residence_time).until(10'000 * ns),
               "is dropped for residence_time, which the configuration does not ask for");
}

// The same over a switch that takes 500 us: the second frame may start so long after its eligibility time, and not when
// it comes to the port.
TEST(NodeRules, TheForwardingDelayComesAfterTheEligibilityTime) {
  constexpr Ps delay = 500'000 * ns;
  const auto starting = [&](Ps start, Ps marked) {
    Records all(shaped());
    all.plan().nodes[1].forwarding_delay = sim::Duration::from_ps(delay);
    all.frame(1, 0)
        .frame(2, 1)
        .produced(0, 1)
        .started(0, h1_port, 1)
        .produced(1'000 * ns, 2)
        .started(1'000 * ns, h1_port, 2);
    all.mark(1, 864 * ns + delay).started(864 * ns + delay, sw_to_h2, 1);
    all.mark(2, marked)
        .enqueued(1'864 * ns + delay, sw_to_h2, 2)
        .dequeued(start, sw_to_h2, 2)
        .started(start, sw_to_h2, 2);
    return all;
  };
  const Ps ready = 120'864 * ns + delay;
  EXPECT_NOTHING(starting(ready, ready).until(900'000 * ns));
  EXPECT_FOUND(starting(1'864 * ns + delay, ready).until(900'000 * ns), "before its eligibility time");
  EXPECT_FOUND(starting(ready - delay, ready - delay).until(900'000 * ns), "is eligible at");
}

TEST(NodeRules, Policing) {
  models::IngressConfig config;
  models::StreamFilterConfig filter;
  filter.stream_gate = models::StreamGateIndex{0};
  filter.flow_meter = models::FlowMeterIndex{0};
  config.stream_filters.push_back(filter);
  models::StreamGateConfig gate;
  gate.admin_control_list = {{true, {}, sim::Duration::from_ps(1'500 * ns), {}},
                             {false, {}, sim::Duration::from_ps(1'500 * ns), {}}};
  gate.admin_cycle_time = sim::Duration::from_ps(3'000 * ns);
  config.stream_gates.push_back(gate);
  config.flow_meters.push_back({"m", {sim::DataRate{0}, models::Octets{100}, sim::DataRate{0}, models::Octets{0}}});
  EXPECT_FOUND(two_frames(config).started(1'864 * ns, sw_to_h2, 2).until(10'000 * ns),
               "is not dropped for stream_gate");
  EXPECT_NOTHING(two_frames(config).dropped(1'864 * ns, sw, 2, DropReason::stream_gate).until(10'000 * ns));
  config.stream_gates[0].admin_control_list[1].open = true;
  EXPECT_FOUND(two_frames(config).started(1'864 * ns, sw_to_h2, 2).until(10'000 * ns), "is not dropped for flow_meter");
  config.flow_meters[0].meter.committed_burst_size = models::Octets{200};
  EXPECT_FOUND(two_frames(config).dropped(1'864 * ns, sw, 2, DropReason::flow_meter).until(10'000 * ns),
               "is dropped for flow_meter, which the configuration does not ask for");
}

TEST(NodeRules, CopiesAreTakenOut) {
  const auto records = [](Ps reset_timeout) {
    Records all;
    models::StreamRecoveryConfig recovery;
    recovery.reset_timeout = sim::Duration::from_ps(reset_timeout);
    all.plan().host_recoveries.push_back({models::NodeIndex{2}, models::StreamIndex{0}, recovery});
    all.plan().host_splits.push_back({models::StreamIndex{0}, {}});
    all.frame(1, 0, 0)
        .frame(2, 0, 0)
        .all_the_way(0, 1)
        .started(2'000 * ns, h1_port, 2)
        .started(2'864 * ns, sw_to_h2, 2);
    return all;
  };
  EXPECT_FOUND(records(1'000'000 * ns).until(9'000 * ns), "passes the sequence recovery a second time");
  EXPECT_NOTHING(records(1'000'000 * ns).dropped(3'728 * ns, h2, 2, DropReason::duplicate).until(9'000 * ns));
  EXPECT_NOTHING(records(1'500 * ns).until(9'000 * ns));  // the recovery has forgotten
}

}  // namespace
}  // namespace takt::wire_checker
