// SPDX-License-Identifier: Apache-2.0
// The GroupVersion tells Programs apart that were configured differently.
#include "wire/program_shape.hpp"

#include <gtest/gtest.h>

#include <set>

#include "support.hpp"

namespace takt::wire {
namespace {

TEST(ProgramShape, GroupVersionIsStable) {
  // FNV-1a of "p\0", variant, count and names of participants, then the data sets, numbers as UInt32; worked out apart
  // from this code.
  EXPECT_EQ(group_version_of(test::shape()), 0x0806BC43u);
  EXPECT_EQ(group_version_of(test::shape()), group_version_of(test::shape()));
}

TEST(ProgramShape, WhateverDiffersShows) {
  std::set<std::uint32_t> versions;
  const auto add = [&](auto&& change) {
    ProgramShape shape = test::shape();
    change(shape);
    EXPECT_TRUE(versions.insert(group_version_of(shape)).second) << versions.size();
  };
  add([](ProgramShape&) {});
  add([](ProgramShape& s) { s.name = "q"; });
  add([](ProgramShape& s) { s.variant = handshake::Variant::paper; });
  add([](ProgramShape& s) { s.participants[1] = "other"; });
  add([](ProgramShape& s) { s.participants.emplace_back("more"); });
  add([](ProgramShape& s) { s.data_sets[0].name = "other"; });
  add([](ProgramShape& s) { s.data_sets[0].from = 1; });
  add([](ProgramShape& s) { s.data_sets[0].fields[0].name = "y"; });
  add([](ProgramShape& s) { s.data_sets[0].fields[0].type = uadp::BuiltInType::Float; });
  add([](ProgramShape& s) { s.data_sets[1].fields[0].count = 4; });
  add([](ProgramShape& s) { s.data_sets.pop_back(); });
}

TEST(ProgramShape, PublisherIdsHaveNoPart) {
  ProgramShape shape = test::shape();
  shape.first_publisher_id = 9;
  EXPECT_EQ(group_version_of(shape), group_version_of(test::shape()));
}

TEST(ProgramShape, Octets) {
  EXPECT_EQ(octets_of(test::shape().data_sets[0]), 10u);
  EXPECT_EQ(octets_of(test::shape().data_sets[1]), 3u);
}

}  // namespace
}  // namespace takt::wire
