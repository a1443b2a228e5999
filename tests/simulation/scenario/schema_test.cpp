// SPDX-License-Identifier: Apache-2.0
// The schema beside the scenarios is the generated one, and an independent validator agrees with it.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "bad_input.hpp"
#include "support.hpp"

namespace takt::scenario::test {
namespace {

using valijson::adapters::NlohmannJsonAdapter;

std::string content(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}
std::string generated_schema() { return json::schema<Scenario>("takt scenario"); }

bool validates(const std::string& text) {
  static const nlohmann::json source = nlohmann::json::parse(generated_schema());
  static const auto schema = [] {
    auto parsed = std::make_unique<valijson::Schema>();
    const NlohmannJsonAdapter adapter(source);
    valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(adapter, *parsed);
    return parsed;
  }();
  const auto value = nlohmann::json::parse(text, nullptr, true, true);
  const NlohmannJsonAdapter adapter(value);
  return valijson::Validator().validate(*schema, adapter, nullptr);
}

// To renew it: takt schema > scenarios/takt.schema.json
TEST(ScenarioSchema, TheCommittedOneIsTheGeneratedOne) {
  EXPECT_EQ(content(std::string(TAKT_SOURCE_DIR) + "/scenarios/takt.schema.json"), generated_schema());
}

// A member that stands twice would be read as the last one, silently.
TEST(ScenarioSchema, HasNoMemberTwice) {
  std::vector<std::set<std::string>> open;
  const auto is_new = [&](int, nlohmann::json::parse_event_t event, nlohmann::json& value) {
    if (event == nlohmann::json::parse_event_t::object_start) open.emplace_back();
    if (event == nlohmann::json::parse_event_t::object_end) open.pop_back();
    if (event == nlohmann::json::parse_event_t::key) {
      EXPECT_TRUE(open.back().insert(value.get<std::string>()).second) << value;
    }
    return true;
  };
  EXPECT_TRUE(nlohmann::json::parse(generated_schema(), is_new).is_object());
}

TEST(ScenarioSchema, AcceptsEveryShippedScenario) {
  for (const std::string& name : shipped_names()) EXPECT_TRUE(validates(content(shipped_path(name)))) << name;
}

TEST(ScenarioSchema, AcceptsResolvedCopies) {
  for (const std::string& name : shipped_names()) EXPECT_TRUE(validates(json::encode(shipped(name)->scenario))) << name;
}

TEST(ScenarioSchema, RefusesWrongTypesUnknownKeysAndWrongUnits) {
  EXPECT_TRUE(validates(scenario_with(R"("seed": 1)")));
  for (const char* members : {R"("seed": "five")", R"("seed": -1)", R"("sede": 1)", R"("description": 5)",
                              R"("allow_overload": 1)", R"("clocks": "gptp")"})
    EXPECT_FALSE(validates(scenario_with(members))) << members;
  for (const char* duration : {"10", "\"10\"", "\"10 ms\"", "\"10m\"", "\"-1s\""})
    EXPECT_FALSE(validates(with_duration(duration))) << duration;
  EXPECT_FALSE(validates(with_node(R"({"kind": "hosst"})")));
  EXPECT_FALSE(validates(with_node(R"({"kind": "host", "forwarding_delay": "1us"})")));
  EXPECT_FALSE(validates(with_links(R"({"ends": ["a"]})")));
  EXPECT_FALSE(validates(generated_text(R"("topology": "torus")")));
  EXPECT_FALSE(validates(with_streams(R"({"name": "s", "from": "a", "to": "b"})")));
  EXPECT_FALSE(validates(with_programs(R"({"name": "p", "master": "a", "slaves": [], "cycle": "1ms"})")));
  EXPECT_FALSE(validates(with_script(R"({"at": "1us", "program": "p", "call": "start"})")));
  EXPECT_FALSE(validates(with_requirement(R"({"within": "1ms"})")));
}

}  // namespace
}  // namespace takt::scenario::test
