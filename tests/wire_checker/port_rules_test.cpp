// SPDX-License-Identifier: Apache-2.0
// Hand-made records of one port, right and wrong: each rule of PortChecker must be able to fail.
//
// 1 Gb/s: an octet lasts 8 ns. A frame of 100 octets occupies (8 + 100 + 12) * 8 ns = 960 ns, its last bit leaves after
// 864 ns.
#include <gtest/gtest.h>

#include "tests/wire_checker/port_record.hpp"

namespace takt::wire_checker {
namespace {

#define EXPECT_FOUND(found, what) EXPECT_NE((found).find(what), std::string::npos) << (found)
#define EXPECT_NOTHING(found) EXPECT_EQ(found, "")

models::GateControlEntry entry(models::GateStates states, Ps interval, models::GateOperation operation = {}) {
  return {operation, states, sim::Duration::from_ps(interval)};
}
models::GateConfig list(std::vector<models::GateControlEntry> entries) {
  models::GateConfig gates;
  for (const models::GateControlEntry& one : entries) gates.admin_cycle_time += one.interval;
  gates.admin_control_list = std::move(entries);
  return gates;
}
PortConfig with_gates(std::vector<models::GateControlEntry> entries) {
  PortConfig config;
  config.shaping.gates = list(std::move(entries));
  return config;
}
PortConfig with_preemption(models::ClassSet preemptable = 0x01) {
  PortConfig config;
  config.preemption = models::PreemptionConfig{preemptable, models::AddFragSize(0), std::nullopt, {}};
  return config;
}

TEST(PortRules, OneFrameAfterTheOther) {
  EXPECT_NOTHING(Port().frame('a', 0).frame('b', 0).at(0).start('a').at(960 * ns).start('b').until(5'000 * ns));
  EXPECT_FOUND(Port().frame('a', 0).frame('b', 0).at(0).start('a').at(800 * ns).start('b').until(5'000 * ns),
               "before the medium is free");
  EXPECT_FOUND(Port().frame('a', 0).frame('b', 0).at(0).start('a').at(959'999).start('b').until(5'000 * ns),
               "starts 1 ps before the medium is free");
}

TEST(PortRules, TheRightClassAndLength) {
  EXPECT_FOUND(Port().frame('a', 3).at(0).start_as('a', 2).until(1'000 * ns), "starts in class 2 instead of 3");
  PortConfig config;
  config.shaping.queue_max_sdu[3] = models::Octets{77};
  EXPECT_FOUND(Port(config).frame('a', 3).at(0).start('a').until(1'000 * ns), "longer than queueMaxSDU");
  config.shaping.queue_max_sdu[3] = models::Octets{78};
  EXPECT_NOTHING(Port(config).frame('a', 3).at(0).start('a').until(1'000 * ns));
}

TEST(PortRules, GatesOpenBeforeAndCloseAfter) {
  const PortConfig config = with_gates({entry(0x02, 10'000 * ns), entry(0x01, 10'000 * ns)});
  EXPECT_NOTHING(Port(config).frame('a', 1).at(9'136 * ns).start('a').until(11'000 * ns));  // 10'000 - 864
  EXPECT_FOUND(Port(config).frame('a', 1).at(9'136'001).start('a').until(11'000 * ns),
               "does not end before its gate closes");
  EXPECT_FOUND(Port(config).frame('a', 1).at(10'000 * ns).start('a').until(11'000 * ns),
               "starts while its gate is closed");
  EXPECT_NOTHING(Port(config).frame('a', 1).at(20'000 * ns).start('a').until(21'000 * ns));
  EXPECT_FOUND(Port(config).frame('a', 0).at(0).start('a').until(1'000 * ns), "starts while its gate is closed");
}

TEST(PortRules, GatesChangeAndBreak) {
  const auto closed_later = list({entry(0xFF, 10'000 * ns), entry(0x00, 10'000 * ns)});
  EXPECT_NOTHING(Port().frame('a', 1).at(1'000 * ns).gates(closed_later).at(25'000 * ns).start('a').until(26'000 * ns));
  EXPECT_FOUND(Port().frame('a', 1).at(1'000 * ns).gates(closed_later).at(35'000 * ns).start('a').until(36'000 * ns),
               "starts while its gate is closed");
  EXPECT_FOUND(Port().frame('a', 1).at(1'000 * ns).stuck(1, false).at(2'000 * ns).start('a').until(3'000 * ns),
               "starts while its gate is closed");
  EXPECT_NOTHING(Port(with_gates({entry(0x00, 10'000 * ns)}))
                     .frame('a', 1)
                     .at(1'000 * ns)
                     .stuck(1, true)
                     .start('a')
                     .until(3'000 * ns));
  EXPECT_NOTHING(Port()
                     .frame('a', 1)
                     .at(0)
                     .stuck(1, false)
                     .at(1'000 * ns)
                     .wait('a')
                     .at(2'000 * ns)
                     .stuck(1, std::nullopt)
                     .leave('a')
                     .start('a')
                     .until(3'000 * ns));
  EXPECT_FOUND(Port().frame('a', 1).at(0).up(false).at(1'000 * ns).start('a').until(3'000 * ns), "link that is down");
}

TEST(PortRules, TheMostUrgentGoesFirst) {
  Port fine;
  fine.frame('a', 0)
      .frame('b', 5)
      .frame('c', 2)
      .at(0)
      .start('a')
      .at(100 * ns)
      .wait('c')
      .at(200 * ns)
      .wait('b')
      .at(960 * ns)
      .leave('b')
      .start('b')
      .at(1'920 * ns)
      .leave('c')
      .start('c');
  EXPECT_NOTHING(fine.until(5'000 * ns));
  Port wrong;
  wrong.frame('a', 0)
      .frame('b', 5)
      .frame('c', 2)
      .at(0)
      .start('a')
      .at(100 * ns)
      .wait('c')
      .at(200 * ns)
      .wait('b')
      .at(960 * ns)
      .leave('c')
      .start('c')
      .at(1'920 * ns)
      .leave('b')
      .start('b');
  EXPECT_FOUND(wrong.until(5'000 * ns), "of class 2 starts although stream 0 frame 1 of class 5 is ready");
  // Both come at one instant.
  EXPECT_FOUND(Port().frame('a', 0).frame('b', 5).at(0).start('a').wait('b').at(960 * ns).leave('b').start('b').until(
                   2'000 * ns),
               "has to wait for stream 0 frame 0 of class 0");
  EXPECT_NOTHING(Port().frame('a', 0).frame('b', 5).at(0).start('b').wait('a').at(960 * ns).leave('a').start('a').until(
      2'000 * ns));
}

TEST(PortRules, FirstInFirstOut) {
  EXPECT_FOUND(Port()
                   .frame('a', 0)
                   .frame('b', 0)
                   .frame('c', 0)
                   .at(0)
                   .start('a')
                   .at(1 * ns)
                   .wait('b')
                   .at(2 * ns)
                   .wait('c')
                   .at(960 * ns)
                   .leave('c')
                   .start('c')
                   .until(1'000 * ns),
               "leaves its queue before");
  EXPECT_FOUND(Port()
                   .frame('a', 0)
                   .frame('b', 0)
                   .frame('c', 0)
                   .at(0)
                   .start('a')
                   .at(1 * ns)
                   .wait('b')
                   .at(960 * ns)
                   .start('c')
                   .until(1'000 * ns),
               "starts before frames of its class that came earlier");
  EXPECT_FOUND(Port().frame('a', 0).at(0).leave('a').until(0), "leaves a queue in which it is not");
  EXPECT_FOUND(Port().frame('a', 0).frame('b', 0).at(0).start('a').wait('b').at(960 * ns).leave('b').until(960 * ns),
               "left its queue without a start or a drop");
}

TEST(PortRules, NothingWaitsInVain) {
  EXPECT_FOUND(Port().frame('a', 0).at(0).wait('a').until(10 * ns), "the medium is idle although a frame may start");
  EXPECT_FOUND(Port().frame('a', 0).frame('b', 0).at(0).start('a').wait('b').at(961 * ns).leave('b').start('b').until(
                   2'000 * ns),
               "the medium is idle although a frame may start");
  const PortConfig config = with_gates({entry(0x02, 10'000 * ns), entry(0x01, 10'000 * ns)});
  EXPECT_NOTHING(Port(config).frame('a', 0).at(0).wait('a').at(10'000 * ns).leave('a').start('a').until(12'000 * ns));
  EXPECT_FOUND(Port(config).frame('a', 0).at(0).wait('a').at(10'001 * ns).leave('a').start('a').until(12'000 * ns),
               "10000000 ps, port: the medium is idle");
  EXPECT_FOUND(Port(config).frame('a', 0).at(0).wait('a').until(12'000 * ns), "the medium is idle");
}

// 3 us of a cycle of 10 are over, and 2 of them were open.
TEST(PortRules, ListsThatAreRunning) {
  PortConfig config = with_gates({entry(0xFF, 2'000 * ns), entry(0x00, 8'000 * ns)});
  config.shaping.gates->admin_base_time = sim::LocalTime::from_ps(-3'000 * ns);
  EXPECT_NOTHING(Port(config).frame('a', 0).at(0).start('a').until(900 * ns));
  config.shaping.gates->is_running = true;
  EXPECT_FOUND(Port(config).frame('a', 0).at(0).start('a').until(900 * ns), "starts while its gate is closed");
  EXPECT_NOTHING(Port(config).frame('a', 0).at(0).wait('a').at(7'000 * ns).leave('a').start('a').until(9'000 * ns));
  config.shaping.gates->admin_base_time = sim::LocalTime::from_ps(-10'003'000 * ns);
  EXPECT_NOTHING(Port(config).frame('a', 0).at(0).wait('a').at(7'000 * ns).leave('a').start('a').until(9'000 * ns));
}

TEST(PortRules, QueuesHaveLimits) {
  PortConfig config;
  config.queue_limits[0] = {2, 250};
  EXPECT_NOTHING(
      Port(config).frame('a', 0).frame('b', 0).frame('c', 0).at(0).start('a').wait('b').wait('c').until(900 * ns));
  EXPECT_FOUND(
      Port(config).frame('a', 0).frame('b', 0).frame('c', 0, 151).at(0).start('a').wait('b').wait('c').until(900 * ns),
      "is one too many: 2 frames, 251 octets");
  EXPECT_FOUND(Port(config)
                   .frame('a', 0)
                   .frame('b', 0, 64)
                   .frame('c', 0, 64)
                   .frame('d', 0, 64)
                   .at(0)
                   .start('a')
                   .wait('b')
                   .wait('c')
                   .wait('d')
                   .until(900 * ns),
               "is one too many: 3 frames");
}

TEST(PortRules, WhichFrameAFullQueueLoses) {
  using enum models::DropReason;
  PortConfig config;
  config.queue_limits[0] = {2, 250};
  const auto three = [](const PortConfig& with) {
    return Port(with).frame('a', 0).frame('b', 0).frame('c', 0).frame('d', 0).at(0).start('a').wait('b');
  };
  EXPECT_NOTHING(three(config).wait('c').refuse('d', queue_frames).until(900 * ns));
  EXPECT_FOUND(three(config).wait('c').refuse('d', queue_octets).until(900 * ns),
               "for want of room in class 0, where there is room");
  EXPECT_FOUND(three(config).refuse('d', queue_frames).until(900 * ns),
               "for want of room in class 0, where there is room");
  EXPECT_FOUND(three(config).wait('c').leave('b').drop('b', queue_frames).wait('d').until(900 * ns),
               "although it is not the newest");
  config.queue_limits[0].drops_oldest = true;
  EXPECT_NOTHING(three(config).wait('c').leave('b').drop('b', queue_frames).wait('d').until(900 * ns));
  EXPECT_FOUND(three(config).wait('c').refuse('d', queue_frames).until(900 * ns),
               "is dropped although older ones should be");
  EXPECT_FOUND(three(config).leave('b').drop('b', queue_frames).wait('d').until(900 * ns), "for which there was room");
  EXPECT_FOUND(three(config).wait('c').leave('b').drop('b', queue_frames).until(900 * ns), "was dropped for no frame");
  EXPECT_FOUND(three(config).wait('c').leave('c').drop('c', queue_frames).wait('d').until(900 * ns),
               "leaves its queue before");
}

TEST(PortRules, EligibilityTimes) {
  PortConfig config;
  config.shaping.selection[5] = models::TimeBased{};
  EXPECT_NOTHING(
      Port(config).frame('a', 5, 100, 500 * ns).at(0).wait('a').at(500 * ns).leave('a').start('a').until(2'000 * ns));
  EXPECT_FOUND(
      Port(config).frame('a', 5, 100, 500 * ns).at(0).wait('a').at(499 * ns).leave('a').start('a').until(2'000 * ns),
      "before its eligibility time");
  EXPECT_FOUND(
      Port(config).frame('a', 5, 100, 500 * ns).at(0).wait('a').at(501 * ns).leave('a').start('a').until(2'000 * ns),
      "the medium is idle");
  // The order is that of the times.
  EXPECT_FOUND(Port(config)
                   .frame('a', 5, 100, 500 * ns)
                   .frame('b', 5, 100, 400 * ns)
                   .at(0)
                   .wait('a')
                   .wait('b')
                   .at(500 * ns)
                   .leave('a')
                   .start('a')
                   .until(2'000 * ns),
               "leaves its queue before");
}

// Frames of 100 octets occupy 120, 960 ns. Class 2 has 75 of them after a round and 150 after the second, when class 1
// has 25: so class 2 goes first, and then, with 30 left, once more before class 1.
TEST(PortRules, ClassesThatShareTakeTurns) {
  PortConfig config;
  config.shaping.selection[2] = models::EnhancedTransmissionSelection{75};
  config.shaping.selection[1] = models::EnhancedTransmissionSelection{25};
  const auto port = [&] {
    return Port(config)
        .frame('a', 7)
        .frame('b', 2)
        .frame('c', 2)
        .frame('x', 1)
        .frame('y', 0)
        .at(0)
        .start('a')
        .wait('b')
        .wait('c')
        .wait('x');
  };
  EXPECT_NOTHING(port()
                     .at(960 * ns)
                     .leave('b')
                     .start('b')
                     .at(1'920 * ns)
                     .leave('c')
                     .start('c')
                     .at(2'880 * ns)
                     .leave('x')
                     .start('x')
                     .until(9'000 * ns));
  EXPECT_FOUND(port().at(960 * ns).leave('x').start('x').until(1'000 * ns),
               "of class 1 starts although it is the turn of class 2");
  EXPECT_FOUND(port().at(960 * ns).leave('b').start('b').at(1'920 * ns).leave('x').start('x').until(2'000 * ns),
               "of class 1 starts although it is the turn of class 2");
  // A class without a share goes before them.
  EXPECT_FOUND(port().wait('y').at(960 * ns).leave('b').start('b').until(1'000 * ns), "of class 0 is ready");
  // Those that come in the instant count, too.
  EXPECT_NOTHING(
      Port(config).frame('x', 1).frame('b', 2).at(0).start('b').wait('x').at(960 * ns).leave('x').start('x').until(
          9'000 * ns));
  EXPECT_FOUND(Port(config).frame('x', 1).frame('b', 2).at(0).start('x').wait('b').until(900 * ns),
               "although it is the turn of class 2");
}

// A frame of 1000 octets in class 0, which may be cut; an express one comes. 60 octets of data are the least: 8 + 60
// octets = 544 ns.
TEST(PortRules, CutsAreLegal) {
  const auto port = [] { return Port(with_preemption()).frame('a', 0, 1'000).frame('x', 7).frame('b', 0); };
  // At 80 ns it goes on to 60 octets; mCRC and gap: free at (8 + 60 + 4 + 12) * 8 = 672 ns. The express frame occupies
  // 960 ns.
  EXPECT_NOTHING(port()
                     .at(0)
                     .start('a')
                     .at(80 * ns)
                     .cut('a', 60)
                     .wait('x')
                     .at(672 * ns)
                     .leave('x')
                     .start('x')
                     .at(1'632 * ns)
                     .resume('a', 940)
                     .until(9'000 * ns));
  EXPECT_FOUND(port().at(0).start('a').at(80 * ns).cut('a', 59).wait('x').until(100 * ns),
               "is cut after 59 octets instead of 60");
  EXPECT_FOUND(
      port().at(0).start('a').at(80 * ns).cut('a', 60).wait('x').at(600 * ns).leave('x').start('x').until(700 * ns),
      "before the medium is free");
  EXPECT_FOUND(port().at(0).start('a').at(80 * ns).cut('a', 60).until(100 * ns), "although no express frame waits");
  EXPECT_FOUND(port()
                   .at(0)
                   .start('a')
                   .at(80 * ns)
                   .cut('a', 60)
                   .wait('x')
                   .at(672 * ns)
                   .leave('x')
                   .start('x')
                   .at(1'632 * ns)
                   .resume('a', 1'000)
                   .until(1'700 * ns),
               "goes on with 1000 octets instead of 940");
  EXPECT_FOUND(port()
                   .at(0)
                   .start('a')
                   .at(80 * ns)
                   .cut('a', 60)
                   .wait('x')
                   .at(672 * ns)
                   .leave('x')
                   .start('x')
                   .at(1'632 * ns)
                   .start('b')
                   .until(1'700 * ns),
               "before the rest of stream 0 frame 0");
  EXPECT_FOUND(
      port().at(0).start('a').at(80 * ns).cut('a', 60).wait('x').at(672 * ns).resume('a', 940).until(1'700 * ns),
      "although an express frame of class 7 is ready");
  EXPECT_FOUND(port()
                   .at(0)
                   .start('a')
                   .at(80 * ns)
                   .cut('a', 60)
                   .wait('x')
                   .at(672 * ns)
                   .leave('x')
                   .start('x')
                   .at(1'640 * ns)
                   .resume('a', 940)
                   .until(1'700 * ns),
               "the medium is idle");
  EXPECT_FOUND(port().at(0).start('x').at(80 * ns).cut('x', 60).until(100 * ns), "not a preemptable frame under way");
  EXPECT_FOUND(port().at(0).resume('a', 940).until(100 * ns), "goes on although it has not been cut");
  // 936 octets are out at 8 * 944 ns: 64 remain, one more would be too late.
  EXPECT_NOTHING(port().at(0).start('a').at(7'552 * ns).cut('a', 936).wait('x').until(7'600 * ns));
  EXPECT_FOUND(port().at(0).start('a').at(7'553 * ns).cut('a', 937).wait('x').until(7'600 * ns),
               "too little would be left");
}

TEST(PortRules, ExpressFramesDoNotWaitForLong) {
  const auto port = [] { return Port(with_preemption()).frame('a', 0, 1'000).frame('x', 7); };
  EXPECT_FOUND(port().at(0).start('a').at(80 * ns).wait('x').until(100 * ns),
               "a preemptable frame goes on although an express frame is ready");
  // Its gate opens at 2 us, in the middle of the preemptable frame.
  PortConfig config = with_preemption();
  config.shaping.gates = list({entry(0x01, 2'000 * ns), entry(0xFF, 98'000 * ns)});
  EXPECT_FOUND(Port(config).frame('a', 0, 1'000).frame('x', 7).at(0).start('a').wait('x').until(8'000 * ns),
               "2000000 ps, port: a preemptable frame goes on");
  // Out at 2 us: 250 octets, 8 of them preamble.
  EXPECT_NOTHING(Port(config)
                     .frame('a', 0, 1'000)
                     .frame('x', 7)
                     .at(0)
                     .start('a')
                     .wait('x')
                     .at(2'000 * ns)
                     .cut('a', 242)
                     .until(2'100 * ns));
}

// From 50 us on the MAC holds, and is asked to 143 octets = 1144 ns before.
TEST(PortRules, TheMacHolds) {
  PortConfig config = with_preemption();
  config.shaping.gates = list({entry(0xFF, 50'000 * ns, models::GateOperation::set_and_release_mac),
                               entry(0xFF, 50'000 * ns, models::GateOperation::set_and_hold_mac)});
  const auto port = [&] { return Port(config).frame('a', 0, 1'000).frame('b', 0, 123); };
  EXPECT_NOTHING(port().at(48'855 * ns).start('b').until(52'000 * ns));
  EXPECT_FOUND(port().at(48'856 * ns).start('b').until(52'000 * ns), "starts while the MAC holds");
  EXPECT_FOUND(port().at(70'000 * ns).start('b').until(72'000 * ns), "starts while the MAC holds");
  EXPECT_FOUND(port().at(48'000 * ns).start('a').until(57'000 * ns), "48856000 ps, port: a preemptable frame goes on");
  // 856 ns: 107 octets, 99 of them data.
  EXPECT_NOTHING(port().at(48'000 * ns).start('a').at(48'856 * ns).cut('a', 99).until(99'000 * ns));
  EXPECT_NOTHING(port()
                     .at(48'000 * ns)
                     .start('a')
                     .at(48'856 * ns)
                     .cut('a', 99)
                     .at(100'000 * ns)
                     .resume('a', 901)
                     .until(110'000 * ns));
  EXPECT_FOUND(port().at(48'000 * ns).start('a').at(48'856 * ns).cut('a', 99).until(110'000 * ns),
               "100000000 ps, port: the medium is idle");
}

// 250 Mb/s of 1 Gb/s: a frame of 100 octets costs 960 ns * 750 Mb/s = 720 bit, which take 720 / 250M = 2880 ns to come
// back.
TEST(PortRules, Credits) {
  PortConfig config;
  config.shaping.selection[5] = models::CreditBased{sim::DataRate{250'000'000}, false};
  const auto port = [&] { return Port(config).frame('a', 5).frame('b', 5).frame('c', 0, 1'500); };
  EXPECT_NOTHING(port().at(0).start('a').wait('b').at(3'840 * ns).leave('b').start('b').until(9'000 * ns));
  EXPECT_FOUND(port().at(0).start('a').wait('b').at(3'839'999).leave('b').start('b').until(9'000 * ns),
               "negative credit");
  EXPECT_FOUND(port().at(0).start('a').wait('b').at(3'841 * ns).leave('b').start('b').until(9'000 * ns),
               "the medium is idle");
  // A lower frame may go in between, and credit grows meanwhile beyond 0.
  EXPECT_NOTHING(port()
                     .at(0)
                     .start('a')
                     .wait('b')
                     .at(960 * ns)
                     .start('c')
                     .at(13'120 * ns)
                     .leave('b')
                     .start('b')
                     .until(20'000 * ns));
  // An empty queue loses its credit.
  EXPECT_NOTHING(port().at(0).start('a').at(20'000 * ns).start('b').at(20'960 * ns).start('c').until(30'000 * ns));
}

/// Classes 2 and 5 are cut through; class 3 is closed for ever.
PortConfig cutting() {
  PortConfig config;
  config.cut_through = 1u << 2 | 1u << 5;
  config.shaping.admin_gate_states = 0xF7;
  return config;
}

TEST(PortRules, CutThroughStartsWhereNothingElseMay) {
  const auto port = [] { return Port(cutting()).frame('a', 2).frame('b', 1).frame('c', 3).frame('d', 5); };
  EXPECT_NOTHING(port().at(0).start_early('a').until(9'000 * ns));
  EXPECT_NOTHING(port().at(0).wait('c').at(5 * ns).start_early('a').until(9'000 * ns));
  EXPECT_FOUND(port().at(0).start_early('a').wait('b').at(960 * ns).leave('b').start('b').until(9'000 * ns),
               "which is cut through");
  EXPECT_FOUND(port()
                   .at(0)
                   .start('d')
                   .wait('b')
                   .at(960 * ns)
                   .start_early('a')
                   .at(1'920 * ns)
                   .leave('b')
                   .start('b')
                   .until(9'000 * ns),
               "is cut through although");
}

TEST(PortRules, WhatCouldBeCutThrough) {
  const auto port = [] { return Port(cutting()).frame('a', 2).frame('b', 1).frame('c', 3).frame('d', 2); };
  EXPECT_TRUE(port().at(0).could_cut_through('a'));
  EXPECT_TRUE(port().at(0).wait('c').could_cut_through('a'));  // its gate is closed
  EXPECT_FALSE(port().at(0).could_cut_through('b'));           // its class is not cut through
  EXPECT_FALSE(port().at(0).start('b').could_cut_through('a'));
  EXPECT_FALSE(port().at(0).start('b').at(959 * ns).could_cut_through('a'));
  EXPECT_TRUE(port().at(0).start('b').at(960 * ns).could_cut_through('a'));
  EXPECT_FALSE(port().at(0).start('b').wait('d').at(1 * ns).could_cut_through('a'));
  EXPECT_FALSE(port().at(0).up(false).could_cut_through('a'));
  EXPECT_FALSE(port().at(0).stuck(2, false).could_cut_through('a'));
}

}  // namespace
}  // namespace takt::wire_checker
