// SPDX-License-Identifier: Apache-2.0
// Who is grandmaster: fail-over, return, rings and random topologies, external configuration, hot standby.
#include <gtest/gtest.h>

#include <algorithm>

#include "gptp_fixture.hpp"

namespace takt::models::gptp::grandmaster_test {
namespace {

using sim::Duration;

Duration magnitude(Duration d) { return d < Duration() ? -d : d; }

Harness::NodeSetUp node(int priority1, std::int64_t ppm = 0) {
  return {.oscillator = {.offset = {ppm * 1'000'000}},
          .instances = {{.system = {.priority1 = static_cast<std::uint8_t>(priority1)}}}};
}

/// A ring of four whose best nodes are 0, then 1.
Harness ring_of_four() {
  Harness harness;
  for (int i = 0; i < 4; ++i) harness.add(node(100 + i, 20 * i - 30));
  for (std::size_t i = 0; i < 4; ++i) harness.connect(i, (i + 1) % 4, 300_ns);
  return harness;
}

TEST(Grandmaster, FailsOverAndTheOthersStayTogether) {
  Harness harness = ring_of_four();
  harness.start();
  harness.run(15_s);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(harness.instance(i).grandmaster().root.clock, Harness::identity(0)) << i;
  EXPECT_LE(magnitude(harness.offset(3, 1)), 1_ns);
  harness.kill(0);
  Duration worst;
  for (int i = 0; i < 1'000; ++i) {
    harness.run(10_ms);
    for (const std::size_t each : {2u, 3u}) worst = std::max(worst, magnitude(harness.offset(each, 1)));
  }
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_EQ(harness.instance(i).grandmaster().root.clock, Harness::identity(1)) << i;
  EXPECT_EQ(harness.station(3).target.state(), TargetState::locked);
  EXPECT_LE(worst, 100_ns);
}

TEST(Grandmaster, ReturnsAndIsFollowedAgain) {
  Harness harness = ring_of_four();
  harness.start();
  harness.run(15_s);
  for (const PortNumber port : {PortNumber{1}, PortNumber{2}}) harness.set_link(0, port, false);
  harness.run(20_s);
  EXPECT_TRUE(harness.instance(1).is_grandmaster());
  EXPECT_TRUE(harness.instance(0).is_grandmaster()) << "alone";
  const Duration apart = magnitude(harness.offset(1, 0));
  EXPECT_LE(apart, 1_us) << "1 holds over the rate of 0, which is constant";
  for (const PortNumber port : {PortNumber{1}, PortNumber{2}}) harness.set_link(0, port, true);
  harness.run(30_s);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_EQ(harness.instance(i).grandmaster().root.clock, Harness::identity(0)) << i;
    EXPECT_LE(magnitude(harness.offset(i, 0)), 2_ns) << i;
  }
}

TEST(Grandmaster, SyncAloneMissingIsNoticed) {
  Harness harness = ring_of_four();
  harness.start();
  harness.run(10_s);
  const std::size_t before = harness.station(2).grandmasters.size();
  harness.is_lost = [](const Message& message) {
    return std::holds_alternative<Sync>(message) && header_of(message).source.clock == Harness::identity(0);
  };
  harness.run(400_ms);  // 3 * 125 ms; Announce still comes
  EXPECT_GT(harness.station(2).grandmasters.size(), before);
}

TEST(Grandmaster, HoldoverKeepsTheRate) {
  Harness harness;
  harness.add(node(100, 50));
  harness.add(node(200, -50));
  harness.connect(0, 1, 100_ns);
  harness.start();
  harness.run(15_s);
  harness.set_link(0, 1, false);
  EXPECT_EQ(harness.station(1).target.state(), TargetState::holdover);
  harness.run(60_s);
  EXPECT_LE(magnitude(harness.offset(1, 0)), 60_ns) << "1e-9 at most";
  EXPECT_TRUE(harness.instance(1).is_grandmaster());
}

/// What BMCA should find, by looking at everything at once.
struct Expected {
  std::vector<std::size_t> grandmaster;  // of the component of each node
  std::vector<std::uint16_t> steps;      // fewest links to it
};

using Links = std::vector<std::pair<std::size_t, std::size_t>>;

std::vector<std::uint16_t> distances(std::size_t from, std::size_t nodes, const Links& links) {
  std::vector<std::uint16_t> steps(nodes, 0xFFFF);
  steps[from] = 0;
  for (std::size_t round = 0; round < nodes; ++round) {
    for (const auto& [a, b] : links) {
      if (steps[a] != 0xFFFF) steps[b] = std::min<std::uint16_t>(steps[b], static_cast<std::uint16_t>(steps[a] + 1));
      if (steps[b] != 0xFFFF) steps[a] = std::min<std::uint16_t>(steps[a], static_cast<std::uint16_t>(steps[b] + 1));
    }
  }
  return steps;
}

Expected exhaustive(const std::vector<SystemIdentity>& systems, const Links& links) {
  Expected expected;
  for (std::size_t i = 0; i < systems.size(); ++i) {
    const std::vector<std::uint16_t> reach = distances(i, systems.size(), links);
    std::size_t best = i;
    for (std::size_t j = 0; j < systems.size(); ++j)
      if (reach[j] != 0xFFFF && systems[j] < systems[best]) best = j;
    expected.grandmaster.push_back(best);
    expected.steps.push_back(reach[best]);
  }
  return expected;
}

/// The grandmaster is the best of each component, paths are shortest, and the roles form a tree: every node but the
/// grandmaster has one time receiver, every link that is up one time transmitter at one end and something else at the
/// other.
void expect_agreement(Harness& harness, const std::vector<SystemIdentity>& systems, const Links& links,
                      const std::string& what) {
  const Expected expected = exhaustive(systems, links);
  for (std::size_t i = 0; i < systems.size(); ++i) {
    if (!harness.station(i).alive) continue;
    const PtpInstance& instance = harness.instance(i);
    ASSERT_EQ(instance.grandmaster().root, systems[expected.grandmaster[i]]) << what << " node " << i;
    EXPECT_EQ(instance.grandmaster().steps_removed, expected.steps[i]) << what << " node " << i;
    int receivers = 0;
    for (PortNumber port = 1; port <= harness.station(i).peers.size(); ++port) {
      receivers += instance.role(port) == PortRole::time_receiver ? 1 : 0;
      const auto [peer, peer_port] = harness.station(i).peers[port - 1u];
      const bool up = harness.station(i).up[port - 1u];
      const int transmitters = (instance.role(port) == PortRole::time_transmitter ? 1 : 0) +
                               (harness.instance(peer).role(peer_port) == PortRole::time_transmitter ? 1 : 0);
      EXPECT_EQ(transmitters, up ? 1 : 0) << what << " node " << i << " port " << port;
      EXPECT_EQ(instance.role(port) == PortRole::disabled, !up) << what;
    }
    EXPECT_EQ(receivers, expected.grandmaster[i] == i ? 0 : 1) << what << " node " << i;
  }
}

std::vector<SystemIdentity> add_random_nodes(Harness& harness, std::size_t count, sim::RandomStream& chance) {
  std::vector<SystemIdentity> systems;
  for (std::size_t i = 0; i < count; ++i) {
    SystemIdentity system;
    system.priority1 = static_cast<std::uint8_t>(246 + chance.below(3));
    system.quality.clock_class = static_cast<std::uint8_t>(6 + chance.below(2));
    system.quality.clock_accuracy = static_cast<std::uint8_t>(0x20 + chance.below(2));
    system.quality.offset_scaled_log_variance = static_cast<std::uint16_t>(chance.below(2));
    system.priority2 = static_cast<std::uint8_t>(247 + chance.below(2));
    system.clock = Harness::identity(i);
    systems.push_back(system);
    harness.add({.instances = {{.system = system}}});
  }
  return systems;
}

// Rings of 3 to 10 with random priorities.
TEST(Bmca, ARingAgreesWithExhaustiveComparison) {
  sim::RandomStream chance(1, "test", "rings");
  for (int round = 0; round < 24; ++round) {
    const std::size_t nodes = 3 + chance.below(8);
    Harness harness;
    const std::vector<SystemIdentity> systems = add_random_nodes(harness, nodes, chance);
    Links links;
    for (std::size_t i = 0; i < nodes; ++i) links.push_back({i, (i + 1) % nodes});
    for (const auto& [a, b] : links) harness.connect(a, b, 100_ns);
    harness.start();
    harness.run(6_s);
    expect_agreement(harness, systems, links, "ring " + std::to_string(round));
  }
}

// Random connected graphs, also with parallel links. Then one link or one node fails: it has converged again after the
// announce receipt time-out (3 s) for each hop, plus 2 s for measuring and handing on.
TEST(Bmca, RandomTopologiesAgreeBeforeAndAfterAFailure) {
  sim::RandomStream chance(2, "test", "topologies");
  for (int round = 0; round < 60; ++round) {
    const std::size_t nodes = 2 + chance.below(8);
    Harness harness;
    const std::vector<SystemIdentity> systems = add_random_nodes(harness, nodes, chance);
    Links links;
    for (std::size_t i = 1; i < nodes; ++i) links.push_back({chance.below(i), i});
    for (std::uint64_t extra = chance.below(nodes); extra > 0; --extra) {
      const std::size_t a = chance.below(nodes), b = chance.below(nodes);
      if (a != b) links.push_back({a, b});
    }
    for (const auto& [a, b] : links) harness.connect(a, b, 100_ns);
    harness.start(static_cast<std::uint64_t>(round));
    harness.run(6_s);
    expect_agreement(harness, systems, links, "topology " + std::to_string(round));

    const std::size_t victim = chance.below(nodes);
    if (chance.below(2) == 0) {
      harness.kill(victim);
      std::erase_if(links, [&](const auto& link) { return link.first == victim || link.second == victim; });
    } else {
      const auto port = static_cast<PortNumber>(1 + chance.below(harness.station(victim).peers.size()));
      const std::size_t peer = harness.station(victim).peers[port - 1u].first;
      harness.set_link(victim, port, false);
      const auto gone = std::find_if(links.begin(), links.end(), [&](const auto& link) {
        return link == std::pair{victim, peer} || link == std::pair{peer, victim};
      });
      links.erase(gone);
    }
    harness.run(3_s * static_cast<std::int64_t>(nodes - 1) + 2_s);
    expect_agreement(harness, systems, links, "after the failure " + std::to_string(round));
  }
}

TEST(Bmca, Priority255IsNeverGrandmaster) {
  Harness harness;
  harness.add(node(255));
  harness.add(node(255));
  harness.connect(0, 1, 100_ns);
  harness.start();
  harness.run(10_s);
  EXPECT_EQ(harness.sent[44], 0) << "no Sync, and so no Follow_Up";
  EXPECT_GT(harness.sent[76], 0) << "Announce of one that nobody follows";
}

TEST(ExternalConfiguration, FixesTheRoles) {
  Harness harness;
  using Role = PortRole;
  const std::vector<std::vector<Role>> roles = {{Role::time_transmitter, Role::time_transmitter},
                                                {Role::time_receiver, Role::time_transmitter},
                                                {Role::time_receiver, Role::passive}};
  for (int i = 0; i < 3; ++i) {
    Harness::NodeSetUp each = node(200 - i, 30 * i);  // BMCA would choose node 2
    each.instances[0].external_roles = roles[static_cast<std::size_t>(i)];
    harness.add(each);
  }
  harness.connect(0, 1, 100_ns);  // port 1 of both
  harness.connect(0, 2, 100_ns);  // port 2 of 0, port 1 of 2
  harness.connect(1, 2, 100_ns);  // port 2 of both
  harness.start();
  harness.run(20_s);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(harness.instance(i).grandmaster().root.clock, Harness::identity(0));
    for (const PortNumber port : {PortNumber{1}, PortNumber{2}})
      EXPECT_EQ(harness.instance(i).role(port), roles[i][port - 1u]);
    EXPECT_LE(magnitude(harness.offset(i, 0)), 1_ns);
  }
  EXPECT_EQ(harness.instance(2).path_trace(), (std::vector<ClockIdentity>{Harness::identity(0), Harness::identity(2)}));
  harness.set_link(0, 1, false);
  harness.run(5_s);
  EXPECT_EQ(harness.instance(1).role(1), PortRole::disabled);
  EXPECT_EQ(harness.station(1).target.state(), TargetState::holdover);
  EXPECT_FALSE(harness.instance(1).is_grandmaster());
}

// Domain 0 from node 0, domain 20 from node 1, which follows domain 0 as well; node 3 hears both through the bridge 2.
TEST(HotStandbyNetwork, SwitchesOverWithoutAJump) {
  Harness harness;
  using Role = PortRole;
  const auto add = [&](std::int64_t ppm, std::vector<Role> primary, std::vector<Role> secondary) {
    Harness::NodeSetUp set_up = node(248, ppm);
    set_up.instances = {{.domain = 0, .external_roles = std::move(primary)},
                        {.domain = 20, .external_roles = std::move(secondary)}};
    set_up.standby = HotStandbyConfig{};
    harness.add(set_up);
  };
  add(40, {Role::time_transmitter}, {Role::time_receiver});
  add(-20, {Role::time_receiver}, {Role::time_transmitter});
  add(10, {Role::time_receiver, Role::time_transmitter, Role::time_transmitter},
      {Role::time_transmitter, Role::time_receiver, Role::time_transmitter});
  add(60, {Role::time_receiver}, {Role::time_receiver});
  for (const std::size_t each : {0u, 1u, 3u}) harness.connect(2, each, 200_ns);
  harness.start();
  harness.run(20_s);
  Harness::Station& end = harness.station(3);
  EXPECT_EQ(end.standby->state(), HotStandbyState::redundant);
  EXPECT_EQ(end.standby->active(), HotStandbyRole::primary);
  EXPECT_LE(magnitude(harness.offset(3, 0)), 1_ns);

  harness.kill(0);
  Duration worst;
  for (int i = 0; i < 1'000; ++i) {
    harness.run(10_ms);
    worst = std::max(worst, magnitude(harness.offset(3, 1)));
  }
  EXPECT_EQ(end.standby->state(), HotStandbyState::not_redundant);
  EXPECT_EQ(end.standby->active(), HotStandbyRole::secondary);
  EXPECT_EQ(end.target.state(), TargetState::locked);
  EXPECT_LE(worst, 50_ns);

  harness.kill(1);
  harness.run(2_s);
  EXPECT_EQ(end.standby->state(), HotStandbyState::out_of_sync);
  EXPECT_EQ(end.target.state(), TargetState::holdover);
}

}  // namespace
}  // namespace takt::models::gptp::grandmaster_test
