// SPDX-License-Identifier: Apache-2.0
#include "models/gptp/codec.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>

#include "sim/random.hpp"

namespace takt::models::gptp::codec_test {
namespace {

const PortIdentity source{ClockIdentity::from_number(0x0011'22FF'FE33'4455), 2};
const PortIdentity requester{ClockIdentity::from_number(0xAABB'CCFF'FEDD'EE01), 1};

Header header(std::uint16_t sequence_id, int log_interval) {
  Header h;
  h.source = source;
  h.sequence_id = sequence_id;
  h.log_message_interval = static_cast<std::int8_t>(log_interval);
  return h;
}

FollowUpInformation information() {
  FollowUpInformation i;
  i.cumulative_scaled_rate_offset = -2;
  i.gm_time_base_indicator = 3;
  i.last_gm_phase_change[11] = 7;
  i.scaled_last_gm_freq_change = 9;
  return i;
}

std::string hex(const Message& message) {
  std::vector<std::byte> octets;
  encode(message, octets);
  EXPECT_EQ(octets.size(), encoded_length(message));
  std::string text;
  for (const std::byte octet : octets) {
    constexpr const char* digits = "0123456789abcdef";
    text += digits[static_cast<unsigned>(octet) >> 4];
    text += digits[static_cast<unsigned>(octet) & 15];
  }
  return text;
}

std::vector<Message> one_of_each() {
  Sync two_step{header(1, -3)};
  two_step.header.domain = 20;
  Sync one_step{header(2, -3), Sync::OneStep{{0x123456789AB, 999'999'999}, information()}};
  one_step.header.correction.scaled_ns = -65'536;
  FollowUp follow_up{header(1, -3), {5, 6}, information()};
  follow_up.header.correction.scaled_ns = 32'784'384;  // 500.25 ns
  Announce announce;
  announce.header = header(0xFFFF, 0);
  announce.grandmaster = requester.clock;
  announce.steps_removed = 1;
  announce.path_trace = {requester.clock, source.clock};
  FollowUp tracked = follow_up;
  tracked.drift = DriftTracking{{7, 8}, requester.clock, 3, -5};
  Sync tracked_sync = one_step;
  tracked_sync.one_step->drift = tracked.drift;
  return {two_step,
          one_step,
          follow_up,
          PdelayReq{header(7, 0)},
          PdelayResp{header(7, 0), {1, 2}, requester},
          PdelayRespFollowUp{header(7, 0), {3, 4}, requester},
          announce,
          tracked,
          tracked_sync,
          Signaling{header(7, 0x7F)},
          Signaling{header(8, 0x7F), requester, GptpCapable{-3, 1}},
          Signaling{header(9, 0x7F), requester, std::nullopt, IntervalRequest{-128, -4, 127, 3}},
          Signaling{header(10, 0x7F), requester, GptpCapable{0, 0}, IntervalRequest{0, 126, -7}}};
}

// By hand from 10.6.4.4: TLV type, length 12, 00-80-C2, subtype 4, the interval, flags, four octets that are reserved.
TEST(Codec, SignalingSaysThatGptpIsSpoken) {
  EXPECT_EQ(hex(Signaling{header(7, 0x7F), PortIdentity::all(), GptpCapable{-1, 0}}),
            "1c12003c"
            "00000008"
            "0000000000000000"
            "00000000"
            "001122fffe3344550002"
            "0007057f"
            "ffffffffffffffffffff"
            "8000000c"
            "0080c2000004"
            "ff0000000000");
}

// By hand from 10.6.4.3: TLV type, length 12, 00-80-C2, subtype 2, the intervals of Pdelay_Req, Sync and Announce,
// flags, two octets that are reserved.
TEST(Codec, SignalingAsksForIntervals) {
  EXPECT_EQ(hex(Signaling{header(7, 0x7F), requester, std::nullopt, IntervalRequest{-128, -4, 127}}),
            "1c12003c"
            "00000008"
            "0000000000000000"
            "00000000"
            "001122fffe3344550002"
            "0007057f"
            "aabbccfffeddee010001"
            "0003000c"
            "0080c2000002"
            "80fc7f07"
            "0000");
}

// The TLV behind that of the Follow_Up: type 3, 32 octets, 00-80-C2, subtype 6; the egress with 16 bits below a
// nanosecond, whose clock it is, three steps, the drift.
TEST(Codec, DriftTracking) {
  FollowUp follow_up{header(1, -3), {5, 6}, information()};
  const std::string without = hex(follow_up);
  follow_up.drift = DriftTracking{{7, 8}, requester.clock, 3, -5};
  const std::string with = hex(follow_up);
  ASSERT_EQ(with.size(), without.size() + 2 * 36);
  EXPECT_EQ(with.substr(without.size()),
            "00030020"
            "0080c2"
            "000006"
            "000000000007"
            "00000008"
            "0000"
            "aabbccfffeddee01"
            "0003"
            "fffffffb");
}

// 802.1AS-2020 tables 10-7, 11-8 to 11-14: the numbers of octets of the PTP part.
TEST(Codec, Lengths) {
  const std::vector<std::size_t> lengths = {44, 76, 76, 54, 54, 54, 64 + 4 + 16, 112, 112, 44, 60, 60, 76};
  const std::vector<Message> all = one_of_each();
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(encoded_length(all[i]), lengths[i]) << i;
}

TEST(Codec, OctetsOfSync) {
  EXPECT_EQ(hex(one_of_each()[0]),
            "10"  // gPTP, Sync
            "12"  // version 2.1
            "002c"
            "14"
            "00"                // 44 octets, domain 20, minorSdoId
            "0208"              // two-step, PTP time scale
            "0000000000000000"  // correction
            "00000000"
            "001122fffe334455"
            "0002"
            "0001"
            "00"
            "fd"  // sequence, control, log interval -3
            "00000000000000000000");
}

TEST(Codec, OctetsOfOneStepSync) {
  EXPECT_EQ(hex(one_of_each()[1]),
            "1012004c00000008"
            "ffffffffffff0000"
            "00000000"
            "001122fffe3344550002"
            "000200fd"
            "0123456789ab"
            "3b9ac9ff"
            "0003"
            "001c"
            "0080c2"
            "000001"
            "fffffffe"
            "0003"
            "000000000000000000000007"
            "00000009");
}

TEST(Codec, OctetsOfFollowUp) {
  EXPECT_EQ(hex(one_of_each()[2]),
            "1812004c00000008"
            "0000000001f44000"
            "00000000"
            "001122fffe3344550002"
            "000102fd"
            "000000000005"
            "00000006"
            "0003"
            "001c"
            "0080c2"
            "000001"
            "fffffffe"
            "0003"
            "000000000000000000000007"
            "00000009");
}

TEST(Codec, OctetsOfPdelay) {
  EXPECT_EQ(hex(one_of_each()[3]),
            "1212003600000008"
            "0000000000000000"
            "00000000"
            "001122fffe3344550002"
            "00070500"
            "0000000000000000000000000000000000000000");
  EXPECT_EQ(hex(one_of_each()[4]),
            "1312003600000208"
            "0000000000000000"
            "00000000"
            "001122fffe3344550002"
            "00070500"
            "000000000001"
            "00000002"
            "aabbccfffeddee010001");
  EXPECT_EQ(hex(one_of_each()[5]),
            "1a12003600000008"
            "0000000000000000"
            "00000000"
            "001122fffe3344550002"
            "00070500"
            "000000000003"
            "00000004"
            "aabbccfffeddee010001");
}

TEST(Codec, OctetsOfAnnounce) {
  EXPECT_EQ(hex(one_of_each()[6]),
            "1b12005400000008"
            "0000000000000000"
            "00000000"
            "001122fffe3344550002"
            "ffff0500"
            "00000000000000000000"
            "0025"
            "00"
            "f8"
            "f8fe436a"
            "f8"
            "aabbccfffeddee01"
            "0001"
            "a0"
            "0008"
            "0010"
            "aabbccfffeddee01"
            "001122fffe334455");
}

TEST(Codec, DecodesWhatItEncodes) {
  for (const Message& message : one_of_each()) {
    std::vector<std::byte> octets;
    encode(message, octets);
    EXPECT_EQ(decode(octets), message);
    octets.resize(octets.size() + 20);  // padding
    EXPECT_EQ(decode(octets), message);
  }
}

TEST(Codec, NothingThatIsCutShortIsAMessage) {
  for (const Message& message : one_of_each()) {
    std::vector<std::byte> octets;
    encode(message, octets);
    for (std::size_t length = 0; length < octets.size(); ++length)
      EXPECT_FALSE(decode(std::span(octets).first(length))) << length;
    for (std::size_t length = 0; length < octets.size(); ++length) {  // messageLength says so
      octets[2] = static_cast<std::byte>(length >> 8);
      octets[3] = static_cast<std::byte>(length & 0xFF);
      const bool is_signaling = std::holds_alternative<Signaling>(message);
      const bool is_whole =
          (octets.size() == 112 && length == 76)  // but for Drift_Tracking, which need not be there
          || (is_signaling && length >= 44 && (length - 44) % 16 == 0);  // nor need the TLVs of Signaling
      EXPECT_EQ(decode(octets).has_value(), is_whole) << length;
    }
  }
}

TEST(Codec, RefusesWhatIsNotUnderstood) {
  std::vector<std::byte> good;
  encode(one_of_each()[2], good);
  const auto changed = [&](std::size_t at, unsigned value) {
    std::vector<std::byte> octets = good;
    octets[at] = static_cast<std::byte>(value);
    return decode(octets).has_value();
  };
  EXPECT_TRUE(changed(0, 0x28)) << "CMLDS";
  EXPECT_FALSE(changed(0, 0x08)) << "plain IEEE 1588";
  EXPECT_FALSE(changed(0, 0x19)) << "a type that is not known";
  EXPECT_TRUE(changed(1, 0x02)) << "minor version 0";
  EXPECT_FALSE(changed(1, 0x11)) << "version 1";
  EXPECT_FALSE(changed(40, 0x3C)) << "more than 10^9 ns";
  EXPECT_FALSE(changed(45, 0x04)) << "another TLV in place of the Follow_Up information";
  EXPECT_FALSE(changed(47, 0x1D)) << "a TLV that passes the end";
  EXPECT_FALSE(changed(48, 0x01)) << "of another organization";
}

TEST(Codec, SkipsTlvsThatItDoesNotKnow) {
  std::vector<std::byte> octets;
  encode(one_of_each()[2], octets);
  for (const int octet : {0x00, 0x03, 0x00, 0x06, 0x00, 0x80, 0xC2, 0x00, 0x00, 0x06})
    octets.push_back(static_cast<std::byte>(octet));
  octets[3] = static_cast<std::byte>(octets.size());
  EXPECT_EQ(decode(octets), one_of_each()[2]);
}

TEST(Codec, AnnounceNeedsItsPathTrace) {
  std::vector<std::byte> octets;
  encode(one_of_each()[6], octets);
  octets.resize(64);
  octets[3] = std::byte{64};
  EXPECT_FALSE(decode(octets));
}

TEST(CodecProperty, AnyOctetsAreSafeAndWhatIsAMessageStaysOne) {
  sim::RandomStream chance(1, "codec", "fuzz");
  int decoded = 0;
  for (int round = 0; round < 200'000; ++round) {
    std::vector<std::byte> octets;
    encode(one_of_each()[chance.below(7)], octets);
    for (std::uint64_t changes = chance.below(6); changes > 0; --changes)
      octets[chance.below(octets.size())] = static_cast<std::byte>(chance.below(256));
    if (chance.below(4) == 0) octets.resize(chance.below(octets.size() + 8));
    const std::optional<Message> message = decode(octets);
    if (!message) continue;
    ++decoded;
    std::vector<std::byte> again;
    encode(*message, again);
    ASSERT_EQ(decode(again), message);
  }
  EXPECT_GT(decoded, 10'000);
}

TEST(PtpTime, CorrectionsHoldPicosecondsExactly) {
  ASSERT_TRUE(rc::check("there and back", [](std::int32_t ps) {
    const sim::Duration d = sim::Duration::from_ps(std::int64_t{ps} * 1'000'003);
    RC_ASSERT(Correction::of(d).duration() == d);
  }));
  EXPECT_EQ(Correction::of(sim::Duration::from_ps(500'250)).scaled_ns, 32'784'384);
}

TEST(PtpTime, TimestampsAreWholeNanoseconds) {
  const Timestamp t = Timestamp::floor_of(sim::PtpTime::from_ps(2'000'000'000'999));
  EXPECT_EQ(t, (Timestamp{2, 0}));
  EXPECT_EQ(t.time().ps(), 2'000'000'000'000);
  EXPECT_FALSE((Timestamp{std::uint64_t{1} << 47, 0}).in_range());
}

TEST(ClockIdentity, OfAMacAddress) {
  EXPECT_EQ(ClockIdentity::from_mac(0x0011'2233'4455), ClockIdentity::from_number(0x0011'22FF'FE33'4455));
}

}  // namespace
}  // namespace takt::models::gptp::codec_test
