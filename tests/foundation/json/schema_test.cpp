// SPDX-License-Identifier: Apache-2.0
// The schema against an independent validator (valijson): what decoding accepts validates, and of what decoding refuses
// the schema refuses all that it can express.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "json/fields.hpp"
#include "sample.hpp"
#include "sim/check.hpp"

namespace takt::sample {
namespace {

using valijson::adapters::NlohmannJsonAdapter;

const nlohmann::json& schema_json() {
  static const nlohmann::json schema = nlohmann::json::parse(json::schema<Sample>("A sample"));
  return schema;
}

bool validates(const std::string& text) {
  static const auto schema = [] {
    auto parsed = std::make_unique<valijson::Schema>();
    const NlohmannJsonAdapter adapter(schema_json());
    valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(adapter, *parsed);
    return parsed;
  }();
  const auto value = nlohmann::json::parse(text, nullptr, true, true);
  const NlohmannJsonAdapter adapter(value);
  return valijson::Validator().validate(*schema, adapter, nullptr);
}

bool decodes(const std::string& text) {
  json::Diagnostics diagnostics;
  const auto document = json::parse(text, "s.json", diagnostics);
  Sample sample;
  return document && json::decode(*document, sample, diagnostics);
}

std::string with(const std::string& members) { return "{\"name\": \"x\", " + members + "}"; }

/// valijson takes integers from 2^63 for negative ones: the seed is the largest that it can read.
std::string full_text_for_validator() {
  std::string text(full_text);
  const std::string_view seed = "18446744073709551615";
  return text.replace(text.find(seed), seed.size(), "9223372036854775807");
}

TEST(Schema, AcceptsWhatDecodes) {
  const std::string texts[] = {
      full_text_for_validator(),
      R"({"name": "x"})",
      with(R"("oscillator": "50ppm")"),
      with(R"("oscillator": "+1.5ppb", "captured": ["a", "b"])"),
      with(R"("oscillator": {})"),
      with(R"("captured": "all")"),
      with(R"("level": 5, "weight": 1, "seed": 0)"),
      with(R"("group": {"name": "a", "parts": [{"name": "b", "parts": []}]})"),
      with(R"("faults": [{"crash": "a", "at": "0.5h"}], "phase": "-1s")"),
      with(R"("links": [{"ends": ["a", "b"], "loss": "1e-3"}, {"ends": ["a", "b"], "loss": 0}])"),
      with(R"("group": {"name": "ääääääääää"})"),  // 20 octets, 10 characters
  };
  for (const std::string& text : texts) {
    EXPECT_TRUE(decodes(text)) << text;
    EXPECT_TRUE(validates(text)) << text;
  }
}

TEST(Schema, AcceptsResolvedCopies) {
  json::Diagnostics diagnostics;
  Sample sample;
  const auto document = json::parse(full_text_for_validator(), "s.json", diagnostics);
  ASSERT_TRUE(json::decode(*document, sample, diagnostics));
  EXPECT_TRUE(validates(json::encode(sample)));
}

TEST(Schema, RefusesWrongTypesUnknownKeysAndMissingFields) {
  const std::string texts[] = {
      "[]",
      "{}",
      R"({"nmae": "x"})",
      R"({"name": ""})",
      with(R"("nope": 1)"),
      with(R"("$schema": 1)"),
      with(R"("level": "1")"),
      with(R"("level": 6)"),
      with(R"("level": 1.5)"),
      with(R"("weight": 0)"),
      with(R"("traced": 1)"),
      with(R"("duration": 10)"),
      with(R"("duration": "10")"),
      with(R"("duration": "10 s")"),
      with(R"("duration": "-10s")"),
      with(R"("duration": "1e1s")"),
      with(R"("payload": null)"),
      with(R"("master": [])"),
      with(R"("nodes": [])"),
      with(R"("nodes": {"": {"kind": "host"}})"),
      with(R"("nodes": {"a": {}})"),
      with(R"("nodes": {"a": {"kind": "hots"}})"),
      with(R"("nodes": {"a": {"kind": "switch", "os": "guest"}})"),
      with(R"("nodes": {"a": {"kind": "host", "os": "rt"}})"),
      with(R"("nodes": {"a": {"kind": "host", "ports": [2000, 2000]}})"),
      with(R"("nodes": {"a": {"kind": "host", "ports": [1]}})"),
      with(R"("links": [{"ends": ["a"]}])"),
      with(R"("links": [{"ends": ["a", ""]}])"),
      with(R"("links": [{"ends": ["a", "b"], "rate": "1gbps"}])"),
      with(R"("links": [{"ends": ["a", "b"], "loss": 1.5}])"),
      with(R"("links": [{"ends": ["a", "b"], "loss": -0.5}])"),
      with(R"("links": [{}])"),
      with(R"("oscillator": "1")"),
      with(R"("oscillator": null)"),
      with(R"("oscillator": {"offset": 1})"),
      with(R"("faults": [{"at": "1s"}])"),
      with(R"("faults": [{"at": "1s", "crash": "a", "link_down": ["a", "b"]}])"),
      with(R"("captured": "none")"),
      with(R"("group": {"name": "a", "parts": [{}]})"),
      with(R"("group": {"name": "a", "parts": [{"name": 1}]})"),
      with(R"("group": {"name": "123456789012345678901"})"),
  };
  for (const std::string& text : texts) {
    EXPECT_FALSE(decodes(text)) << text;
    EXPECT_FALSE(validates(text)) << text;
  }
}

TEST(Schema, TellsEditorsWhatTheyShow) {
  const auto& schema = schema_json();
  EXPECT_EQ(schema["$schema"], "http://json-schema.org/draft-07/schema#");
  EXPECT_EQ(schema["title"], "A sample");
  EXPECT_EQ(schema["additionalProperties"], false);
  EXPECT_EQ(schema["required"], nlohmann::json::parse(R"(["name"])"));
  EXPECT_EQ(schema["properties"]["duration"], nlohmann::json::parse(R"x({
    "description": "How long it runs. (a duration above 0s and up to 1h)", "type": "string",
    "pattern": "^[0-9]+(\\.[0-9]+)?(ps|ns|us|ms|s|min|h)$", "default": "10s"})x"));
  EXPECT_EQ(schema["properties"]["phase"], nlohmann::json::parse(R"x({
    "description": "Where it starts. (a duration from -1s to 1s)", "type": "string",
    "pattern": "^-?[0-9]+(\\.[0-9]+)?(ps|ns|us|ms|s|min|h)$"})x"));
  EXPECT_EQ(schema["properties"]["oscillator"], nlohmann::json::parse(R"x({
    "description": "Of all nodes.", "allOf": [{"$ref": "#/definitions/oscillator"}]})x"));
  EXPECT_EQ(schema["properties"]["level"], nlohmann::json::parse(R"x({
    "description": "Any integer will do.", "type": "integer", "minimum": -5, "maximum": 5, "default": 0})x"));
  const auto& host = schema["definitions"]["node"]["oneOf"][0];
  EXPECT_EQ(host["properties"]["kind"], nlohmann::json::parse(R"x({"const": "host"})x"));
  EXPECT_EQ(host["properties"]["os"], nlohmann::json::parse(R"x({
    "description": "What it runs. \"preempt-rt\": Linux with PREEMPT_RT. \"general-purpose\": An office computer. \"guest\": A virtual machine.",
    "type": "string", "enum": ["preempt-rt", "general-purpose", "guest"], "default": "preempt-rt"})x"));
}

TEST(Table, ContradictionsAreBroken) {
  static constexpr json::Field twice[] = {json::optional<&Switch::queues>("a", "x."),
                                          json::optional<&Switch::delay>("a", "x.")};
  EXPECT_THROW(json::check_table(json::object<Switch>("s", "x.", twice)), sim::InvariantBroken);
  static constexpr json::Field needed[] = {json::required<&Switch::queues>("a", "x."),
                                           json::optional<&Switch::delay>("b", "x.")};
  EXPECT_THROW(json::check_table(json::object<Switch>("s", "x.", needed, {.shorthand = "b"})), sim::InvariantBroken);
  EXPECT_THROW(json::check_table(json::object<Switch>("s", "x.", needed, {.shorthand = "c"})), sim::InvariantBroken);
  static constexpr std::string_view names[] = {"b", "c"};
  static constexpr json::Group groups[] = {json::at_most_one_of(names)};
  EXPECT_THROW(json::check_table(json::object<Switch>("s", "x.", needed, {.groups = groups})), sim::InvariantBroken);
  EXPECT_NO_THROW(json::check_table(json::object<Switch>("s", "x.", needed, {.shorthand = "a"})));
}

}  // namespace
}  // namespace takt::sample
