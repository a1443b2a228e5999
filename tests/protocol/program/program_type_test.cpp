// SPDX-License-Identifier: Apache-2.0
// Making and deleting Programs: Creatable, InstanceCount, Deletable, AutoDelete.
#include "program/program_type.hpp"

#include <gtest/gtest.h>

namespace takt::program::program_type_test {
namespace {

const sim::LocalTime now;

ProgramSettings named(const std::string& name) {
  ProgramSettings settings;
  settings.name = name;
  return settings;
}
Call call_of(Method method) {
  Call call;
  call.method = method;
  return call;
}

TEST(ProgramTypes, AsManyAsMayBe) {
  ProgramType type(true, 2);
  EXPECT_EQ(type.create(named("a"), {}, now), StatusCode::Good);
  EXPECT_EQ(type.create(named("a"), {}, now), StatusCode::BadInvalidArgument);
  EXPECT_EQ(type.create(named(""), {}, now), StatusCode::BadInvalidArgument);
  EXPECT_EQ(type.create(named("b"), {}, now), StatusCode::Good);
  EXPECT_EQ(type.create(named("c"), {}, now), StatusCode::BadResourceUnavailable);
  EXPECT_EQ(type.instance_count(), 2u);
  EXPECT_EQ(ProgramType(false).create(named("a"), {}, now), StatusCode::BadNotExecutable);
}

TEST(ProgramTypes, OnlyWhatIsHaltedIsDeleted) {
  ProgramType type;
  type.create(named("a"), {}, now);
  EXPECT_EQ(type.remove("b"), StatusCode::BadNodeIdUnknown);
  type.call("a", call_of(Method::Reset), now);
  EXPECT_EQ(type.remove("a"), StatusCode::BadInvalidState) << "Ready";
  type.call("a", call_of(Method::Halt), now);
  EXPECT_EQ(type.remove("a"), StatusCode::Good);
  EXPECT_EQ(type.find("a"), nullptr);
  ProgramSettings kept = named("kept");
  kept.deletable = false;
  type.create(kept, {}, now);
  EXPECT_EQ(type.remove("kept"), StatusCode::BadUserAccessDenied);
  EXPECT_EQ(type.call("a", call_of(Method::Start), now).status, StatusCode::BadNodeIdUnknown);
}

TEST(ProgramTypes, AutoDeleteAfterTheLastEvent) {
  ProgramType type;
  ProgramSettings settings = named("once");
  settings.auto_delete = true;
  type.create(settings, {}, now);
  type.call("once", call_of(Method::Reset), now);
  type.call("once", call_of(Method::Halt), now);
  EXPECT_EQ(type.instance_count(), 1u) << "it has not been executed: Ready to Halted ends nothing";
  type.call("once", call_of(Method::Reset), now);
  type.call("once", call_of(Method::Start), now);
  const Outcome ended = type.advance("once", 3, now, {{"parts", std::int64_t{3}}});
  EXPECT_EQ(ended.events.size(), 1u);
  EXPECT_TRUE(ended.deleted);
  EXPECT_EQ(type.instance_count(), 0u);
}

}  // namespace
}  // namespace takt::program::program_type_test
