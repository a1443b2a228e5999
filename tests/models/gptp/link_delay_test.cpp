// SPDX-License-Identifier: Apache-2.0
#include "models/gptp/link_delay.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace takt::models::gptp::link_delay_test {
namespace {

using namespace sim::literals;
using sim::Duration;
using sim::LocalTime;

const PortIdentity self{ClockIdentity::from_number(1), 1};
const PortIdentity peer{ClockIdentity::from_number(2), 3};
LocalTime local(Duration d) { return LocalTime() + d; }

/// The message that was sent, if one was.
template <class Body>
const Body* sent(const Outputs& outputs) {
  for (const Output& output : outputs)
    if (const auto* const send = std::get_if<SendMessage>(&output))
      if (const auto* const body = std::get_if<Body>(&send->message)) return body;
  return nullptr;
}
bool capable_change(const Outputs& outputs, bool to) {
  for (const Output& output : outputs)
    if (const auto* const change = std::get_if<AsCapableChange>(&output)) return change->as_capable == to;
  return false;
}

/// One side whose neighbour is this test: its clock is 7 s ahead, and everything is exact.
struct Initiator {
  explicit Initiator(const LinkDelayConfig& config = {}) : link(config, self) { link.link_up(now, outputs); }

  PdelayResp response(LocalTime ingress_there) const {
    PdelayResp r;
    r.header.source = peer;
    r.header.sequence_id = sent<PdelayReq>(outputs)->header.sequence_id;
    r.request_receipt = Timestamp::floor_of(sim::PtpTime::from_ps((ingress_there + 7_s).ps()));
    r.requesting_port = self;
    return r;
  }
  PdelayRespFollowUp follow_up(const PdelayResp& response, Duration turnaround) const {
    PdelayRespFollowUp f;
    f.header.source = response.header.source;
    f.header.sequence_id = response.header.sequence_id;
    f.response_origin = Timestamp::floor_of(response.request_receipt.time() + turnaround);
    f.requesting_port = self;
    return f;
  }
  /// A whole exchange over `delay` each way, then the end of the interval.
  void exchange(Duration delay) {
    const auto sequence_id = sent<PdelayReq>(outputs)->header.sequence_id;
    Outputs more;
    link.transmitted({1, MessageType::pdelay_req, 0, sequence_id, now + 1_us}, more);
    const PdelayResp r = response(now + 1_us + delay);
    link.received(r, now + 1_us + delay + 3_us + delay, more);
    link.received(follow_up(r, 3_us), more);
    seen = more;
    next();
  }
  void next() {
    outputs.clear();
    now += 1_s;
    link.interval_elapsed(now, outputs);
  }

  LocalTime now = local(1_s);
  Outputs outputs;
  Outputs seen;
  LinkDelay link;
};

TEST(LinkDelay, IsCapableAfterTheSecondExchange) {
  Initiator initiator;
  initiator.exchange(300_ns);
  EXPECT_FALSE(initiator.link.as_capable());
  initiator.exchange(300_ns);
  EXPECT_TRUE(initiator.link.as_capable());
  EXPECT_TRUE(capable_change(initiator.seen, true));
  EXPECT_EQ(initiator.link.mean_link_delay(), 300_ns);
  EXPECT_EQ(initiator.link.neighbor_rate_ratio(initiator.now), ClockRate::one());
}

TEST(LinkDelay, KeepsItsThresholds) {
  Initiator initiator;
  for (int i = 0; i < 3; ++i) initiator.exchange(801_ns);
  EXPECT_FALSE(initiator.link.as_capable());
  EXPECT_EQ(initiator.link.mean_link_delay(), 801_ns);
  initiator.exchange(800_ns);
  EXPECT_TRUE(initiator.link.as_capable());
  Initiator fibre({.mean_link_delay_thresh = std::nullopt});
  for (int i = 0; i < 3; ++i) fibre.exchange(100_us);
  EXPECT_TRUE(fibre.link.as_capable());
}

TEST(LinkDelay, LosesCapabilityAfterTooManyLostResponses) {
  Initiator initiator;
  for (int i = 0; i < 3; ++i) initiator.exchange(100_ns);
  for (int i = 0; i < 9; ++i) initiator.next();
  EXPECT_TRUE(initiator.link.as_capable());
  EXPECT_EQ(initiator.link.lost_responses(), 9);
  initiator.next();
  EXPECT_TRUE(capable_change(initiator.outputs, false));
  EXPECT_FALSE(initiator.link.as_capable());
}

TEST(LinkDelay, AveragesIfAsked) {
  Initiator initiator({.average_over = 4});
  initiator.exchange(100_ns);  // no ratio yet: no measurement
  for (const Duration delay : {100_ns, 120_ns}) initiator.exchange(delay);
  EXPECT_EQ(initiator.link.mean_link_delay(), 110_ns);
}

TEST(LinkDelay, IgnoresAnswersToOthers) {
  Initiator initiator;
  Outputs outputs;
  initiator.link.transmitted({1, MessageType::pdelay_req, 0, 0, initiator.now}, outputs);
  PdelayResp foreign = initiator.response(initiator.now);
  foreign.requesting_port = peer;
  initiator.link.received(foreign, initiator.now, outputs);
  PdelayResp old = initiator.response(initiator.now);
  old.header.sequence_id = 77;
  initiator.link.received(old, initiator.now, outputs);
  initiator.link.received(initiator.follow_up(initiator.response(initiator.now), 1_us), outputs);
  EXPECT_FALSE(initiator.link.is_measured());
  EXPECT_TRUE(outputs.empty());
}

TEST(LinkDelay, TwoNeighboursOnALinkAreAFault) {
  Initiator initiator({.allowed_faults = 2});
  for (int i = 0; i < 3; ++i) initiator.exchange(100_ns);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(initiator.link.as_capable()) << i;
    const PdelayResp second = initiator.response(initiator.now);
    Outputs outputs;
    initiator.link.transmitted({1, MessageType::pdelay_req, 0, second.header.sequence_id, initiator.now}, outputs);
    initiator.link.received(second, initiator.now + 1_us, outputs);
    initiator.link.received(second, initiator.now + 2_us, outputs);
    initiator.next();
  }
  EXPECT_FALSE(initiator.link.as_capable());
}

TEST(LinkDelay, HearingItselfIsNoNeighbour) {
  Initiator initiator;
  for (int i = 0; i < 3; ++i) initiator.exchange(100_ns);
  PdelayResp own = initiator.response(initiator.now);
  own.header.source = self;
  Outputs outputs;
  initiator.link.received(own, initiator.now, outputs);
  EXPECT_FALSE(initiator.link.as_capable());
}

TEST(LinkDelay, NonsenseIsNotComputedWith) {
  Initiator initiator;
  for (int i = 0; i < 3; ++i) initiator.exchange(100_ns);
  Outputs outputs;
  PdelayResp r = initiator.response(initiator.now);
  initiator.link.transmitted({1, MessageType::pdelay_req, 0, r.header.sequence_id, initiator.now}, outputs);
  r.request_receipt = {8'000'000, 0};
  initiator.link.received(r, initiator.now + 1_us, outputs);
  PdelayRespFollowUp f = initiator.follow_up(r, 1_us);
  f.response_origin = {std::uint64_t{1} << 47, 5};
  initiator.link.received(f, outputs);
  initiator.next();
  EXPECT_EQ(initiator.link.mean_link_delay(), 100_ns);
  EXPECT_EQ(initiator.link.lost_responses(), 1);
}

TEST(LinkDelay, AnswersWithPicosecondsInTheCorrections) {
  LinkDelay link({}, self);
  Outputs outputs;
  link.link_up(local(0_s), outputs);
  outputs.clear();
  PdelayReq request;
  request.header.source = peer;
  request.header.sequence_id = 44;
  link.received(request, local(1_s + 1_ns + 250_ps), outputs);
  const PdelayResp* const response = sent<PdelayResp>(outputs);
  ASSERT_NE(response, nullptr);
  EXPECT_EQ(response->request_receipt, (Timestamp{1, 1}));
  EXPECT_EQ(response->header.correction.scaled_ns, 16'384);  // a quarter of a nanosecond
  EXPECT_EQ(response->requesting_port, peer);
  EXPECT_EQ(response->header.sequence_id, 44);
  Outputs after;
  link.transmitted({1, MessageType::pdelay_resp, 0, 44, local(1_s + 20_us)}, after);
  const PdelayRespFollowUp* const follow_up = sent<PdelayRespFollowUp>(after);
  ASSERT_NE(follow_up, nullptr);
  EXPECT_EQ(follow_up->response_origin, (Timestamp{1, 20'000}));
}

TEST(LinkDelay, ASilentPortWhenTheLinkIsDown) {
  Initiator initiator;
  for (int i = 0; i < 3; ++i) initiator.exchange(100_ns);
  Outputs outputs;
  initiator.link.link_down(outputs);
  EXPECT_TRUE(capable_change(outputs, false));
  outputs.clear();
  initiator.link.interval_elapsed(initiator.now, outputs);
  initiator.link.received(PdelayReq{}, initiator.now, outputs);
  EXPECT_TRUE(outputs.empty());
}

}  // namespace
}  // namespace takt::models::gptp::link_delay_test
