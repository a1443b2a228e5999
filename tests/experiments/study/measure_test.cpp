// SPDX-License-Identifier: Apache-2.0
#include "study/measure.hpp"

#include <gtest/gtest.h>

#include "json/document.hpp"

namespace takt::study {
namespace {

json::Node result() {
  json::Diagnostics diagnostics;
  return json::parse(R"({"verdict": "pass", "events": 7, "dropped": {"loss": 3, "queue": 4},
    "streams": {"a/b": {"delivered": 5, "latency_ps": {"max": 2500000, "p99": 2000000}}, "c": {"delivered": 0, "latency_ps": null}},
    "programs": {"p": {"violations": [], "reactions": [
      {"kind": "start", "superseded": false, "duration_ps": 1000000}, {"kind": "start", "superseded": false, "duration_ps": 3000000},
      {"kind": "start", "superseded": true, "duration_ps": null}, {"kind": "halt", "superseded": false, "duration_ps": null}]}},
    "ports": [{"utilisation": 0.25}, {"utilisation": 0.5}]})",
                     "result", diagnostics)
      ->root();
}

std::optional<double> figure(const std::string& of, const std::string& unit = "", json::NameMap<Value> only = {},
                             Take take = Take::max) {
  Measure measure;
  measure.name = "m";
  measure.of = of;
  measure.unit = unit;
  measure.only = std::move(only);
  measure.take = take;
  json::Diagnostics diagnostics;
  const auto planned = plan_measure(measure, diagnostics);
  EXPECT_TRUE(planned) << diagnostics.to_text();
  return planned ? value_of(*planned, result()) : std::nullopt;
}

TEST(Measure, ShortFormsAndPointers) {
  EXPECT_EQ(figure("reaction.start.max", "us"), 3.0);
  EXPECT_EQ(figure("reaction.start.min", "us"), 1.0);
  EXPECT_EQ(figure("reaction.start.mean", "us"), 2.0);
  EXPECT_EQ(figure("reaction.start.count"), 2.0) << "a superseded one does not count";
  EXPECT_EQ(figure("reaction.halt.max"), std::nullopt) << "one that never was complete has no greatest duration";
  EXPECT_EQ(figure("reaction.reset.max"), std::nullopt) << "there was none";
  EXPECT_EQ(figure("latency.a/b.max", "ns"), 2500.0);
  EXPECT_EQ(figure("latency.max", "us"), std::nullopt) << "stream c has delivered nothing";
  EXPECT_EQ(figure("dropped"), 7.0);
  EXPECT_EQ(figure("violations"), 0.0);
  EXPECT_EQ(figure("verdict"), 1.0);
  EXPECT_EQ(figure("utilisation", "%"), 50.0);
  EXPECT_EQ(figure("/streams/a~1b/latency_ps/p99"), 2.0) << "times are in us unless they say";
  EXPECT_EQ(figure("/ports/*/utilisation", "", {}, Take::sum), 0.75);
  EXPECT_EQ(figure("/ports/1/utilisation"), 0.5);
  EXPECT_EQ(figure("/dropped/link_loss"), 0.0) << "reasons that did not occur are not in a result";
  Value start;
  start.node = json::Node::of_string("start");
  EXPECT_EQ(figure("/programs/*/reactions/*/duration_ps", "", {{"kind", start}}, Take::count), 2.0);
}

TEST(Measure, MistakesAreTold) {
  const auto problem = [](const std::string& of, const std::string& unit) {
    Measure measure;
    measure.name = "m";
    measure.of = of;
    measure.unit = unit;
    json::Diagnostics diagnostics;
    EXPECT_FALSE(plan_measure(measure, diagnostics));
    return diagnostics.to_text();
  };
  EXPECT_NE(problem("droped", "").find("did you mean \"dropped\"?"), std::string::npos);
  EXPECT_NE(problem("reaction.stop.max", "").find("unknown figure"), std::string::npos);
  EXPECT_NE(problem("dropped", "us").find("a unit of time for what is no time"), std::string::npos);
  EXPECT_NE(problem("latency.max", "frames").find("not a unit of time"), std::string::npos);
  EXPECT_NE(problem("/nothing/there", "").find("unknown figure"), std::string::npos);
  EXPECT_NE(problem("/streams/a/delivred", "").find("did you mean \"delivered\"?"), std::string::npos);
  EXPECT_NE(problem("/ports/*/node", "").find("a figure that is no number"), std::string::npos);
}

TEST(Limit, IsInTheMeasuresUnit) {
  json::Diagnostics diagnostics;
  Measure measure;
  measure.name = "start";
  measure.of = "reaction.start.max";
  measure.unit = "us";
  const std::vector<PlannedMeasure> measures = {*plan_measure(measure, diagnostics)};
  Limit limit;
  limit.measure = "start";
  limit.at_most.emplace();
  limit.at_most->node = json::Node::of_string("1ms");
  const auto planned = plan_limit(limit, measures, diagnostics);
  ASSERT_TRUE(planned) << diagnostics.to_text();
  EXPECT_EQ(planned->value, 1000);
  EXPECT_TRUE(planned->holds(1000.0));
  EXPECT_FALSE(planned->holds(1000.1));
  EXPECT_FALSE(planned->holds(std::nullopt)) << "what is missing does not keep a limit";
  limit.at_most->node = json::Node::of_string("1Gbps");
  EXPECT_FALSE(plan_limit(limit, measures, diagnostics));
}

}  // namespace
}  // namespace takt::study
