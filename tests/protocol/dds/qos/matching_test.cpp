// SPDX-License-Identifier: Apache-2.0
// Every rule of requested and offered, each way, with its reason.
#include "dds/qos/matching.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace takt::dds {
namespace {

using namespace sim::literals;

/// A pair that matches; each case changes something.
struct Pair {
  DataWriterQos writer;
  DataReaderQos reader;
};

struct Case {
  std::function<void(Pair&)> change;
  std::vector<Mismatch> expected;
};

TEST(Matching, DefaultsMatch) { EXPECT_EQ(mismatches_of({}, {}), std::vector<Mismatch>()); }

TEST(Matching, EveryRule) {
  const std::vector<Case> cases = {
      {[](Pair& p) { p.writer.reliability.kind = ReliabilityKind::best_effort; }, {}},
      {[](Pair& p) { p.reader.reliability.kind = ReliabilityKind::reliable; }, {}},
      {[](Pair& p) {
         p.writer.reliability.kind = ReliabilityKind::best_effort,
         p.reader.reliability.kind = ReliabilityKind::reliable;
       },
       {{PolicyId::reliability, "offered BEST_EFFORT, requested RELIABLE"}}},
      {[](Pair& p) { p.writer.durability.kind = DurabilityKind::persistent; }, {}},
      {[](Pair& p) { p.reader.durability.kind = DurabilityKind::transient_local; },
       {{PolicyId::durability, "offered VOLATILE, requested TRANSIENT_LOCAL"}}},
      {[](Pair& p) {
         p.writer.durability.kind = DurabilityKind::transient, p.reader.durability.kind = DurabilityKind::persistent;
       },
       {{PolicyId::durability, "offered TRANSIENT, requested PERSISTENT"}}},
      {[](Pair& p) { p.writer.deadline.period = 1_ms; }, {}},
      {[](Pair& p) { p.writer.deadline.period = 1_ms, p.reader.deadline.period = 1_ms; }, {}},
      {[](Pair& p) { p.reader.deadline.period = 1_ms; }, {{PolicyId::deadline, "offered infinite, requested 1000 us"}}},
      {[](Pair& p) {
         p.writer.deadline.period = sim::Duration::from_ps(1'000'000'001), p.reader.deadline.period = 1_ms;
       },
       {{PolicyId::deadline, "offered 1000000001 ps, requested 1000 us"}}},
      {[](Pair& p) { p.reader.latency_budget.duration = 5_ms; }, {}},
      {[](Pair& p) { p.writer.latency_budget.duration = 5_ms; },
       {{PolicyId::latency_budget, "offered 5000 us, requested 0 us"}}},
      {[](Pair& p) { p.writer.liveliness.kind = LivelinessKind::manual_by_topic; }, {}},
      {[](Pair& p) { p.reader.liveliness.kind = LivelinessKind::manual_by_participant; },
       {{PolicyId::liveliness, "offered AUTOMATIC, requested MANUAL_BY_PARTICIPANT"}}},
      {[](Pair& p) { p.writer.liveliness.lease_duration = 1_s; }, {}},
      {[](Pair& p) { p.reader.liveliness.lease_duration = 1_s; },
       {{PolicyId::liveliness, "lease duration: offered infinite, requested 1000000 us"}}},
      {[](Pair& p) { p.writer.ownership.kind = OwnershipKind::exclusive; },
       {{PolicyId::ownership, "offered EXCLUSIVE, requested SHARED"}}},
      {[](Pair& p) { p.reader.ownership.kind = OwnershipKind::exclusive; },
       {{PolicyId::ownership, "offered SHARED, requested EXCLUSIVE"}}},
      {[](Pair& p) { p.writer.ownership_strength.value = 7; }, {}},
      {[](Pair& p) { p.writer.destination_order.kind = DestinationOrderKind::by_source_timestamp; }, {}},
      {[](Pair& p) { p.reader.destination_order.kind = DestinationOrderKind::by_source_timestamp; },
       {{PolicyId::destination_order, "offered BY_RECEPTION_TIMESTAMP, requested BY_SOURCE_TIMESTAMP"}}},
      {[](Pair& p) {
         p.writer.presentation = {PresentationScope::group, true, true};
       },
       {}},
      {[](Pair& p) { p.reader.presentation.access_scope = PresentationScope::topic; },
       {{PolicyId::presentation, "access scope: offered INSTANCE, requested TOPIC"}}},
      {[](Pair& p) { p.reader.presentation.coherent_access = true; },
       {{PolicyId::presentation, "coherent access: offered no, requested yes"}}},
      {[](Pair& p) { p.reader.presentation.ordered_access = true; },
       {{PolicyId::presentation, "ordered access: offered no, requested yes"}}},
      {[](Pair& p) {
         p.writer.partition.names = {"a", "b"}, p.reader.partition.names = {"c", "b"};
       },
       {}},
      {[](Pair& p) {
         p.writer.partition.names = {"a", "b"};
       },
       {{PolicyId::partition, "no common name: offered \"a\", \"b\", requested \"\""}}},
      // Not requested and not offered: these never keep two apart.
      {[](Pair& p) {
         p.writer.history = {HistoryKind::keep_all, 1}, p.reader.resource_limits = {1, 1, 1},
         p.writer.lifespan.duration = 1_ms;
       },
       {}},
      {[](Pair& p) {
         p.reader.time_based_filter.minimum_separation = 1_s, p.writer.transport_priority.value = 3,
         p.writer.user_data.octets = {std::byte{1}};
       },
       {}},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Pair pair;
    cases[i].change(pair);
    EXPECT_EQ(mismatches_of(pair.writer, pair.reader), cases[i].expected) << "case " << i;
  }
}

TEST(Matching, TellsAllThatDoesNotFit) {
  DataReaderQos reader;
  reader.durability.kind = DurabilityKind::transient_local;
  reader.deadline.period = 1_ms;
  const DataWriterQos writer;
  const Matching matching = match({"T", "Type", &writer}, {"T", "Type", &reader});
  EXPECT_EQ(matching.relation, Relation::incompatible);
  EXPECT_EQ(matching.mismatches.size(), 2u);
  EXPECT_EQ(matching.reason,
            "durability: offered VOLATILE, requested TRANSIENT_LOCAL; deadline: offered infinite, requested 1000 us");
}

TEST(Matching, NamesComeFirst) {
  const DataWriterQos writer;
  const DataReaderQos reader;
  EXPECT_EQ(match({"T", "Type", &writer}, {"U", "Type", &reader}).relation, Relation::other_topic);
  const Matching other = match({"T", "Type", &writer}, {"T", "Other", &reader});
  EXPECT_EQ(other.relation, Relation::other_type);
  EXPECT_EQ(other.reason, "topic T: offered Type, requested Other");
  EXPECT_TRUE(match({"T", "Type", &writer}, {"T", "Type", &reader}).is_match());
}

TEST(Matching, Representations) {
  const DataWriterQos writer;
  const DataReaderQos reader;
  const std::vector<DataRepresentation> one{DataRepresentation::xcdr1}, two{DataRepresentation::xcdr2},
      both{DataRepresentation::xcdr1, DataRepresentation::xcdr2};
  EXPECT_TRUE(match({"T", "Type", &writer, &one}, {"T", "Type", &reader}).is_match());
  EXPECT_TRUE(match({"T", "Type", &writer, &both}, {"T", "Type", &reader, &one}).is_match());
  EXPECT_TRUE(match({"T", "Type", &writer, &two}, {"T", "Type", &reader, &both}).is_match());
  EXPECT_EQ(match({"T", "Type", &writer, &two}, {"T", "Type", &reader}).reason,
            "data_representation: offered XCDR2, requested XCDR1");
}

TEST(Partitions, WithoutANameAreTheEmptyName) {
  EXPECT_TRUE(have_common_partition({}, {}));
  EXPECT_TRUE(have_common_partition({{""}}, {}));
  EXPECT_TRUE(have_common_partition({{"*"}}, {}));
  EXPECT_FALSE(have_common_partition({{"?"}}, {}));
  EXPECT_FALSE(have_common_partition({{"a"}}, {}));
}

TEST(Partitions, WildcardsOnEitherSideButNotBoth) {
  EXPECT_TRUE(have_common_partition({{"cell*"}}, {{"cell7"}}));
  EXPECT_TRUE(have_common_partition({{"cell7"}}, {{"x", "c?ll[0-9]"}}));
  EXPECT_FALSE(have_common_partition({{"cell*"}}, {{"cell*"}}));
  EXPECT_FALSE(have_common_partition({{"cell*"}}, {{"hall7"}}));
}

TEST(Partitions, Patterns) {
  EXPECT_TRUE(fits_pattern("a*b*c", "a--b-b--c"));
  EXPECT_FALSE(fits_pattern("a*b*c", "a--b-b--"));
  EXPECT_TRUE(fits_pattern("**", ""));
  EXPECT_TRUE(fits_pattern("[!a-c]x", "dx"));
  EXPECT_FALSE(fits_pattern("[!a-c]x", "bx"));
  EXPECT_TRUE(fits_pattern("[]]", "]"));
  EXPECT_TRUE(fits_pattern("[a", "[a")) << "no end: the letter itself";
  EXPECT_TRUE(fits_pattern("[a-]", "-"));
  // Exponential, if each star tried everything for each other.
  EXPECT_FALSE(fits_pattern("*a*a*a*a*a*a*a*a*a*a*a*a*b", std::string(2000, 'a')));
}

TEST(Policies, HaveNames) {
  EXPECT_EQ(name_of(PolicyId::destination_order), "destination_order");
  EXPECT_EQ(name_of(PolicyId::data_representation), "data_representation");
}

}  // namespace
}  // namespace takt::dds
