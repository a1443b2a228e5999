// SPDX-License-Identifier: Apache-2.0
// The ingress chain of a bridge: each function by itself, several together, what is counted and where frames end.
#include "models/ingress/ingress_pipeline.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "models/ethernet/sizes.hpp"

namespace takt::models {
namespace {

using namespace sim::literals;
using sim::Duration;
using sim::LocalTime;
using sim::TrueTime;

constexpr std::uint32_t nodes = 10;  // addresses below are those of nodes
constexpr AddressIndex group{11};
constexpr AddressIndex member_a{21};
constexpr AddressIndex member_b{22};

/// A pipeline alone: frames are handed in at instants, and what comes out is looked at.
class Bench {
 public:
  explicit Bench(IngressConfig config, Duration forwarding_delay = {})
      : config_(std::move(config)), pipeline_(traffic, config_, clock_, sim::ComponentId{0}, nodes, forwarding_delay) {
    Stream stream;
    stream.source = AddressIndex{1};
    stream.destination = group;
    stream.tagged = true;
    stream.priority = 5;
    index = traffic.add_stream(std::move(stream));
  }

  /// A frame with that payload whose last bit came then; null if it was dropped.
  const Frame* pass(Duration when, std::uint32_t payload = 100, std::uint16_t port = 0) {
    const auto frames = pass_frame(make(payload), when, port);
    return frames.empty() ? nullptr : &traffic.frame(frames.front());
  }
  FrameIndex make(std::uint32_t payload = 100) { return traffic.produce(index, Octets{payload}, TrueTime()); }
  /// A member's frame with that number.
  FrameIndex make_member(AddressIndex member, SequenceNumber number, std::uint32_t payload = 100) {
    const FrameIndex frame = make(payload);
    traffic.frame(frame).destination = member;
    traffic.frame(frame).r_tag_sequence = number;
    traffic.set_tags(frame, true, true);
    return frame;
  }
  std::vector<FrameIndex> pass_frame(FrameIndex frame, Duration when, std::uint16_t port = 0) {
    const auto frames = pipeline_.pass(simulation, {frame, port, TrueTime() + when});
    return {frames.begin(), frames.end()};
  }
  std::uint64_t dropped(DropReason reason) const {
    return traffic.stream(index).dropped[static_cast<std::size_t>(reason)];
  }
  IngressPipeline& pipeline() { return pipeline_; }

  sim::Simulation simulation{1};
  Traffic traffic;
  StreamIndex index;

 private:
  IngressConfig config_;
  LocalClock clock_;
  IngressPipeline pipeline_;
};

/// One stream, identified by the group address, and one filter for it.
IngressConfig one_filter(StreamFilterConfig filter = {}) {
  IngressConfig config;
  config.streams = {"s"};
  config.stream_identity_table = {{StreamHandle{0}, AddressIdentification{group}}};
  filter.stream_handle = StreamHandle{0};
  config.stream_filters = {filter};
  return config;
}

StreamGateConfig gate(std::vector<StreamGateEntry> entries, Duration cycle) {
  StreamGateConfig config;
  config.admin_control_list = std::move(entries);
  config.admin_cycle_time = cycle;
  return config;
}

TEST(IngressPipeline, FramesOfNoStreamPassUntouched) {
  Bench bench{IngressConfig{}};
  const FrameIndex frame = bench.make();
  EXPECT_EQ(bench.pass_frame(frame, 1_us), std::vector{frame});
  EXPECT_FALSE(bench.traffic.frame(frame).marked);
  EXPECT_EQ(bench.pipeline().unidentified_frames(), 1u);
}

TEST(IngressPipeline, TheFirstFilterThatMatchesIsTheFrames) {
  IngressConfig config = one_filter();
  config.stream_filters[0].priority = 4;  // not this frame's
  config.stream_filters.push_back({});    // any stream, any priority
  config.stream_filters.back().maximum_sdu_size = Octets{100};
  config.stream_filters.push_back({});
  Bench bench{std::move(config)};
  EXPECT_NE(bench.pass(1_us, 100), nullptr);
  EXPECT_EQ(bench.pass(2_us, 101), nullptr);
  const StreamFilterTable& filters = bench.pipeline().stream_filters();
  EXPECT_EQ(filters[StreamFilterIndex{0}].counters(), StreamFilterCounters{});
  EXPECT_EQ(filters[StreamFilterIndex{1}].counters(), (StreamFilterCounters{2, 1, 0, 1, 1, 0}));
  EXPECT_EQ(filters[StreamFilterIndex{2}].counters(), StreamFilterCounters{});
  EXPECT_EQ(bench.dropped(DropReason::stream_max_sdu), 1u);
}

TEST(IngressPipeline, AnOversizeFrameBlocksItsStreamUntilManagementClears) {
  StreamFilterConfig filter;
  filter.maximum_sdu_size = Octets{100};
  filter.stream_blocked_due_to_oversize_frame_enable = true;
  Bench bench{one_filter(filter)};
  EXPECT_NE(bench.pass(1_us, 100), nullptr);
  EXPECT_EQ(bench.pass(2_us, 101), nullptr);
  EXPECT_EQ(bench.pass(3_us, 50), nullptr);
  bench.pipeline().stream_filters()[StreamFilterIndex{0}].clear_stream_blocked_due_to_oversize_frame();
  EXPECT_NE(bench.pass(4_us, 50), nullptr);
  EXPECT_EQ(bench.dropped(DropReason::stream_max_sdu), 2u);
}

// An R-TAG that stays on is part of the MSDU: 6 octets more.
TEST(IngressPipeline, AnRTagCountsInTheSdu) {
  StreamFilterConfig filter;
  filter.maximum_sdu_size = Octets{105};
  Bench bench{one_filter(filter)};
  EXPECT_NE(bench.pass(1_us, 105), nullptr);
  EXPECT_TRUE(bench.pass_frame(bench.make_member(group, 0, 100), 2_us).empty());
  EXPECT_EQ(bench.pass_frame(bench.make_member(group, 0, 99), 3_us).size(), 1u);
}

// Open for 10 us with internal priority 7, then for 10 us with the frame's own, then closed for 30 us.
TEST(IngressPipeline, AStreamGateGivesTheQueueOrTakesTheFrame) {
  IngressConfig config = one_filter({std::nullopt, std::nullopt, Octets{0}, false, StreamGateIndex{0}, {}, {}});
  config.stream_gates = {gate({{true, Priority{7}, 10_us, std::nullopt},
                               {true, std::nullopt, 10_us, std::nullopt},
                               {false, std::nullopt, 30_us, std::nullopt}},
                              50_us)};
  Bench bench{std::move(config)};
  const Frame* const first = bench.pass(50_us);
  ASSERT_NE(first, nullptr);
  EXPECT_TRUE(first->marked);
  EXPECT_EQ(first->queue_priority, 7);
  EXPECT_EQ(first->priority, 5);
  EXPECT_EQ(first->eligible, LocalTime() + 50_us);
  const Frame* const second = bench.pass(60_us);
  ASSERT_NE(second, nullptr);
  EXPECT_FALSE(second->marked);
  EXPECT_EQ(second->queue_priority, 5);
  EXPECT_EQ(bench.pass(70_us), nullptr);
  EXPECT_EQ(bench.pass(99'999_ns), nullptr);
  EXPECT_NE(bench.pass(100_us), nullptr);
  EXPECT_EQ(bench.dropped(DropReason::stream_gate), 2u);
  EXPECT_EQ(bench.pipeline().stream_gates()[0].counters(), (StreamGate::Counters{3, 2, 0}));
  EXPECT_EQ(bench.pipeline().stream_filters()[StreamFilterIndex{0}].counters(),
            (StreamFilterCounters{5, 3, 2, 5, 0, 0}));
}

TEST(IngressPipeline, AGateClosesForGoodAfterInvalidReception) {
  IngressConfig config = one_filter({std::nullopt, std::nullopt, Octets{0}, false, StreamGateIndex{0}, {}, {}});
  config.stream_gates = {
      gate({{true, std::nullopt, 10_us, std::nullopt}, {false, std::nullopt, 10_us, std::nullopt}}, 20_us)};
  config.stream_gates[0].closed_due_to_invalid_rx_enable = true;
  Bench bench{std::move(config)};
  EXPECT_NE(bench.pass(0_us), nullptr);
  EXPECT_EQ(bench.pass(15_us), nullptr);
  EXPECT_EQ(bench.pass(20_us), nullptr);
  EXPECT_TRUE(bench.pipeline().stream_gates()[0].closed_due_to_invalid_rx());
  bench.pipeline().stream_gates()[0].clear_closed_due_to_invalid_rx();
  EXPECT_NE(bench.pass(25_us), nullptr);
}

// 250 octets an interval: two frames of 100 pass, the third is beyond and closes the gate for good.
TEST(IngressPipeline, AGateClosesForGoodBeyondItsOctets) {
  IngressConfig config = one_filter({std::nullopt, std::nullopt, Octets{0}, false, StreamGateIndex{0}, {}, {}});
  config.stream_gates = {gate({{true, std::nullopt, 10_us, 250u}}, 10_us)};
  Bench lenient{config};
  for (int i = 0; i < 3; ++i) EXPECT_EQ(lenient.pass(1_us) != nullptr, i < 2);
  EXPECT_NE(lenient.pass(10_us), nullptr);
  EXPECT_EQ(lenient.pipeline().stream_gates()[0].counters(), (StreamGate::Counters{3, 0, 1}));
  config.stream_gates[0].closed_due_to_octets_exceeded_enable = true;
  Bench strict{config};
  for (int i = 0; i < 3; ++i) EXPECT_EQ(strict.pass(1_us) != nullptr, i < 2);
  EXPECT_EQ(strict.pass(10_us), nullptr);
  EXPECT_EQ(strict.pipeline().stream_gates()[0].counters(), (StreamGate::Counters{2, 1, 1}));
}

// 122 octets from DA to FCS. A committed burst of 122 lets one pass green, an excess burst of 122 another one yellow,
// the third is red. 8 Mb/s bring one octet a microsecond: 122 us later one passes green again.
TEST(IngressPipeline, AMeterColours) {
  IngressConfig config = one_filter({std::nullopt, std::nullopt, Octets{0}, false, {}, FlowMeterIndex{0}, {}});
  config.flow_meters.push_back({"m", {{8'000'000}, Octets{122}, {0}, Octets{122}}});
  Bench bench{std::move(config)};
  const Frame* const green = bench.pass(0_us);
  ASSERT_NE(green, nullptr);
  EXPECT_FALSE(green->drop_eligible);
  const Frame* const yellow = bench.pass(0_us);
  ASSERT_NE(yellow, nullptr);
  EXPECT_TRUE(yellow->drop_eligible);
  EXPECT_FALSE(yellow->marked);
  EXPECT_EQ(bench.pass(121'999_ns), nullptr);
  EXPECT_NE(bench.pass(122_us), nullptr);
  const IngressPipeline::Meter& meter = bench.pipeline().flow_meters()[0];
  EXPECT_EQ(meter.frames, (std::array<std::uint64_t, 3>{2, 1, 1}));
  EXPECT_EQ(meter.discarded, 1u);
  EXPECT_EQ(bench.dropped(DropReason::flow_meter), 1u);
  EXPECT_EQ(bench.pipeline().stream_filters()[StreamFilterIndex{0}].counters().red_frames, 1u);
}

IngressConfig ats(Duration maximum_residence_time = Duration::max(), std::uint32_t schedulers = 1) {
  IngressConfig config = one_filter({std::nullopt, std::nullopt, Octets{0}, false, {}, {}, AtsSchedulerIndex{0}});
  for (std::uint32_t i = 0; i < schedulers; ++i)
    config.ats_schedulers.push_back({"a", {8'000'000}, Octets{142}, true, {}});
  config.maximum_residence_time = maximum_residence_time;
  return config;
}

// 122 octets and 20 of media overhead at one octet a microsecond: a burst of three is spread over 284 us.
TEST(IngressPipeline, AnAtsSchedulerSpreadsABurst) {
  Bench bench{ats()};
  for (const Duration eligible : {10_us, 152_us, 294_us}) {
    const Frame* const frame = bench.pass(10_us);
    ASSERT_NE(frame, nullptr);
    EXPECT_TRUE(frame->marked);
    EXPECT_EQ(frame->queue_priority, 5);
    EXPECT_EQ(frame->eligible, LocalTime() + eligible);
  }
  EXPECT_EQ(bench.pipeline().ats_schedulers()[0].passed, 3u);
  EXPECT_EQ(bench.pipeline().ats_schedulers()[0].longest_hold, 284_us);
}

// A frame may be selected no earlier than its forwarding delay after its eligibility time, however long the delay is:
// the distances are those of the bucket. The hold is the same, and so is what stays too long.
TEST(IngressPipeline, TheForwardingDelayComesAfterTheEligibilityTime) {
  for (const Duration delay : {0_us, 3_us, 500_us}) {
    Bench bench{ats(200_us), delay};
    for (const Duration eligible : {10_us, 152_us}) {
      const Frame* const frame = bench.pass(10_us);
      ASSERT_NE(frame, nullptr);
      EXPECT_EQ(frame->eligible, LocalTime() + eligible + delay);
    }
    EXPECT_EQ(bench.pass(10_us), nullptr);
    EXPECT_EQ(bench.pipeline().ats_schedulers()[0].longest_hold, 142_us);
  }
}

TEST(IngressPipeline, AtsDropsWhatWouldStayTooLong) {
  Bench bench{ats(200_us)};
  EXPECT_NE(bench.pass(10_us), nullptr);
  EXPECT_NE(bench.pass(10_us), nullptr);
  EXPECT_EQ(bench.pass(10_us), nullptr);
  EXPECT_EQ(bench.dropped(DropReason::residence_time), 1u);
  EXPECT_EQ(bench.pipeline().ats_schedulers()[0].discarded, 1u);
}

// Two schedulers, each with a full bucket. Frames of one reception port and class stay in order, so the second
// scheduler's frame waits for the first one's; at another port it does not, nor does it in another class.
TEST(IngressPipeline, AtsGroupsKeepOrderWithinPortAndClass) {
  IngressConfig config = ats(Duration::max(), 2);
  config.streams.push_back("t");
  config.stream_identity_table.insert(config.stream_identity_table.begin(),
                                      {StreamHandle{1}, AddressIdentification{member_a}});
  config.stream_filters.push_back({StreamHandle{1}, std::nullopt, Octets{0}, false, {}, {}, AtsSchedulerIndex{1}});
  const auto second_scheduler_after_two_of_the_first = [&](std::uint16_t port, Priority priority) {
    Bench bench{config};
    bench.pass(10_us);
    bench.pass(10_us);
    const FrameIndex other = bench.make();
    bench.traffic.frame(other).destination = member_a;
    bench.traffic.frame(other).priority = priority;
    return bench.traffic.frame(bench.pass_frame(other, 10_us, port).at(0)).eligible;
  };
  EXPECT_EQ(second_scheduler_after_two_of_the_first(0, 5), LocalTime() + 152_us);
  EXPECT_EQ(second_scheduler_after_two_of_the_first(1, 5), LocalTime() + 10_us);
  EXPECT_EQ(second_scheduler_after_two_of_the_first(0, 4), LocalTime() + 10_us);
  config.ats_groups = {{"g", Duration::max()}};
  for (AtsSchedulerConfig& scheduler : config.ats_schedulers) scheduler.group = AtsGroupIndex{0};
  EXPECT_EQ(second_scheduler_after_two_of_the_first(1, 4), LocalTime() + 152_us);
}

IngressConfig split() {
  IngressConfig config;
  config.streams = {"s"};
  config.stream_identity_table = {{StreamHandle{0}, AddressIdentification{group}}};
  config.splits = {{StreamHandle{0}, {{{member_a, 0, 0}, {member_b, 7, 0}}}}};
  return config;
}

TEST(IngressPipeline, ASplitMakesOneFrameForEachMember) {
  Bench bench{split()};
  for (SequenceNumber number = 0; number < 3; ++number) {
    const std::vector<FrameIndex> frames = bench.pass_frame(bench.make(), 1_us);
    ASSERT_EQ(frames.size(), 2u);
    const Frame& a = bench.traffic.frame(frames[0]);
    const Frame& b = bench.traffic.frame(frames[1]);
    EXPECT_EQ(std::pair(a.destination, a.vlan), std::pair(member_a, VlanId{0}));
    EXPECT_EQ(std::pair(b.destination, b.vlan), std::pair(member_b, VlanId{7}));
    EXPECT_EQ(a.r_tag_sequence, number);
    EXPECT_EQ(b.r_tag_sequence, number);
    EXPECT_TRUE(a.r_tagged && b.r_tagged);
    EXPECT_EQ(a.length, 14 + 4 + 6 + 100 + 4);
    EXPECT_EQ(b.length, a.length);
    for (const FrameIndex frame : frames) bench.traffic.release(frame);
  }
  EXPECT_EQ(bench.traffic.stream(bench.index).copies, 3u);
  EXPECT_EQ(bench.pipeline().splits()[0].split.counters(), (StreamSplit::Counters{3, 3}));
  EXPECT_EQ(bench.traffic.live_frames(), 0u);
}

TEST(IngressPipeline, ASharedRecordIsNotTouchedByASplit) {
  Bench bench{split()};
  const FrameIndex frame = bench.make();
  bench.traffic.copy(frame);  // another port has it too
  const std::vector<FrameIndex> frames = bench.pass_frame(frame, 1_us);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(bench.traffic.frame(frame).references, 1u);
  EXPECT_EQ(bench.traffic.frame(frame).destination, group);
  EXPECT_FALSE(bench.traffic.frame(frame).r_tagged);
}

IngressConfig merge(StreamRecoveryConfig recovery = {}) {
  recovery.members = {{member_a, 0, 0}, {member_b, 0, 0}};
  recovery.destination = group;
  IngressConfig config;
  config.streams = {"s"};
  config.stream_identity_table = {{StreamHandle{0}, AddressIdentification{group}},
                                  {StreamHandle{0}, AddressIdentification{member_a}, std::uint16_t{0}},
                                  {StreamHandle{0}, AddressIdentification{member_b}, std::uint16_t{1}}};
  config.recoveries = {{StreamHandle{0}, recovery}};
  return config;
}

TEST(IngressPipeline, AMergePassesEachNumberOnceAndRestoresTheStream) {
  Bench bench{merge()};
  for (SequenceNumber number = 0; number < 4; ++number) {
    const bool a_first = number % 2 == 0;
    const std::vector<FrameIndex> first =
        bench.pass_frame(bench.make_member(a_first ? member_a : member_b, number), 1_us, a_first ? 1 : 2);
    ASSERT_EQ(first.size(), 1u);
    const Frame& frame = bench.traffic.frame(first[0]);
    EXPECT_EQ(frame.destination, group);
    EXPECT_FALSE(frame.r_tagged);
    EXPECT_EQ(frame.length, 14 + 4 + 100 + 4);
    EXPECT_TRUE(
        bench.pass_frame(bench.make_member(a_first ? member_b : member_a, number), 2_us, a_first ? 2 : 1).empty());
  }
  EXPECT_EQ(bench.dropped(DropReason::duplicate), 4u);
  const SequenceRecoveryCounters& counters = bench.pipeline().recoveries(TrueTime() + 3_us)[0].recovery.counters();
  EXPECT_EQ(counters.passed_packets, 4u);
  EXPECT_EQ(counters.discarded_packets, 4u);
  EXPECT_EQ(counters.out_of_order_packets, 0u);
}

TEST(IngressPipeline, TheTagStaysWhereItIsAskedFor) {
  StreamRecoveryConfig recovery;
  recovery.keep_r_tag = true;
  Bench bench{merge(recovery)};
  const std::vector<FrameIndex> passed = bench.pass_frame(bench.make_member(member_a, 9), 1_us);
  ASSERT_EQ(passed.size(), 1u);
  EXPECT_TRUE(bench.traffic.frame(passed[0]).r_tagged);
  EXPECT_EQ(bench.traffic.frame(passed[0]).r_tag_sequence, 9);
}

// A copy that is eliminated takes no tokens: recovery stands before policing.
TEST(IngressPipeline, WhatIsEliminatedIsNotPoliced) {
  IngressConfig config = merge();
  config.flow_meters.push_back({"m", {{0}, Octets{244}, {0}, Octets{0}}});  // two frames of 122 octets, no more
  config.stream_filters = {{StreamHandle{0}, std::nullopt, Octets{0}, false, {}, FlowMeterIndex{0}, {}}};
  Bench bench{std::move(config)};
  for (SequenceNumber number = 0; number < 2; ++number) {
    EXPECT_EQ(bench.pass_frame(bench.make_member(member_a, number), 1_us).size(), 1u);
    EXPECT_TRUE(bench.pass_frame(bench.make_member(member_b, number), 1_us).empty());
  }
  EXPECT_EQ(bench.pipeline().flow_meters()[0].frames[0], 2u);
  EXPECT_EQ(bench.dropped(DropReason::flow_meter), 0u);
}

// What is policed is the stream, once, and both members get the gate's priority.
TEST(IngressPipeline, WhatIsSplitHasBeenPoliced) {
  IngressConfig config = split();
  config.flow_meters.push_back({"m", {{0}, Octets{122}, {0}, Octets{0}}});
  config.stream_gates = {StreamGateConfig{}};
  config.stream_gates[0].admin_ipv = Priority{3};
  config.stream_filters = {
      {StreamHandle{0}, std::nullopt, Octets{0}, false, StreamGateIndex{0}, FlowMeterIndex{0}, {}}};
  Bench bench{std::move(config)};
  const std::vector<FrameIndex> frames = bench.pass_frame(bench.make(), 1_us);
  ASSERT_EQ(frames.size(), 2u);
  for (const FrameIndex frame : frames) EXPECT_EQ(bench.traffic.frame(frame).queue_priority, 3);
  EXPECT_TRUE(bench.pass_frame(bench.make(), 1_us).empty());
  EXPECT_EQ(bench.pipeline().splits()[0].split.counters().frames, 1u);  // a frame that is dropped gets no number
}

TEST(IngressPipeline, IndividualRecoveryTakesOutWhatOneMemberBringsTwice) {
  StreamRecoveryConfig recovery;
  recovery.individual_recovery = true;
  Bench bench{merge(recovery)};
  EXPECT_EQ(bench.pass_frame(bench.make_member(member_a, 0), 1_us, 1).size(), 1u);
  EXPECT_TRUE(
      bench.pass_frame(bench.make_member(member_a, 0), 2_us, 1).empty());  // babble: ends in the individual recovery
  EXPECT_TRUE(
      bench.pass_frame(bench.make_member(member_b, 0), 3_us, 2).empty());  // the copy: ends in the sequence recovery
  const StreamRecovery& one = bench.pipeline().recoveries(TrueTime() + 4_us)[0].recovery;
  ASSERT_EQ(one.individual().size(), 2u);
  EXPECT_EQ(one.individual()[0].recovery.recovery().counters().discarded_packets, 1u);
  EXPECT_EQ(one.individual()[1].recovery.recovery().counters().passed_packets, 1u);
  EXPECT_EQ(one.counters().passed_packets, 1u);
  EXPECT_EQ(one.counters().discarded_packets, 1u);
}

TEST(IngressPipeline, AMemberFrameWithoutATagIsTagless) {
  Bench bench{merge()};
  const FrameIndex frame = bench.make();
  bench.traffic.frame(frame).destination = member_a;
  EXPECT_TRUE(bench.pass_frame(frame, 1_us).empty());
  EXPECT_EQ(bench.pipeline().recoveries(TrueTime() + 1_us)[0].recovery.counters().tagless_packets, 1u);
}

// Sources and masks are asked only where the table has them, in the order of the table.
TEST(IngressPipeline, EntriesOfAllKindsAreTriedInTheirOrder) {
  const MaskAndMatchIdentification any_group{{0x01'00'00'00'00'00}, {0x01'00'00'00'00'00}, {}, {}, {}, {}};
  const SourceMacAndVlanIdentification from_node_1{mac_address_of(AddressIndex{1}, nodes), Tagged::all, 0};
  const auto filter_that_counts = [&](std::vector<StreamIdentityEntry> table) {
    IngressConfig config;
    config.streams = {"address", "source", "mask"};
    config.stream_identity_table = std::move(table);
    for (std::uint32_t i = 0; i < 3; ++i)
      config.stream_filters.push_back({StreamHandle{i}, std::nullopt, Octets{0}, false, {}, {}, {}});
    Bench bench{std::move(config)};
    bench.pass(1_us);
    std::vector<std::uint64_t> counts;
    for (std::uint32_t i = 0; i < 3; ++i)
      counts.push_back(bench.pipeline().stream_filters()[StreamFilterIndex{i}].counters().matching_frames);
    return counts;
  };
  const StreamIdentityEntry address{StreamHandle{0}, AddressIdentification{group}};
  const StreamIdentityEntry other_vlan{StreamHandle{0}, AddressIdentification{group, Tagged::tagged, 9}};
  const StreamIdentityEntry source{StreamHandle{1}, from_node_1};
  const StreamIdentityEntry mask{StreamHandle{2}, any_group};
  using Counts = std::vector<std::uint64_t>;
  EXPECT_EQ(filter_that_counts({address, source, mask}), (Counts{1, 0, 0}));
  EXPECT_EQ(filter_that_counts({source, address, mask}), (Counts{0, 1, 0}));
  EXPECT_EQ(filter_that_counts({other_vlan, mask, source}), (Counts{0, 0, 1}));
  EXPECT_EQ(filter_that_counts({other_vlan}), (Counts{0, 0, 0}));
}

// Many addresses in one table, several of them in one chain.
TEST(IngressPipeline, ManyStreamsAreToldApart) {
  IngressConfig config;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    config.streams.push_back(std::to_string(i));
    config.stream_identity_table.push_back({StreamHandle{i}, AddressIdentification{AddressIndex{100 + 7 * i}}});
  }
  const StreamTable table(config.stream_identity_table, nodes);
  for (std::uint32_t address = 0; address < 8000; ++address) {
    Frame frame;
    frame.destination = AddressIndex{address};
    const bool known = address >= 100 && (address - 100) % 7 == 0 && (address - 100) / 7 < 1000;
    EXPECT_EQ(table.identify(frame).stream, known ? StreamHandle{(address - 100) / 7} : StreamHandle{});
  }
}

TEST(IngressPipeline, EveryFrameIsAccountedFor) {
  IngressConfig config = merge();
  config.stream_gates = {gate({{true, std::nullopt, 10_us, 300u}, {false, std::nullopt, 5_us, std::nullopt}}, 15_us)};
  config.flow_meters.push_back({"m", {{40'000'000}, Octets{200}, {8'000'000}, Octets{150}}});
  config.ats_schedulers.push_back({"a", {30'000'000}, Octets{400}, true, {}});
  config.maximum_residence_time = 30_us;
  config.stream_filters = {
      {StreamHandle{0}, std::nullopt, Octets{110}, false, StreamGateIndex{0}, FlowMeterIndex{0}, AtsSchedulerIndex{0}}};
  Bench bench{std::move(config)};
  std::uint64_t passed = 0;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const auto number = static_cast<SequenceNumber>(i / 2);
    const FrameIndex frame = bench.make_member(i % 2 == 0 ? member_a : member_b, number, 60 + i * 7 % 60);
    for (const FrameIndex out : bench.pass_frame(frame, 4_us * i, static_cast<std::uint16_t>(i % 2))) {
      ++passed;
      bench.traffic.release(out);
    }
  }
  const Stream& stream = bench.traffic.stream(bench.index);
  EXPECT_EQ(stream.sent, 3000u);
  EXPECT_EQ(passed + stream.dropped_in_all(), 3000u);
  EXPECT_EQ(bench.dropped(DropReason::duplicate), 1500u);
  const StreamFilterCounters& filter = bench.pipeline().stream_filters()[StreamFilterIndex{0}].counters();
  EXPECT_EQ(filter.matching_frames, 1500u);
  EXPECT_EQ(filter.not_passing_sdu, bench.dropped(DropReason::stream_max_sdu));
  EXPECT_EQ(filter.not_passing_frames, bench.dropped(DropReason::stream_gate));
  EXPECT_EQ(filter.red_frames, bench.dropped(DropReason::flow_meter));
  EXPECT_GT(bench.dropped(DropReason::stream_max_sdu), 0u);
  EXPECT_GT(bench.dropped(DropReason::stream_gate), 0u);
  EXPECT_GT(passed, 0u);
  EXPECT_EQ(bench.traffic.live_frames(), 0u);
}

}  // namespace
}  // namespace takt::models
