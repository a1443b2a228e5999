// SPDX-License-Identifier: Apache-2.0
// Gate lists that have been running since before the start: in force from the first instant, somewhere in their cycle.
// Minimum frames at 1 Gb/s take 576 ns.
#include <gtest/gtest.h>

#include "models/ingress/stream_gate.hpp"
#include "tests/models/network_fixture.hpp"

namespace takt::models::running_gates_test {
namespace {

using namespace test;

/// When a frame that is ready at the start has come. The gate is open for 2 us of 10, and the first cycle began, or was
/// to begin, at `base`.
LocalTime arrival(Duration base, bool is_running, bool is_shaped = false) {
  Line line(0, 1_Gbps, 0_ns);
  ShapingConfig& shaping = line.builder.plan.port_configs[0].shaping;
  shaping.gates.emplace();
  shaping.gates->admin_control_list = {{GateOperation::set_gate_states, 0xFF, 2_us},
                                       {GateOperation::set_gate_states, 0x00, 8_us}};
  shaping.gates->admin_cycle_time = 10_us;
  shaping.gates->admin_base_time = local(base);
  shaping.gates->is_running = is_running;
  if (is_shaped) shaping.selection[1] = CreditBased{sim::DataRate{100'000'000}, false};
  const StreamIndex stream = line.builder.stream(line.talker, {line.listener});
  NetworkRun run(line.builder.plan);
  install<Sender>(*run.network, line.talker, "sender", std::vector<Sender::Item>{{local(0_ns), stream, 8}});
  const Listener& log = listen(*run.network, line.listener, {stream});
  run.until(100_us);
  EXPECT_EQ(log.arrivals.size(), 1u);
  return log.arrivals.empty() ? LocalTime::never() : log.arrivals[0].time;
}

// Set at the start, the list begins with the first cycle after it, at 7 us; until then all gates are open. It has been
// running: 3 us of the cycle are over, and the gate is closed up to 7 us. With 1 us over the gate is open for another
// one.
TEST(RunningGates, AreInForceFromTheStart) {
  EXPECT_EQ(arrival(-3_us, false), local(576_ns));
  EXPECT_EQ(arrival(-3_us, true), local(7'576_ns));
  EXPECT_EQ(arrival(-1_us, true), local(576_ns));
  EXPECT_EQ(arrival(-1'500_ns, true), local(9'076_ns));  // 500 ns are too short
  EXPECT_EQ(arrival(-10'003_us, true), local(7'576_ns));
  EXPECT_EQ(arrival(0_us, true), local(576_ns));
}

// A shaper behind the gate knows of it, too: its credit is 0, and the frame starts when the gate opens.
TEST(RunningGates, ShapersFollowThem) {
  EXPECT_EQ(arrival(-3_us, false, true), local(576_ns));
  EXPECT_EQ(arrival(-3_us, true, true), local(7'576_ns));
}

// Closed for 2 us of 10.
TEST(RunningGates, StreamGatesAreToo) {
  const auto passes = [](bool is_running, Duration at) {
    StreamGateConfig config;
    config.admin_control_list = {{false, {}, 2_us, {}}, {true, {}, 8_us, {}}};
    config.admin_cycle_time = 10_us;
    config.admin_base_time = local(-1_us);
    config.is_running = is_running;
    StreamGate gate(config);
    return gate.admit(64_B, local(at)).outcome == StreamGate::Outcome::passed;
  };
  EXPECT_TRUE(passes(false, 0_us));
  EXPECT_FALSE(passes(true, 0_us));
  EXPECT_FALSE(passes(true, 999'999_ps));
  EXPECT_TRUE(passes(true, 1_us));
  EXPECT_FALSE(passes(true, 9_us));
  EXPECT_FALSE(passes(false, 9_us));
}

}  // namespace
}  // namespace takt::models::running_gates_test
