// SPDX-License-Identifier: Apache-2.0
// Decoding by tables: what is read, and that all mistakes of a text are told at once with their places.
#include "json/fields.hpp"

#include <gtest/gtest.h>

#include "sample.hpp"

namespace takt::sample {
namespace {

using json::Diagnostics;

Sample must_decode(std::string_view text) {
  Diagnostics diagnostics;
  const auto document = json::parse(text, "s.json", diagnostics);
  Sample sample;
  EXPECT_TRUE(document && json::decode(*document, sample, diagnostics)) << diagnostics.to_text();
  return sample;
}

std::string mistakes(std::string_view text) {
  Diagnostics diagnostics;
  const auto document = json::parse(text, "s.json", diagnostics);
  Sample sample;
  EXPECT_FALSE(document && json::decode(*document, sample, diagnostics)) << text;
  return diagnostics.to_text();
}

/// The mistake of a text of one line, without its place.
std::string mistake_in(std::string_view field_and_value) {
  const std::string text = mistakes("{\"name\": \"x\", " + std::string(field_and_value) + "}");
  const std::size_t start = text.find("error");
  EXPECT_EQ(text.find('\n'), text.size() - 1) << text;
  return start == std::string::npos ? text : text.substr(start, text.size() - 1 - start);
}

TEST(Decode, EveryKindOfField) {
  const Sample s = must_decode(full_text);
  EXPECT_EQ(s.name, "full");
  EXPECT_EQ(s.seed, 18'446'744'073'709'551'615U);
  EXPECT_EQ(s.level, -5);
  EXPECT_EQ(s.weight, 0.25);
  EXPECT_TRUE(s.traced);
  EXPECT_EQ(s.duration.ps(), 1'500'000'000);
  EXPECT_EQ(s.phase->ps(), -20'000'000);
  EXPECT_EQ(s.payload.count, 1500U);
  EXPECT_EQ(s.master.value, "a");
  ASSERT_EQ(s.nodes.size(), 3U);
  EXPECT_EQ(s.nodes[0].first, "a");
  EXPECT_EQ(std::get<Host>(s.nodes[0].second).os, Os::guest);
  EXPECT_EQ(std::get<Host>(s.nodes[0].second).ports, (std::vector<std::uint16_t>{4840, 4841}));
  EXPECT_EQ(std::get<Switch>(s.nodes[2].second).queues, 4);
  ASSERT_EQ(s.links.size(), 2U);
  EXPECT_EQ(s.links[0].rate.bits_per_second, 2'500'000'000U);
  EXPECT_EQ(s.links[0].length.millimetres, 200);
  EXPECT_EQ(s.links[0].loss->parts_per_quintillion, 1'000'000'000'000'000);
  EXPECT_EQ(s.links[1].loss->parts_per_quintillion, 1'000'000);
  EXPECT_EQ(s.oscillator.offset.parts_per_trillion, -50'000'000);
  EXPECT_EQ(s.oscillator.drift.parts_per_trillion_per_second, 1'500);
  EXPECT_EQ(s.faults[0].link_down, (std::vector<std::string>{"a", "sw"}));
  EXPECT_EQ(s.faults[1].crash, "b");
  EXPECT_TRUE(s.captured.all);
  EXPECT_EQ(s.group->parts.at(0).parts.at(0).name, "robot");
}

TEST(Decode, WhatIsNotWrittenKeepsItsDefault) {
  Sample expected;
  expected.name = "x";
  EXPECT_EQ(must_decode(R"({"name": "x"})"), expected);
}

TEST(Decode, ShorthandStandsForOneField) {
  const Sample s = must_decode(R"({"name": "x", "oscillator": "50ppm", "captured": ["l"]})");
  EXPECT_EQ(s.oscillator.offset.parts_per_trillion, 50'000'000);
  EXPECT_EQ(s.captured.names, std::vector<std::string>{"l"});
}

TEST(Decode, AllMistakesAreToldAtOnce) {
  EXPECT_EQ(
      mistakes(R"({
  "nmae": "x",
  "level": 6,
  "duration": "10 s",
  "links": [
    {"ends": ["a"], "rate": "1gbps", "lenght": "10m"},
    {"rate": 1000000000, "loss": 1.5}
  ],
  "nodes": {"a": {"kind": "hots"}, "b": {}, "c": {"kind": "switch", "os": "guest"}, "d": {"kind": "host", "os": "rt"}},
  "traced": "yes",
  "seed": -1, "seed": 2
})"),
      "s.json:1:1: error: the field \"name\" is missing\n"
      "s.json:2:3: error at /nmae: unknown field \"nmae\" (did you mean \"name\"?)\n"
      "s.json:3:12: error at /level: out of range: found the number 6, expected an integer from -5 to 5\n"
      "s.json:4:15: error at /duration: a space in a quantity: found \"10 s\", expected a duration such as \"200us\" "
      "(did you mean \"10s\"?)\n"
      "s.json:6:14: error at /links/0/ends: too few items: found 1, expected exactly 2 items\n"
      "s.json:6:29: error at /links/0/rate: unknown unit \"gbps\": found \"1gbps\", expected one of the units bps, "
      "kbps, Mbps, Gbps, Tbps (did you mean \"1Gbps\"?)\n"
      "s.json:6:38: error at /links/0/lenght: unknown field \"lenght\" (did you mean \"length\"?)\n"
      "s.json:7:5: error at /links/1: the field \"ends\" is missing\n"
      "s.json:7:14: error at /links/1/rate: wrong type: found the number 1000000000, expected a data rate such as the "
      "string \"1Gbps\"\n"
      "s.json:7:34: error at /links/1/loss: too large: found 1.5, expected a probability from 0 to 1 of at most 1\n"
      "s.json:9:27: error at /nodes/a/kind: unknown kind: found \"hots\", expected \"host\" or \"switch\" (did you "
      "mean \"host\"?)\n"
      "s.json:9:41: error at /nodes/b: the field \"kind\" is missing: expected \"host\" or \"switch\"\n"
      "s.json:9:69: error at /nodes/c/os: unknown field \"os\": expected one of \"kind\", \"queues\" or \"delay\"\n"
      "s.json:9:113: error at /nodes/d/os: unknown name for an operating system: found \"rt\", expected "
      "\"preempt-rt\", \"general-purpose\" or \"guest\"\n"
      "s.json:10:13: error at /traced: wrong type: found the string \"yes\", expected true or false\n"
      "s.json:11:11: error at /seed: out of range: found the number -1, expected an integer from 0 to "
      "18446744073709551615\n"
      "s.json:11:15: error at /seed: the name \"seed\" occurs twice: expected one value (the first is in line 11, "
      "column 3)\n");
}

TEST(Decode, WrongTypes) {
  EXPECT_EQ(mistakes("[]"), "s.json:1:1: error: wrong type: found an empty array, expected an object\n");
  EXPECT_EQ(mistake_in(R"("links": {})"), "error at /links: wrong type: found an object, expected an array");
  EXPECT_EQ(mistake_in(R"("nodes": [1, 2])"),
            "error at /nodes: wrong type: found an array of 2, expected an object whose members are named freely");
  EXPECT_EQ(mistake_in(R"("level": 1.5)"),
            "error at /level: not an integer: found the number 1.5, expected an integer from -5 to 5");
  EXPECT_EQ(mistake_in(R"("level": 1e0)"),
            "error at /level: not an integer: found the number 1e0, expected an integer from -5 to 5");
  EXPECT_EQ(mistake_in(R"("level": "1")"),
            "error at /level: wrong type: found the string \"1\", expected an integer from -5 to 5");
  EXPECT_EQ(mistake_in(R"("weight": null)"),
            "error at /weight: wrong type: found null, expected a number above 0 and up to 1");
  EXPECT_EQ(mistake_in(R"("master": 7)"), "error at /master: wrong type: found the number 7, expected a string");
  EXPECT_EQ(mistake_in(R"("duration": true)"),
            "error at /duration: wrong type: found true, expected a duration such as \"200us\"");
  EXPECT_EQ(mistake_in(R"("oscillator": null)"), "error at /oscillator: wrong type: found null, expected an object");
  EXPECT_EQ(mistake_in(R"("oscillator": "1")"),
            "error at /oscillator: missing unit: found \"1\", expected one of the units ppt, ppb, ppm, %");
  EXPECT_EQ(mistake_in(R"("captured": "none")"),
            "error at /captured: not a selection: found \"none\", expected \"all\" or an array of names");
  EXPECT_EQ(mistake_in(R"("nodes": {"a": {"kind": 1}})"),
            "error at /nodes/a/kind: wrong type: found the number 1, expected \"host\" or \"switch\"");
  EXPECT_EQ(mistake_in(R"("$schema": 1)"),
            "error at /$schema: wrong type: found the number 1, expected a string that names a JSON Schema");
}

TEST(Decode, Ranges) {
  EXPECT_EQ(mistake_in(R"("seed": 18446744073709551616)"),
            "error at /seed: out of range: found the number 18446744073709551616, expected an integer from 0 to "
            "18446744073709551615");
  EXPECT_EQ(mistake_in(R"("seed": 99999999999999999999999999999999999999999999)"),
            "error at /seed: out of range: found the number 9999999999999999999999999999999999999999, expected an "
            "integer from 0 to 18446744073709551615");
  EXPECT_EQ(mistake_in(R"("weight": 0)"),
            "error at /weight: out of range: found 0, expected a number above 0 and up to 1");
  EXPECT_EQ(mistake_in(R"("duration": "0s")"),
            "error at /duration: out of range: found \"0s\", expected a duration above 0s and up to 1h");
  EXPECT_EQ(mistake_in(R"("duration": "-1s")"),
            "error at /duration: negative: found \"-1s\", expected a duration that is not negative");
  EXPECT_EQ(mistake_in(R"("phase": "-2s")"),
            "error at /phase: out of range: found \"-2s\", expected a duration from -1s to 1s");
  EXPECT_EQ(mistake_in(R"("payload": "2KiB")"),
            "error at /payload: out of range: found \"2KiB\", expected a size from 46B to 1500B");
  EXPECT_EQ(mistake_in(R"("links": [{"ends": ["a", "b"], "rate": "1kbps"}])"),
            "error at /links/0/rate: out of range: found \"1kbps\", expected a data rate of at least 10Mbps");
  EXPECT_EQ(mistake_in(R"("links": [{"ends": ["a", ""]}])"),
            "error at /links/0/ends/1: an empty string: found the string \"\", expected at least 1 octets");
  EXPECT_EQ(mistake_in(R"("group": {"name": "123456789012345678901"})"),
            "error at /group/name: a string that is too long: found 21 octets, expected at most 20");
  EXPECT_EQ(mistake_in(R"("nodes": {"a": {"kind": "host", "ports": [1, 2000]}})"),
            "error at /nodes/a/ports/0: out of range: found the number 1, expected an integer from 1024 to 65535");
  EXPECT_EQ(mistake_in(R"("nodes": {"a": {"kind": "host", "ports": [2000, 3000, 2000]}})"),
            "error at /nodes/a/ports/2: occurs twice: found the number 2000, expected items that differ");
  EXPECT_EQ(mistake_in(R"("nodes": {"a": {"kind": "host", "ports": [2000, 3000, 4000, 5000]}})"),
            "error at /nodes/a/ports: too many items: found 4, expected at most 3 items");
  EXPECT_EQ(mistake_in(R"("nodes": {"": {"kind": "host"}})"), "error at /nodes/: an empty name");
}

TEST(Decode, AValueOrAuto) {
  const auto decode = [](std::string_view text, Diagnostics& diagnostics) {
    json::OrAuto<sim::Duration> value(sim::Duration::from_ps(7));
    const auto document = json::parse(text, "s.json", diagnostics);
    json::Reader reader(*document, diagnostics);
    const auto bounds = json::bounds_of<json::OrAuto<sim::Duration>>({.max = sim::Duration::from_ps(1'000'000)});
    json::CodecOf<json::OrAuto<sim::Duration>>::codec.decode(document->root(), &value, bounds, reader);
    return value;
  };
  Diagnostics diagnostics;
  const auto number = decode("\"1us\"", diagnostics);
  EXPECT_FALSE(number.is_auto);
  EXPECT_EQ(number, sim::Duration::from_ps(1'000'000));
  const auto word = decode("\"auto\"", diagnostics);
  EXPECT_TRUE(word.is_auto);
  EXPECT_FALSE(word == sim::Duration::from_ps(7)) << "what is to be chosen equals no number";
  EXPECT_EQ(json::CodecOf<json::OrAuto<sim::Duration>>::codec.encode(&word).text, "auto");
  EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.to_text();
  decode("\"2us\"", diagnostics);
  EXPECT_TRUE(diagnostics.has_errors()) << "the range is that of numbers";
}

TEST(Decode, Groups) {
  EXPECT_EQ(mistake_in(R"("faults": [{"at": "1s"}])"),
            "error at /faults/0: a field is missing: expected exactly one of \"link_down\" or \"crash\"");
  EXPECT_EQ(mistake_in(R"("faults": [{"at": "1s", "crash": "a", "link_down": ["a", "b"]}])"),
            "error at /faults/0/crash: fields that exclude each other: found \"crash\" beside \"link_down\", expected "
            "exactly one of \"link_down\" or \"crash\"");
}

TEST(Decode, MistakesBeyondTheLimitAreCounted) {
  std::string text = "{\"name\": \"x\", \"faults\": [0";
  for (int i = 1; i < 150; ++i) text += ", 0";
  const std::string all = mistakes(text + "]}");
  EXPECT_NE(all.find("... and 50 more\n"), std::string::npos);
}

TEST(Source, ChecksOfMeaningReportPlaces) {
  Diagnostics diagnostics;
  const auto document = json::parse(R"({"name": "x",
    "nodes": {"a": {"kind": "host"}},
    "links": [{"ends": ["a",
                        "b"]}]})",
                                    "s.json", diagnostics);
  Sample sample;
  ASSERT_TRUE(json::decode(*document, sample, diagnostics));
  check(sample, diagnostics);
  EXPECT_EQ(diagnostics.to_text(),
            "s.json:4:25: error at /links/0/ends/1: no such node: found \"b\", expected the name of a node\n");
}

TEST(Source, PlacesOfPartsAndDefaults) {
  Sample s;
  {
    Diagnostics diagnostics;
    const auto document = json::parse(
        "{\"name\": \"x\", \"master\": \"m\",\n \"links\": [{\"ends\": [\"a\", \"b\"]}],\n \"oscillator\": \"1ppm\"}",
        "s.json", diagnostics);
    ASSERT_TRUE(json::decode(*document, s, diagnostics));
  }  // the document is gone, the places stay
  const Link& link = s.links.at(0);
  EXPECT_EQ(link.where.place(), (json::Place{"s.json", 2, 12, "/links/0"}));
  EXPECT_EQ(link.where.at("ends"), (json::Place{"s.json", 2, 21, "/links/0/ends"}));
  EXPECT_EQ(link.where.at("ends", 1), (json::Place{"s.json", 2, 27, "/links/0/ends/1"}));
  EXPECT_EQ(link.where.key("ends"), (json::Place{"s.json", 2, 13, "/links/0/ends"}));
  EXPECT_EQ(link.where.at("rate"), (json::Place{"s.json", 2, 12, "/links/0/rate"}));  // not written: where it belongs
  EXPECT_TRUE(link.where.has("ends"));
  EXPECT_FALSE(link.where.has("rate"));
  EXPECT_EQ(s.master.where.place(), (json::Place{"s.json", 1, 25, "/master"}));
  EXPECT_EQ(s.oscillator.where.at("offset"), (json::Place{"s.json", 3, 16, "/oscillator"}));
  EXPECT_EQ(s.where.at("links", 0), link.where.place());

  EXPECT_FALSE(Link{}.where.is_known());
  EXPECT_EQ(Link{}.where.at("rate"), (json::Place{"", 0, 0, "/rate"}));
}

TEST(Encode, DefaultsAreFilledInAndAbsentOnesLeftOut) {
  Sample s;
  s.name = "x";
  s.links.push_back({{}, {"a", "b"}, {}, {}, {}});
  s.nodes.emplace_back("a", Switch{});
  EXPECT_EQ(json::encode(s), R"({
  "name": "x",
  "seed": 1,
  "level": 0,
  "weight": 0.5,
  "traced": false,
  "duration": "10s",
  "payload": "100B",
  "master": "",
  "nodes": {
    "a": {
      "kind": "switch",
      "queues": 8,
      "delay": "1us"
    }
  },
  "links": [
    {
      "ends": ["a", "b"],
      "rate": "0bps",
      "length": "0m"
    }
  ],
  "oscillator": {
    "offset": "0ppm",
    "drift": "0ppm/s"
  },
  "faults": [],
  "captured": []
}
)");
}

TEST(Encode, ReadsBackAsTheSame) {
  const Sample once = must_decode(full_text);
  const std::string text = json::encode(once);
  const Sample twice = must_decode(text);
  EXPECT_EQ(once, twice);
  EXPECT_EQ(json::encode(twice), text);
}

}  // namespace
}  // namespace takt::sample
