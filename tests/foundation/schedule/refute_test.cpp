// SPDX-License-Identifier: Apache-2.0
// Proofs, each at the least number that makes it one, and not one below.
#include "schedule/refute.hpp"

#include <gtest/gtest.h>

#include "schedule_check/instance_check.hpp"
#include "small_problem.hpp"

namespace takt::schedule::refute_test {
namespace {

using Kind = Certificate::Kind;

std::optional<Kind> refuted(const Problem& problem) {
  const auto certificate = refute(problem);
  if (!certificate) return std::nullopt;
  EXPECT_EQ(schedule_check::why_not_proved(problem, *certificate), "");
  return certificate->kind;
}

TEST(Refute, Latency) {
  Problem problem = line(2, 0, us);
  Stream& stream = add_stream(problem, "h0", "h1", 10, 1000 * us);
  stream.latency = 3 * 9'904'000 + 2 * us;
  EXPECT_EQ(refuted(problem), std::nullopt);
  --*stream.latency;
  EXPECT_EQ(refuted(problem), Kind::latency);
  stream.latency.reset();
  stream.release = 7 * us;
  stream.deadline = 7 * us + 3 * 9'904'000 + 2 * us;
  EXPECT_EQ(refuted(problem), std::nullopt);
  --*stream.deadline;
  EXPECT_EQ(refuted(problem), Kind::latency);
}

TEST(Refute, Load) {
  Problem problem = line(2);
  add_stream(problem, "h0", "h1", 50, 100 * us);
  add_stream(problem, "h0", "h1", 75, 150 * us);
  EXPECT_EQ(refuted(problem), std::nullopt);  // exactly full
  problem.streams[1].octets += 1;
  EXPECT_EQ(refuted(problem), Kind::load);
}

// In a ring of four there are two ways from b0 to b2: three streams that need two links, and a little more.
TEST(Refute, LoadOfTwoCablesOfARing) {
  Problem problem = line(4);
  for (const auto& [a, b] : {std::pair("b0", "b3"), std::pair("b3", "b0")}) {
    Link link = problem.links.back();
    link.from = node_of(problem, a);
    link.to = node_of(problem, b);
    link.name = std::string(a) + ">" + b;
    problem.links.push_back(link);
  }
  // Stations x0, x1, x2 at b0 and y0, y1, y2 at b2, so that no link of theirs is loaded by more than one.
  for (int i = 0; i < 3; ++i) {
    const std::string x = "x" + std::to_string(i), y = "y" + std::to_string(i);
    problem.nodes.push_back({x, false});
    problem.links.push_back({x + ">b0", node_of(problem, x), node_of(problem, "b0"), 8'000, 0, us, std::nullopt, 1024});
    problem.nodes.push_back({y, false});
    problem.links.push_back({"b2>" + y, node_of(problem, "b2"), node_of(problem, y), 8'000, 0, 0, std::nullopt, 1024});
    add_stream(problem, x, y, i == 0 ? 60 : 70, 100 * us);
  }
  EXPECT_EQ(refuted(problem), std::nullopt);  // two cables, exactly full
  problem.streams[0].octets += 1;
  const auto certificate = refute(problem);
  ASSERT_TRUE(certificate);
  EXPECT_EQ(certificate->kind, Kind::load);
  EXPECT_EQ(certificate->links.size(), 2u);
  EXPECT_EQ(schedule_check::why_not_proved(problem, *certificate), "");
  Certificate bad = *certificate;
  bad.links.pop_back();
  EXPECT_NE(schedule_check::why_not_proved(problem, bad), "");
}

// Two frames of 10 us that must be out of h0 within 20 us (less one gap), and a third.
TEST(Refute, Interval) {
  Problem problem = line(2, 0, 0);
  for (int i = 0; i < 2; ++i) {
    Stream& stream = add_stream(problem, "h0", "h1", 10, 1000 * us);
    stream.deadline = 4 * 9'904'000 + 96'000;
  }
  EXPECT_EQ(refuted(problem), std::nullopt);
  for (Stream& stream : problem.streams) --*stream.deadline;
  EXPECT_EQ(refuted(problem), Kind::interval);
}

// 100 and 150 us have 50 us in common.
TEST(Refute, FoldedLoad) {
  Problem problem = line(2);
  problem.model.is_strict = true;
  add_stream(problem, "h0", "h1", 20, 100 * us);
  add_stream(problem, "h0", "h1", 30, 150 * us);
  EXPECT_EQ(refuted(problem), std::nullopt);
  problem.streams[1].octets += 1;
  EXPECT_EQ(refuted(problem), Kind::folded);
  problem.model.is_strict = false;
  EXPECT_EQ(refuted(problem), std::nullopt) << "repetitions may differ";
}

// Round a ring the long way would be too slow: both must take the same link.
TEST(Refute, WaysThatAreTooSlowAreNone) {
  Problem problem = line(3, 0, us);
  for (const auto& [a, b] : {std::pair("b0", "b2"), std::pair("b2", "b0")}) {
    Link link = problem.links.back();
    link.from = node_of(problem, a);
    link.to = node_of(problem, b);
    link.name = std::string(a) + ">" + b;
    problem.links.push_back(link);
  }
  for (const char* station : {"x", "y"}) {
    problem.nodes.push_back({station, false});
    problem.links.push_back({std::string(station) + ">b0", node_of(problem, station), node_of(problem, "b0"), 8'000, 0,
                             us, std::nullopt, 1024});
    problem.nodes.push_back({std::string(station) + "2", false});
    problem.links.push_back({"b2>" + std::string(station) + "2", node_of(problem, "b2"),
                             node_of(problem, std::string(station) + "2"), 8'000, 0, 0, std::nullopt, 1024});
    Stream& stream = add_stream(problem, station, std::string(station) + "2", 60, 100 * us);
    stream.latency = 3 * 59'904'000 + 2 * us;  // three links and two bridges; the other way has four and three
  }
  const auto certificate = refute(problem);
  ASSERT_TRUE(certificate);
  EXPECT_TRUE(certificate->in_time);
  EXPECT_EQ(schedule_check::why_not_proved(problem, *certificate), "");
  for (Stream& stream : problem.streams) *stream.latency += 59'904'000 + us;
  EXPECT_EQ(refuted(problem), std::nullopt);
  EXPECT_NE(schedule_check::why_not_proved(problem, *certificate), "") << "it was a proof of the other problem only";
}

// Frames of 1 and of 10 us over five links: on each further one the long ones are 9 us more behind. Phases of the
// second that are forbidden on link i: from -10 - 9 i to 1 - 9 i us, together 11 + 4 * 9 us, ends excluded.
TEST(Refute, PairsThatCannotPassEachOther) {
  Problem problem = line(4, 0, us);
  problem.model.is_strict = true;
  add_stream(problem, "h0", "h3", 1, 47 * us);
  add_stream(problem, "h0", "h3", 10, 47 * us);
  problem.streams[0].latency = 5 * 904'000 + 4 * us;
  problem.streams[1].latency = 5 * 9'904'000 + 4 * us;
  EXPECT_EQ(refuted(problem), std::nullopt);
  for (Stream& stream : problem.streams) --stream.period;
  EXPECT_EQ(refuted(problem), Kind::pair);
  const auto certificate = refute(problem);
  ASSERT_TRUE(certificate);
  // A ps to wait is enough.
  ++*problem.streams[0].latency;
  EXPECT_EQ(refuted(problem), std::nullopt);
  EXPECT_NE(schedule_check::why_not_proved(problem, *certificate), "");
}

TEST(Refute, SpoiltCertificatesProveNothing) {
  Problem problem = line(2);
  problem.model.is_strict = true;
  add_stream(problem, "h0", "h1", 20, 100 * us);
  add_stream(problem, "h0", "h1", 31, 150 * us);
  const auto good = refute(problem);
  ASSERT_TRUE(good);
  Certificate bad = *good;
  bad.modulus *= 2;  // 20/50 + 31/50 of 100
  EXPECT_NE(schedule_check::why_not_proved(problem, bad), "");
  bad = *good;
  bad.modulus = 25 * us;
  EXPECT_NE(schedule_check::why_not_proved(problem, bad), "");
  bad = *good;
  bad.streams.pop_back();
  EXPECT_NE(schedule_check::why_not_proved(problem, bad), "");
  bad = *good;
  bad.streams.push_back(bad.streams.front());
  EXPECT_NE(schedule_check::why_not_proved(problem, bad), "");
  bad = *good;
  bad.links = {link_of(problem, "b1>b0")};
  EXPECT_NE(schedule_check::why_not_proved(problem, bad), "");
  bad = *good;
  bad.kind = Kind::load;
  EXPECT_NE(schedule_check::why_not_proved(problem, bad), "");
}

}  // namespace
}  // namespace takt::schedule::refute_test
