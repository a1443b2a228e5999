// SPDX-License-Identifier: Apache-2.0
// The chain of a reaction, where its links can be worked out by hand.
#include <gtest/gtest.h>

#include "explain/ask.hpp"
#include "scenario/resolve.hpp"

namespace takt::explain {
namespace {

constexpr sim::Duration us(std::int64_t n) { return sim::Duration::from_ps(n * 1'000'000); }

/// A halt that `b` is called for, with this security of its Program. Operating systems take no time.
ExplainedReaction halt_with(const std::string& security) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(R"({"name": "halt", "duration": "200ms",
    "network": {"nodes": {"a": {"kind": "host", "os": "none", "cryptography": {"seal": "20us", "open": "70us"}}, "b": {"kind": "host", "os": "none", "cryptography": {"seal": "30us", "open": "90us"}}},
                "links": [{"ends": ["a", "b"]}]},
    "programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms")" +
                                                security + R"(}],
    "script": [{"at": "20ms", "program": "p", "call": "Start"}, {"at": "100.25ms", "program": "p", "call": "Halt", "on": "b"}]})",
                                            "halt.json", {}, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  const auto found = explain_reaction(*resolved, {.kind = scenario::Reaction::halt}, TrueTime());
  EXPECT_TRUE(found);
  return found.value_or(ExplainedReaction{});
}

TEST(Reactions, AWordMovesWhoHasOpenedIt) {
  const ExplainedReaction clear = halt_with("");
  ASSERT_EQ(clear.steps.size(), 2u);
  EXPECT_EQ(clear.steps[0].what, "wait for the next publication");
  EXPECT_EQ(clear.steps[1].what, "message");
  const ExplainedReaction secured = halt_with(R"(, "security": "sign")");
  ASSERT_EQ(secured.steps.size(), 3u);
  EXPECT_EQ(secured.steps[0].what, "wait for the next publication");
  EXPECT_EQ(secured.steps[0].takes, clear.steps[0].takes);
  ASSERT_TRUE(secured.steps[1].message);
  EXPECT_EQ(secured.steps[1].message->hops.front().takes(), us(30)) << "sealed at b";
  // 46 octets more at 1 Gbit/s, and sealing.
  EXPECT_EQ(secured.steps[1].takes, clear.steps[1].takes + us(30) + sim::Duration::from_ps(46 * 8'000));
  EXPECT_EQ(secured.steps[2].what, "opening the message");
  EXPECT_EQ(secured.steps[2].who, "a");
  EXPECT_EQ(secured.steps[2].takes, us(70));
}

}  // namespace
}  // namespace takt::explain
