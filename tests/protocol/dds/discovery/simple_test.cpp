// SPDX-License-Identifier: Apache-2.0
// Simple and static discovery: who finds whom, when, and by how many messages.
#include <gtest/gtest.h>

#include "dds/discovery/network.hpp"

namespace takt::dds {
namespace {

using namespace test;
using Kind = DiscoveryEvent::Kind;

DiscoverySettings simple(const DiscoveryProfile& profile = discovery_profile::fast_dds) {
  DiscoverySettings settings;
  settings.profile = profile;
  return settings;
}

/// A writer at one, a reader at the other, both there from the start.
struct Two : Network {
  explicit Two(const DiscoveryProfile& profile = discovery_profile::fast_dds,
               const TimingProfile& timing = timing::fast_dds)
      : a(add(simple(profile), timing)), b(add(simple(profile), timing)) {
    announce(a, publication(a.writer(1), "T"));
    announce(b, subscription(b.reader(1), "T"));
  }
  Node& a;
  Node& b;
};

TEST(Simple, FindsParticipantsAndEndpoints) {
  Two net;
  net.start(net.a);
  net.run_until(at(10_ms));
  net.start(net.b);
  net.run_until(at(1_s));
  // B is heard after one way; A's answer comes after another one, and with it come A's endpoints. B's endpoints come a
  // way later.
  const DiscoveryFigures of_a = net.a.discovery.figures();
  const DiscoveryFigures of_b = net.b.discovery.figures();
  EXPECT_EQ(of_a.found_at.at(net.b.discovery.self().guid), at(10_ms + 100_us));
  EXPECT_EQ(of_b.found_at.at(net.a.discovery.self().guid), at(10_ms + 200_us));
  EXPECT_EQ(of_b.found_at.at(net.a.writer(1)), at(10_ms + 200_us));
  EXPECT_EQ(of_a.found_at.at(net.b.reader(1)), at(10_ms + 300_us));
  ASSERT_EQ(net.a.discovery.subscriptions().size(), 1u);
  ASSERT_EQ(net.b.discovery.publications().size(), 1u);
  const auto& found = net.b.discovery.publications().at(net.a.writer(1));
  EXPECT_EQ(found, publication(net.a.writer(1), "T"));
  const MatchedWriter writer = net.b.discovery.matched_writer(found);
  EXPECT_EQ(writer.unicast, std::vector{Locator::udp_v4({10, 0, 0, 1}, 7411)});
  EXPECT_TRUE(writer.reliable);
  EXPECT_TRUE(net.a.events.at(0).kind == Kind::participant_found &&
              net.a.events.at(1).kind == Kind::subscription_found);
}

// Announcements at 0, 100, 200, 300, 400 ms and then each 3 s; one answer.
TEST(Simple, CountsItsMessages) {
  Two net;
  net.start(net.a);
  net.run_until(at(10_ms));
  net.start(net.b);
  net.run_until(at(10_s));
  EXPECT_EQ(net.a.discovery.figures().participants_sent.messages, 5u + 3u + 1u);
  EXPECT_EQ(net.b.discovery.figures().participants_sent.messages, 5u + 3u);
  std::uint64_t sum = 0;
  for (const auto& node : net.nodes) sum += node->discovery.figures().sent().messages;
  EXPECT_EQ(sum, net.log.size());
  const std::uint64_t received = net.a.discovery.figures().participants_received;
  EXPECT_EQ(received, 8u);
}

TEST(Simple, ProfilesAnnounceAtTheirTimes) {
  const auto times = [](const DiscoveryProfile& profile) {
    Network net;
    net.start(net.add(simple(profile)));
    net.run_until(at(40_s));
    std::vector<std::int64_t> ms;
    for (const Datagram& datagram : net.log) ms.push_back(datagram.at_us / 1000);
    return ms;
  };
  EXPECT_EQ(times(discovery_profile::rtps), (std::vector<std::int64_t>{0, 30'000}));
  EXPECT_EQ(times(discovery_profile::cyclone), (std::vector<std::int64_t>{0, 100, 8100, 16'100, 24'100, 32'100}));
  const auto fast = times(discovery_profile::fast_dds);
  EXPECT_EQ(std::vector(fast.begin(), fast.begin() + 7),
            (std::vector<std::int64_t>{0, 100, 200, 300, 400, 3400, 6400}));
}

TEST(Simple, LosesWhoIsSilent) {
  Two net;
  net.start(net.a);
  net.start(net.b);
  net.run_until(at(7_s));
  net.crash(net.b);
  // The last announcement of B was at 6.4 s; its lease is 20 s.
  net.run_until(at(26_s));
  EXPECT_EQ(net.a.count(Kind::participant_lost), 0u);
  net.run_until(at(27_s));
  EXPECT_EQ(net.a.count(Kind::participant_lost), 1u);
  ASSERT_EQ(net.a.count(Kind::subscription_lost), 1u);
  EXPECT_EQ(net.a.events.back().kind, Kind::participant_lost) << "after its endpoints";
  EXPECT_EQ(net.a.events.back().at, at(26'400_ms + 100_us));
  EXPECT_EQ(net.a.discovery.figures().leases_expired, 1u);
  EXPECT_TRUE(net.a.discovery.participants().empty());
  EXPECT_TRUE(net.a.discovery.subscriptions().empty());
}

TEST(Simple, TakesLeave) {
  Two net;
  net.start(net.a);
  net.start(net.b);
  net.run_until(at(1_s));
  net.stop(net.a);
  net.run_until(at(1_s + 100_us));
  EXPECT_EQ(net.b.count(Kind::participant_lost), 1u);
  EXPECT_EQ(net.b.count(Kind::publication_lost), 1u);
}

TEST(Simple, EndpointsComeAndGo) {
  Two net;
  net.start(net.a);
  net.start(net.b);
  net.run_until(at(1_s));
  net.announce(net.b, publication(net.b.writer(2), "U"));
  net.run_until(at(1_s + 100_us));
  EXPECT_EQ(net.a.count(Kind::publication_found), 1u);
  net.run_until(at(2_s));
  PublicationData changed = publication(net.b.writer(2), "U");
  changed.qos.ownership_strength.value = 9;
  net.announce(net.b, changed);
  net.run_until(at(3_s));
  EXPECT_EQ(net.a.count(Kind::publication_found), 2u);
  EXPECT_EQ(net.a.discovery.matched_writer(net.a.discovery.publications().at(net.b.writer(2))).ownership_strength, 9);
  net.withdraw(net.b, net.b.writer(2));
  net.run_until(at(3_s + 100_us));
  EXPECT_EQ(net.a.count(Kind::publication_lost), 1u);
  EXPECT_EQ(net.a.count(Kind::participant_lost), 0u);
}

// Whatever message is lost: after announcements and heartbeats have been repeated, all is found.
TEST(Simple, SurvivesTheLossOfAnyMessage) {
  for (const auto& timing : timing::all) {
    for (std::uint64_t lost = 1; lost <= 20; ++lost) {
      Two net(discovery_profile::fast_dds, timing);
      net.loses = [&](std::uint64_t number) { return number == lost; };
      net.start(net.a);
      net.run_until(at(1_ms));
      net.start(net.b);
      net.run_until(at(10_s));
      EXPECT_EQ(net.a.discovery.subscriptions().size(), 1u) << timing.name << " " << lost;
      EXPECT_EQ(net.b.discovery.publications().size(), 1u) << timing.name << " " << lost;
    }
  }
}

// For a minute half of all messages are lost, so leases end on one side and not on the other. When the network is good
// again, the two find each other within a period of announcements and one of heartbeats, 3 s each.
TEST(Simple, FindsAgainWhatWasLostOnOneSide) {
  std::size_t lost_on_one_side = 0;
  for (const auto& timing : timing::all) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
      Two net(discovery_profile::fast_dds, timing);
      std::uint64_t state = seed;
      net.loses = [&](std::uint64_t) {
        return net.now < at(60_s) && (state = state * 6364136223846793005U + 1442695040888963407U) >> 63 != 0;
      };
      net.start(net.a);
      net.start(net.b);
      net.run_until(at(60_s));
      lost_on_one_side += net.a.count(Kind::participant_lost) != net.b.count(Kind::participant_lost);
      net.run_until(at(75_s));
      EXPECT_EQ(net.a.discovery.subscriptions().size(), 1u) << timing.name << " " << seed;
      EXPECT_EQ(net.b.discovery.publications().size(), 1u) << timing.name << " " << seed;
    }
  }
  EXPECT_GT(lost_on_one_side, 10u) << "the case is there";
}

TEST(Simple, TellsOfLiveliness) {
  Two net;
  net.start(net.a);
  net.start(net.b);
  net.run_until(at(1_s));
  net.a.discovery.assert_liveliness(ParticipantMessageData::Kind::manual, net.now, net.a.outbox);
  net.withdraw(net.a, net.a.writer(77));  // also sends what the call before has made
  net.run_until(at(1_s + 100_us));
  ASSERT_EQ(net.b.count(Kind::liveliness_asserted), 1u);
  const auto event = std::find_if(net.b.events.begin(), net.b.events.end(),
                                  [](const auto& each) { return each.kind == Kind::liveliness_asserted; });
  EXPECT_EQ(event->subject, net.a.discovery.self().guid);
  EXPECT_EQ(event->liveliness, ParticipantMessageData::Kind::manual);
}

TEST(Simple, IgnoresOtherDomains) {
  Network net;
  Node& a = net.add(simple());
  net.start(a);
  ParticipantData other;
  other.guid = {{{9}}, entity_id::participant};
  other.domain = 7;
  std::vector<std::byte> buffer(1024);
  const Octets payload = encode(buffer, other);
  Interpretation from;
  from.source = other.guid.prefix;
  EXPECT_TRUE(a.discovery.receive(from, Data{{}, entity_id::spdp_writer, {1}, {}, PayloadKind::data, payload}, net.now,
                                  a.outbox));
  EXPECT_TRUE(a.discovery.participants().empty());
  EXPECT_FALSE(a.discovery.receive(
      from, Heartbeat{{}, EntityId::user(1, EntityKind::writer_with_key), {1}, {1}, 1, false, false}, net.now,
      a.outbox))
      << "the user's";
}

TEST(Static, FindsWhatIsConfigured) {
  Network net;
  DiscoverySettings settings;
  settings.kind = DiscoveryKind::static_;
  settings.participants = {{"valve", {publication({{}, EntityId::user(1, EntityKind::writer_with_key)}, "T")}, {}},
                           {"pump", {}, {subscription({{}, EntityId::user(2, EntityKind::reader_with_key)}, "T")}}};
  Node& valve = net.add(settings, timing::fast_dds, "valve");
  Node& pump = net.add(settings, timing::fast_dds, "pump");
  Node& other = net.add(settings, timing::fast_dds, "other");
  for (Node* const node : {&valve, &pump, &other}) net.start(*node);
  net.run_until(at(1_s));
  EXPECT_EQ(valve.discovery.subscriptions().count(pump.reader(2)), 1u);
  EXPECT_EQ(pump.discovery.publications().count(valve.writer(1)), 1u);
  EXPECT_EQ(other.discovery.publications().size() + other.discovery.subscriptions().size(), 2u);
  EXPECT_EQ(pump.discovery.matched_writer(pump.discovery.publications().at(valve.writer(1))).unicast,
            std::vector{Locator::udp_v4({10, 0, 0, 1}, 7411)});
  for (const auto& node : net.nodes) EXPECT_EQ(node->discovery.figures().endpoints_sent.messages, 0u) << "no SEDP";
}

}  // namespace
}  // namespace takt::dds
