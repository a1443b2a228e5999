// SPDX-License-Identifier: Apache-2.0
// Ports and bridges have short ways for what is so most often (models/egress, models/ingress: README.md). What comes
// out must be what the long way gives. Each test runs random traffic twice: as it is, and with something that changes
// no frame but makes short ways impossible.
#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <vector>

#include "tests/models/network_fixture.hpp"

namespace takt::models::short_paths_test {
namespace {

using namespace test;

constexpr int runs = 40;

class Chance {
 public:
  explicit Chance(std::uint32_t seed) : engine_(seed) {}
  std::int64_t operator()(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }

 private:
  std::mt19937_64 engine_;
};

/// Two talkers, two switches, one listener; four streams in two classes, which come in bursts and alone, at instants of
/// their own and at common ones.
struct Traffics {
  PlanBuilder builder;
  NodeIndex second;

  Traffics(Chance& chance, const PortConfig& config) {
    builder.plan.port_configs[0] = config;
    const NodeIndex talkers[] = {builder.host("t0"), builder.host("t1")};
    const NodeIndex first = builder.bridge("sw0");
    second = builder.bridge("sw1");
    const NodeIndex listener = builder.host("listener");
    builder.link(talkers[0], first);
    builder.link(talkers[1], first);
    builder.link(first, second, 1_Gbps, 50_ns);
    builder.link(second, listener, 1_Gbps, 50_ns);
    for (int i = 0; i < 4; ++i) {
      const StreamIndex stream =
          builder.stream(talkers[i % 2], {listener}, {static_cast<Priority>(i < 2 ? 6 : 4), 0, Octets{0}});
      TraceSchedule schedule;
      Duration time = Duration::from_ps(chance(0, 30) * 1'000'000);
      while (time < 2_ms) {
        schedule.entries.push_back({local(time), Octets{static_cast<std::uint32_t>(chance(0, 1'500))}});
        time += Duration::from_ps(chance(0, 3) == 0 ? chance(1, 4) * 1'000'000 : chance(5'000'000, 90'000'000));
      }
      builder.talk(stream, 0_B, schedule);
    }
  }
  std::uint64_t delivered(const NetworkRun& run) const {
    std::uint64_t sum = 0;
    for (const Stream& stream : run.network->traffic().streams()) sum += stream.delivered;
    return sum;
  }
};

using MakeConfig = std::function<PortConfig(Chance&)>;
using Change = std::function<void(NetworkPlan&)>;

void expect_no_difference(const MakeConfig& config, const Change& set_up, const Change& bar) {
  for (std::uint32_t seed = 1; seed <= runs; ++seed) {
    Chance chance(seed);
    const PortConfig ports = config(chance);
    Traffics traffics(chance, ports);
    set_up(traffics.builder.plan);
    NetworkPlan barred = traffics.builder.plan;
    bar(barred);
    NetworkRun one(traffics.builder.plan), other(barred);
    one.until(10_ms);
    other.until(10_ms);
    ASSERT_GT(traffics.delivered(one), 50u) << "seed " << seed;
    ASSERT_EQ(one.digest(), other.digest()) << "seed " << seed;
  }
}

void nothing(NetworkPlan&) {}
/// No frame is longer; a port that asks takes the general way of ports with gates.
void bar_by_max_sdu(NetworkPlan& plan) { plan.port_configs[0].shaping.queue_max_sdu.fill(2000_B); }
/// Gates that are always open have to be asked all the same.
void bar_by_open_gates(NetworkPlan& plan) {
  GateConfig gates;
  gates.admin_cycle_time = 100_us;
  gates.admin_control_list.push_back({GateOperation::set_gate_states, all_gates_open, 100_us});
  plan.port_configs[0].shaping.gates = gates;
}

PortConfig with_random_gates(Chance& chance, bool with_limits) {
  PortConfig config;
  GateConfig gates;
  for (int entry = 0; entry < 6; ++entry) {
    const Duration interval = Duration::from_ps(chance(3, 40) * 1'000'000);
    gates.admin_control_list.push_back(
        {GateOperation::set_gate_states, static_cast<GateStates>(entry == 0 ? 0xFF : chance(0, 255)), interval});
    gates.admin_cycle_time += interval;
  }
  gates.admin_control_list[0].interval += 15_us;  // the longest frame fits into it
  gates.admin_cycle_time += 15_us;
  config.shaping.gates = gates;
  if (with_limits) {
    for (QueueLimit& limit : config.queue_limits)
      limit = {static_cast<std::uint32_t>(chance(1, 3)), static_cast<std::uint32_t>(chance(1'600, 4'000)),
               chance(0, 1) == 1};
  }
  return config;
}

TEST(ShortPaths, Gates) {
  expect_no_difference([](Chance& chance) { return with_random_gates(chance, false); }, nothing, bar_by_max_sdu);
}

TEST(ShortPaths, GatesBeforeShortQueues) {
  expect_no_difference([](Chance& chance) { return with_random_gates(chance, true); }, nothing, bar_by_max_sdu);
}

TEST(ShortPaths, CreditBasedShapers) {
  const auto config = [](Chance& chance) {
    PortConfig shaped;
    for (const std::size_t q : {6u, 4u})
      shaped.shaping.selection[q] =
          CreditBased{DataRate{static_cast<std::uint64_t>(chance(50, 500)) * 1'000'000}, false};
    return shaped;
  };
  expect_no_difference(config, nothing, bar_by_open_gates);
}

PortConfig with_preemption(Chance&) {
  PortConfig config;
  config.preemption = PreemptionConfig{0x1F, AddFragSize(0), std::nullopt, {}};
  return config;
}

TEST(ShortPaths, Preemption) { expect_no_difference(with_preemption, nothing, bar_by_open_gates); }

TEST(ShortPaths, PreemptionBehindShortQueues) {
  const auto config = [](Chance& chance) {
    PortConfig merging = with_preemption(chance);
    for (QueueLimit& limit : merging.queue_limits)
      limit = {static_cast<std::uint32_t>(chance(1, 3)), static_cast<std::uint32_t>(chance(1'600, 4'000)),
               chance(0, 1) == 1};
    return merging;
  };
  expect_no_difference(config, nothing, bar_by_open_gates);
}

/// Both switches police both classes: streams 0 and 1 meet a meter, 2 and 3 a scheduler.
void police(NetworkPlan& plan, std::uint64_t rate, std::uint32_t burst) {
  IngressConfig ingress;
  for (std::uint32_t s = 0; s < plan.streams.size(); ++s) ingress.streams.push_back(plan.streams[s].name);
  // All go to one address: what tells them apart is the priority.
  ingress.stream_identity_table.push_back(
      {StreamHandle{0}, AddressIdentification{plan.streams[0].destination, Tagged::all, 0}, {}});
  FlowMeterConfig meter;
  meter.committed_information_rate = {rate};
  meter.committed_burst_size = {burst};
  meter.drop_on_yellow = true;
  ingress.flow_meters.push_back({"meter", meter});
  ingress.ats_schedulers.push_back({"scheduler", {rate}, {burst}, true, {}});
  StreamFilterConfig metered;
  metered.priority = Priority{6};
  metered.flow_meter = FlowMeterIndex{0};
  StreamFilterConfig shaped;
  shaped.priority = Priority{4};
  shaped.ats_scheduler = AtsSchedulerIndex{0};
  ingress.stream_filters = {metered, shaped};
  plan.ingress_configs.push_back(ingress);
  for (NodePlan& node : plan.nodes)
    if (node.kind == NodeKind::bridge) node.ingress = 0;
}

TEST(ShortPaths, MetersAndSchedulers) {
  const auto config = [](Chance&) {
    PortConfig timed;
    timed.shaping.selection[4] = TimeBased{};
    return timed;
  };
  // A stream gate that is always open lets every frame pass as it is, and the chain has to ask it.
  const auto bar = [](NetworkPlan& plan) {
    plan.ingress_configs[0].stream_gates.push_back({});
    for (StreamFilterConfig& filter : plan.ingress_configs[0].stream_filters) filter.stream_gate = StreamGateIndex{0};
    bar_by_open_gates(plan);
  };
  for (const std::uint64_t rate : {30'000'000u, 150'000'000u, 600'000'000u}) {
    expect_no_difference(
        config, [&](NetworkPlan& plan) { police(plan, rate, 2'000); }, bar);
  }
}

/// A link that may fail is asked about each frame.
void bar_by_links_that_may_fail(NetworkPlan& plan) {
  for (LinkPlan& link : plan.links) link.may_fail = true;
}

TEST(ShortPaths, ArrivalsThatAreWithdrawn) {
  expect_no_difference(with_preemption, nothing, bar_by_links_that_may_fail);
}

TEST(ShortPaths, ArrivalsThatAreWithdrawnFromABridgeThatPolices) {
  expect_no_difference(
      with_preemption, [](NetworkPlan& plan) { police(plan, 150'000'000, 2'000); }, bar_by_links_that_may_fail);
}

}  // namespace
}  // namespace takt::models::short_paths_test
