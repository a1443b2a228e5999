// SPDX-License-Identifier: Apache-2.0
// Whole frames in the windows of a gate: bounds against figures by hand, and against runs of random queues in which
// frames come as they may. TAKT_PACKED_CASES=5000 looks at more queues.
#include "analysis/packed_windows.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "analysis/port_bound.hpp"
#include "sim/random.hpp"
#include "tests/support/case_count.hpp"

namespace takt::analysis::packed_windows_test {
namespace {

constexpr Ps ns = 1'000;
constexpr Ps us = 1'000'000;

/// A window of 15 us in each 100 us, the first `taken` of which another frame may take.
PackedWindows one_window(Ps room, Ps taken = 0) {
  return {{{room - taken, room, 100 * us, 100 * us - room + taken}}, 0, 0};
}

// A frame that fits by nothing waits for the rest of its window, the time in which it is closed, and itself.
TEST(PackedWindows, OneFrameInEachWindow) {
  const auto delays = delays_of_packed({{8 * us, 100 * us, 0}}, one_window(15 * us));
  ASSERT_TRUE(delays);
  EXPECT_EQ((*delays)[0], 8 * us + 85 * us + 8 * us);
  EXPECT_EQ((*delays_of_packed({{8 * us, 100 * us, 0}}, one_window(15 * us, 2 * us)))[0], 8 * us + 87 * us + 8 * us);
}

// The gap behind a frame need not fit any more.
TEST(PackedWindows, GapsMayReachOverTheClose) {
  PackedWindows windows = one_window(15 * us);
  EXPECT_FALSE(delays_of_packed({{16 * us, 100 * us, 0}}, windows));
  windows.gap = us;
  ASSERT_TRUE(delays_of_packed({{16 * us, 100 * us, 0}}, windows));
}

// Work by the second says nothing: two frames of 8 us do not fit into 15 us, so one of them and a short one each 100 us
// may be as much as there is.
TEST(PackedWindows, ALongFrameAndAShortOneInEachWindow) {
  const auto delays = delays_of_packed({{8 * us, 100 * us, 0}, {2 * us, 100 * us, 20 * us}}, one_window(15 * us));
  ASSERT_TRUE(delays);
  // The long one comes with a short one, and just does not fit behind it.
  EXPECT_EQ((*delays)[0], 2 * us + 8 * us + 85 * us + 8 * us);
}

// One frame more than windows, once in a thousand periods, and the queue grows for ever.
TEST(PackedWindows, NoBoundIfMoreComes) {
  EXPECT_FALSE(delays_of_packed({{8 * us, 99'900 * ns, 0}}, one_window(15 * us)));
  EXPECT_FALSE(delays_of_packed({{8 * us, 100 * us, 0}, {8 * us, 1'000 * us, 0}}, one_window(15 * us)));
  EXPECT_TRUE(delays_of_packed({{8 * us, 100 * us, 0}, {8 * us, 1'000 * us, 0}}, one_window(16 * us)));
}

/// At 1 Gb/s: class 7 has `open` of each 100 us, in which a frame of 1000 octets, 8.16 us, and one of 200, 1.76 us,
/// come at any time; a frame of class 0 has the rest.
struct Port {
  explicit Port(Ps open, Ps jitter = 0) {
    models::GateConfig gates;
    gates.admin_control_list = {
        {models::GateOperation::set_gate_states, 0x80, sim::Duration::from_ps(open)},
        {models::GateOperation::set_gate_states, 0x7F, sim::Duration::from_ps(100 * us - open)}};
    gates.admin_cycle_time = sim::Duration::from_ps(100 * us);
    config.shaping.gates = gates;
    add(1000, 7, 100 * us);
    add(200, 7, 100 * us, jitter);
    add(1518, 0, 100 * us);
    model.octet_time = 8 * ns;
  }
  void add(std::uint32_t octets, models::TrafficClass q, Ps period, Ps jitter = 0) {
    PortFlow flow;
    flow.arrivals = FrameArrivals({period, 1, 0, jitter});
    flow.frame = sim::Octets{octets};
    flow.lowest_class = flow.highest_class = q;
    traffic.flows.push_back(std::move(flow));
  }
  void open_with_the_window(models::GateStates classes) {
    config.shaping.gates->admin_control_list[0].gate_states |= classes;
  }
  PortBound bound() {
    model.config = &config;
    return bound_port(model, traffic);
  }

  models::PortConfig config;
  PortTraffic traffic{{{}}, {}};
  PortModel model;
};

// In 10 us both fit. The busy period begins behind the gap of class 0, with both of them just not fitting; the next
// window begins with such a gap too.
TEST(PackedWindows, PortByHand) {
  Port port(10 * us);
  const Ps both = 1'760 * ns + 8'064 * ns;
  EXPECT_EQ(port.bound().flows[0].delay, 96 * ns + both + 90 * us + 96 * ns + both);
  EXPECT_EQ(port.bound().flows[1].delay, 96 * ns + both + 90 * us + 96 * ns + both);
  EXPECT_EQ(port.bound().classes[7].backlog, 2 * (8'160 * ns + 1'760 * ns));
  EXPECT_EQ(port.bound().classes[7].backlog_frames, 4);
  // Frames need not come: a stream that brings the short ones less often is no worse.
  port.traffic.flows[1].arrivals = FrameArrivals({300 * us, 1, 0, 0});
  EXPECT_LE(port.bound().flows[0].delay, 96 * ns + both + 90 * us + 96 * ns + both);
}

TEST(PackedWindows, ClocksShortenWindowsAndStretchWhatIsBetween) {
  Port port(15 * us, 20 * us);
  const Ps close_by = 96 * ns + 1'760 * ns + 8'064 * ns;  // a short frame goes, the long one just does not fit
  EXPECT_EQ(port.bound().flows[0].delay, close_by + 85 * us + 96 * ns + 8'064 * ns);
  port.model.clock.error = us;
  EXPECT_EQ(port.bound().flows[0].delay, close_by + 85 * us + 96 * ns + 2 * us + 8'064 * ns);
  port.model.clock = {1'000'000'000, 1'000'000'000, 1'000'000'000, 0, false};  // fast by 1000 ppm
  EXPECT_EQ(port.bound().flows[0].delay, close_by + scaled_up(85 * us + 96 * ns, 1000, 1001) + 8'064 * ns);
  port.model.clock = {1'000'000'000, -1'000'000'000, -1'000'000'000, 0, false};  // slow: fewer windows than long frames
  EXPECT_FALSE(is_bounded(port.bound().flows[0].delay));
  port.model.clock = {1'000'000, 1'000'000, 1'000'000, 0, false};
  EXPECT_TRUE(is_bounded(Port(9'920 * ns).bound().flows[0].delay));  // gap, short and long frame fill it
  EXPECT_FALSE(is_bounded(Port(9'919 * ns).bound().flows[0].delay));
  Port exact(9'920 * ns);
  exact.model.clock = port.model.clock;  // fast by 1 ppm: 9.92 ps too short
  EXPECT_FALSE(is_bounded(exact.bound().flows[0].delay));
}

// A frame of class 0 that may be sent in the window blocks the first of a busy period, and reaches into the next
// window: 27 us hold what 15 us did.
TEST(PackedWindows, LowerClassesBlockAndReachIn) {
  Port port(27 * us, 20 * us);
  port.open_with_the_window(0x01);
  const Ps frame = 12'304 * ns;
  EXPECT_EQ(port.bound().flows[0].delay, frame + 1'760 * ns + 8'064 * ns + 73 * us + frame + 8'064 * ns);
}

// The same as by hand above, but the class that has the rest is the higher one.
TEST(PackedWindows, TheGapBehindAHigherClassReachesIn) {
  Port port(10 * us);
  for (PortFlow& flow : port.traffic.flows) flow.lowest_class = flow.highest_class = flow.highest_class == 7 ? 3 : 7;
  port.config.shaping.gates->admin_control_list[0].gate_states = 0x08;
  port.config.shaping.gates->admin_control_list[1].gate_states = 0xF7;
  EXPECT_EQ(port.bound().flows[0].delay, 2 * (96 * ns + 1'760 * ns + 8'064 * ns) + 90 * us);
}

TEST(PackedWindows, WhatIsNotCountedByWindows) {
  const auto is_bounded_with = [](const auto& change) {
    Port port(15 * us, 20 * us);
    change(port);
    return is_bounded(port.bound().flows[0].delay);
  };
  EXPECT_TRUE(is_bounded_with([](Port&) {}));
  EXPECT_FALSE(is_bounded_with([](Port& port) {
    port.traffic.flows[0].arrivals = FrameArrivals({200 * us, 2, 0, 0});
  }));
  EXPECT_FALSE(is_bounded_with([](Port& port) { port.traffic.flows[1].arrivals = FrameArrivals(); }));
  EXPECT_FALSE(is_bounded_with([](Port& port) { port.config.cut_through = models::with(0, 7); }));
  EXPECT_FALSE(is_bounded_with([](Port& port) {
    port.config.preemption = models::PreemptionConfig{models::with(0, 0), {}, {}, {}};
  }));
  // A higher class in the window.
  Port port(15 * us, 20 * us);
  for (PortFlow& flow : port.traffic.flows)
    if (flow.highest_class == 7) flow.lowest_class = flow.highest_class = 6;
  for (models::GateControlEntry& entry : port.config.shaping.gates->admin_control_list)
    entry.gate_states = static_cast<models::GateStates>(entry.gate_states & 0x80 ? 0x40 : 0x3F);
  EXPECT_TRUE(is_bounded(port.bound().flows[0].delay));
  port.add(64, 7, 5'000 * us);
  EXPECT_TRUE(is_bounded(port.bound().flows[0].delay));  // whose gate is never open does not meet it
  port.open_with_the_window(0x80);
  EXPECT_FALSE(is_bounded(port.bound().flows[0].delay));
}

// A queue in which frames come at random times that their curves allow, and what others take of windows is random too.
class Queue {
 public:
  explicit Queue(std::uint64_t number) : chance_(number, "packed windows", "test") {
    const Ps cycle = 1000;
    const std::size_t count = 1 + chance_.below(2);
    lost_ = between(0, 30);
    windows_.gap = between(0, 10);
    windows_.blocked = one_in(2) ? windows_.gap : between(windows_.gap, 60);
    for (std::size_t w = 0; w < count; ++w) {
      const Ps from = static_cast<Ps>(w) * cycle / static_cast<Ps>(count) + between(0, 100);
      opens_.push_back({from, from + between(120, 350)});
    }
    for (std::size_t w = 0; w < count; ++w) {
      const Ps next = w + 1 < count ? opens_[w + 1].first : opens_[0].first + cycle;
      windows_.windows.push_back({opens_[w].second - opens_[w].first - lost_, opens_[w].second - opens_[w].first,
                                  next - opens_[w].first, next + lost_ - opens_[w].second});
    }
    // One with as many frames as windows, one with short ones, seldom a third.
    flows_.push_back({between(60, 200), one_in(3) ? between(900, 1300) : cycle / static_cast<Ps>(count),
                      one_in(2) ? 0 : between(0, 800)});
    flows_.push_back({between(12, 60), one_in(3) ? between(500, 3000) : cycle / static_cast<Ps>(count),
                      one_in(4) ? 0 : between(0, 2500)});
    if (one_in(5)) flows_.push_back({between(12, 90), between(2000, 4000), between(0, 500)});
    cycle_ = cycle;
  }

  const std::vector<PackedFlow>& flows() const { return flows_; }
  const PackedWindows& windows() const { return windows_; }
  std::string text() const {
    std::string made = fmt::format("lost {} blocked {} gap {};", lost_, windows_.blocked, windows_.gap);
    for (const auto& [from, until] : opens_) made += fmt::format(" [{}, {})", from, until);
    for (const PackedFlow& flow : flows_) made += fmt::format("; {} each {} + {}", flow.work, flow.period, flow.jitter);
    return made;
  }

  /// By flow, the longest delay of a run.
  std::vector<Ps> run(Ps duration) {
    std::vector<std::pair<Ps, std::size_t>> frames;
    for (std::size_t f = 0; f < flows_.size(); ++f) {
      Ps at = between(0, flows_[f].period - 1);
      Ps before = 0;
      const bool drifts = one_in(4);
      for (Ps due = at; due < duration; due += flows_[f].period + (drifts ? between(0, 40) : 0)) {
        if (one_in(40)) continue;
        // Early, late, or together with those before.
        before = std::max(before, due + (one_in(3) ? 0 : one_in(2) ? flows_[f].jitter : between(0, flows_[f].jitter)));
        frames.emplace_back(before, f);
      }
    }
    for (auto& frame : frames)
      frame.second += chance_.below(1000) * flows_.size();  // who comes at one instant, in any order
    std::sort(frames.begin(), frames.end());
    std::vector<Ps> longest(flows_.size(), 0);
    Ps free = -1;
    Ps lost_of = -1, lost = 0;
    for (auto [at, which] : frames) {
      const std::size_t f = which % flows_.size();
      const Ps last_bit = flows_[f].work - windows_.gap;
      Ps ready = at > free ? at + (one_in(2) ? windows_.blocked : between(0, windows_.blocked)) : std::max(at, free);
      for (Ps turn = (ready / cycle_ - 1) * static_cast<Ps>(opens_.size());; ++turn) {
        const auto& [from, until] = opens_[static_cast<std::size_t>(turn) % opens_.size()];
        const Ps base = turn / static_cast<Ps>(opens_.size()) * cycle_;
        if (turn < 0 || base + until <= ready) continue;
        Ps start = ready;
        if (at < base + from && free <= base + from) {  // it waits as the window opens, first of all
          if (lost_of != turn) lost = one_in(2) ? lost_ : between(0, lost_);
          lost_of = turn;
          start = base + from + lost;
        } else {
          start = std::max(start, base + from);
        }
        if (start + last_bit > base + until) continue;
        longest[f] = std::max(longest[f], start + last_bit - at);
        free = start + flows_[f].work;
        break;
      }
    }
    return longest;
  }

 private:
  bool one_in(std::size_t n) { return chance_.below(n) == 0; }
  Ps between(Ps least, Ps most) {
    return least + static_cast<Ps>(chance_.below(static_cast<std::size_t>(most - least + 1)));
  }

  sim::RandomStream chance_;
  Ps cycle_ = 0;
  Ps lost_ = 0;
  std::vector<std::pair<Ps, Ps>> opens_;
  std::vector<PackedFlow> flows_;
  PackedWindows windows_;
};

TEST(PackedWindows, NoRunIsAboveItsBound) {
  const std::uint64_t cases = support::case_count("TAKT_PACKED_CASES", 300);
  std::size_t bounded = 0, unbounded = 0, tight = 0;
  double tightest = 0;
  for (std::uint64_t number = 0; number < cases; ++number) {
    Queue queue(number);
    const auto delays = delays_of_packed(queue.flows(), queue.windows());
    ++(delays ? bounded : unbounded);
    if (!delays) continue;
    double best = 0;
    for (int run = 0; run < 12; ++run) {
      const std::vector<Ps> longest = queue.run(60'000);
      for (std::size_t f = 0; f < longest.size(); ++f) {
        ASSERT_LE(longest[f], (*delays)[f]) << "queue " << number << ", flow " << f << ": " << queue.text();
        best = std::max(best, static_cast<double>(longest[f]) / static_cast<double>((*delays)[f]));
      }
    }
    tight += best > 0.9;
    tightest = std::max(tightest, best);
  }
  EXPECT_GT(bounded, cases / 3);
  EXPECT_GT(unbounded, cases / 20);
  EXPECT_GT(tight, bounded / 4);
  EXPECT_LE(tightest, 1);
  RecordProperty("bounded", static_cast<int>(bounded));
  RecordProperty("tight", static_cast<int>(tight));
}

}  // namespace
}  // namespace takt::analysis::packed_windows_test
