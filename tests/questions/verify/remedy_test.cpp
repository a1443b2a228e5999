// SPDX-License-Identifier: Apache-2.0
// What would help, where that can be worked out by hand.
#include "verify/remedy.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/questions/verify/support.hpp"
#include "verify/report.hpp"

namespace takt::verify::remedy_test {
namespace {

using sim::Duration;

// A frame with a payload of p octets has, with its preamble and a VLAN tag, 58 + p octets: at 1 Gbit/s (58 + p) * 8 ns,
// and 50 ns of cable. 1000 octets take 8514 ns. Within 5 us come 560: 618 * 8 + 50 = 4994 ns. At 2.5 Gbit/s an octet
// lasts 3.2 ns: 1058 * 3.2 + 50 = 3435.6 ns. There is nobody else, so neither load nor priority helps.
constexpr const char* alone =
    R"({"name": "alone", "duration": "10ms", "network": {"nodes": {"a": {"kind": "host", "os": "none"},
      "b": {"kind": "host", "os": "none"}},
  "links": [{"ends": ["a", "b"], "rate": "1Gbps", "length": "10m"}]},
  "streams": [{"name": "s", "from": "a", "to": "b", "payload": "1000B", "every": "1ms", "pcp": 3}],
      "require": [{"stream": "s", "latency": "5us"}]})";

TEST(Remedies, GreatestPayloadAndLeastRate) {
  const auto scenario = resolved(alone);
  Options options = small();
  options.helps = true;
  const Verification found = verify(*scenario, options);
  ASSERT_EQ(found.lines.size(), 1u);
  const Line& line = found.lines[0];
  EXPECT_EQ(line.verdict, Conclusion::refuted);
  std::vector<std::string> texts;
  for (const Remedy& remedy : line.remedies)
    texts.push_back(remedy.what + " " + remedy.value + " " + std::to_string(remedy.bound.ps()));
  EXPECT_EQ(texts, (std::vector<std::string>{"payload of s at most 560B 4994000",
                                             "rate of all links at least 2.5Gbps 3435600"}));
  ASSERT_FALSE(line.weighty.empty());
  EXPECT_EQ(line.weighty[0].where, "a:0 to b");
  EXPECT_EQ(line.weighty[0].what, "transmission");
  EXPECT_EQ(line.weighty[0].takes, Duration::from_ps(8'464'000));
  const std::string page = text_report("alone", found, {""});
  EXPECT_NE(page.find("would be proved with: payload of s at most 560B (bound 4.994 us)"), std::string::npos) << page;
  EXPECT_NE(page.find("most of the worst run: 8.464 us at a:0 to b (transmission)"), std::string::npos) << page;
}

// An entry may ask for several figures, so that figures and entries are not numbered alike.
TEST(Remedies, OfTheEntryThatAsksForTheFigure) {
  std::string several = alone;
  several.replace(
      several.find(R"([{"stream": "s")"), std::string::npos,
      R"([{"stream": "s", "latency": "9us", "dropped": 0}, {"stream": "s", "jitter": "1us", "latency": "5us",
      "dropped": 0}]})");
  const auto scenario = resolved(several.c_str());
  Options options = small();
  options.helps = true;
  const Verification found = verify(*scenario, options);
  std::vector<std::string> of_refuted;
  for (const Line& line : found.lines) {
    if (line.verdict != Conclusion::refuted) continue;
    EXPECT_EQ(line.requirement.text, "stream s latency at most 5us");
    for (const Remedy& remedy : line.remedies) of_refuted.push_back(remedy.what + " " + remedy.value);
  }
  EXPECT_EQ(of_refuted, (std::vector<std::string>{"payload of s at most 560B", "rate of all links at least 2.5Gbps"}));
}

// An exact latency of 8 us: with 939 octets the bound is within it, but no frame takes so long (7.994 us); at 2.5
// Gbit/s none does either. A bound that is within the limit is not enough.
TEST(Remedies, NoneThatWouldBeRefuted) {
  json::Diagnostics diagnostics;
  const auto scenario = scenario::load_file(
      std::string(TAKT_SOURCE_DIR) + "/tests/findings/hint-of-an-exact-latency.json", {}, diagnostics);
  ASSERT_TRUE(scenario) << diagnostics.to_text();
  Options options = small();
  options.helps = true;
  const Verification found = verify(*scenario, options);
  EXPECT_EQ(found.lines[0].verdict, Conclusion::refuted);
  EXPECT_TRUE(found.lines[0].remedies.empty())
      << found.lines[0].remedies[0].what << " " << found.lines[0].remedies[0].value;
}

// What is said is taken at its word: each change, made by hand, is proved by takt verify.
TEST(Remedies, EachIsProvedWhenItIsTried) {
  const std::string text =
      R"({"name": "busy", "duration": "20ms", "network": {"nodes": {"a": {"kind": "host", "os": "none"},
      "b": {"kind": "host", "os": "none"}, "c": {"kind": "host", "os": "none"}, "s": {"kind": "switch"}},
    "links": [{"ends": ["a", "s"], "rate": "100Mbps"}, {"ends": ["b", "s"], "rate": "100Mbps"}, {"ends": ["c", "s"],
      "rate": "100Mbps"}]},
    "streams": [{"name": "x", "from": "a", "to": "c", "payload": "500B", "every": "1ms", "pcp": 3}, {"name": "y",
      "from": "b", "to": "c", "payload": "700B", "every": "1ms", "pcp": 3}],
    "require": [{"stream": "x", "latency": "130us"}]})";
  Options options = small();
  options.helps = true;
  const Verification found = verify(*resolved(text), options);
  ASSERT_NE(found.lines[0].verdict, Conclusion::pass);
  ASSERT_FALSE(found.lines[0].remedies.empty());
  for (const Remedy& remedy : found.lines[0].remedies) {
    std::vector<std::string> sets;
    if (remedy.what.starts_with("payload")) sets = {"/streams/0/payload=" + remedy.value};
    if (remedy.what.starts_with("priority")) sets = {"/streams/0/pcp=" + remedy.value.substr(4)};
    if (remedy.what.starts_with("rate"))
      sets = {"/network/links/0/rate=" + remedy.value, "/network/links/1/rate=" + remedy.value,
              "/network/links/2/rate=" + remedy.value};
    if (sets.empty()) continue;
    json::Diagnostics diagnostics;
    const auto changed = scenario::load_text(text, "test", sets, diagnostics);
    ASSERT_TRUE(changed) << diagnostics.to_text();
    EXPECT_EQ(verify(*changed, small()).lines[0].verdict, Conclusion::pass) << remedy.what << " " << remedy.value;
  }
}

/// The same with the change, by as many runs as without it.
Conclusion with(const scenario::Resolved& scenario, const Remedy& remedy, std::size_t line, const Options& options) {
  scenario::Scenario changed = scenario.scenario;
  remedy.apply(changed);
  json::Diagnostics diagnostics;
  const auto again = scenario::resolve(std::move(changed), diagnostics);
  EXPECT_TRUE(again) << diagnostics.to_text();
  return again ? verify(*again, options).lines[line].verdict : Conclusion::contradiction;
}

// The time is within the limit, but a queue of 1000 octets may be full of two frames of 722 octets: nobody knows that
// none is lost. It takes both if x has at most 278 octets, tag and FCS included, and less by what comes in meanwhile.
TEST(Remedies, WhereFramesMayBeLostAndTheBoundIsWithinTheLimit) {
  const auto scenario = resolved(
      R"({"name": "busy", "duration": "20ms", "network": {"nodes": {"a": {"kind": "host", "os": "none"},
      "b": {"kind": "host", "os": "none"},
      "c": {"kind": "host", "os": "none"}, "s": {"kind": "switch", "queues": {"octets": "1000B"}}},
    "links": [{"ends": ["a", "s"], "rate": "100Mbps"}, {"ends": ["b", "s"], "rate": "100Mbps"}, {"ends": ["c", "s"],
      "rate": "100Mbps"}]},
    "streams": [{"name": "x", "from": "a", "to": "c", "payload": "700B", "every": "1ms", "pcp": 3,
      "encapsulation": "ethernet"},
                {"name": "y", "from": "b", "to": "c", "payload": "700B", "every": "1ms", "pcp": 3,
      "encapsulation": "ethernet"}],
    "require": [{"stream": "y", "latency": "2ms"}, {"stream": "x", "latency": "1ms"}]})");
  Options options = small();
  options.helps = true;
  const Verification found = verify(*scenario, options);
  const Line& line = found.lines[1];
  ASSERT_NE(line.verdict, Conclusion::pass);
  const auto payload = std::ranges::find(line.remedies, "payload of x at most", &Remedy::what);
  ASSERT_NE(payload, line.remedies.end()) << line.reason;
  EXPECT_LE(std::stoi(payload->value), 278 - 22);
  for (const Remedy& remedy : line.remedies)
    EXPECT_EQ(with(*scenario, remedy, 1, small()), Conclusion::pass) << remedy.what << " " << remedy.value;
}

std::unique_ptr<scenario::Resolved> file(const std::string& name, const std::vector<std::string>& sets = {}) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/" + name, sets, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  return resolved;
}

// Two waits for a publication are two cycles of 500 us; on change there are none.
TEST(Remedies, PublicationOnChangeComesFirst) {
  const auto cell = file("scenarios/first-cell.json");
  Options options = small();
  options.search.events = 4'000'000;
  options.helps = true;
  const Verification found = verify(*cell, options);
  const auto halt = std::ranges::find_if(
      found.lines, [](const Line& line) { return line.requirement.text == "reaction halt within 1ms"; });
  ASSERT_NE(halt, found.lines.end());
  EXPECT_EQ(halt->verdict, Conclusion::refuted);
  ASSERT_GE(halt->remedies.size(), 2u);
  EXPECT_EQ(halt->remedies[0].what, "publish of stamping");
  EXPECT_EQ(halt->remedies[0].value, "on-change");
  EXPECT_LT(halt->remedies[0].bound, Duration::from_ps(400'000'000));
  EXPECT_EQ(halt->remedies[1].what, "cycle of stamping at most");
  for (const Remedy& remedy : halt->remedies)
    EXPECT_EQ(with(*cell, remedy, static_cast<std::size_t>(halt - found.lines.begin()), small()), Conclusion::pass)
        << remedy.what;
}

// At 100 Mbit/s a frame of x or z takes 12.64 us, one of y 84.64 us, twice. x waits for y and z, 122.6 us in all; above
// y it waits for one frame of y alone, 110 us. y waits for one of x and z, 182 us; with x above it for both, 195 us.
TEST(Remedies, SayWhatTheyCostOthers) {
  const auto two = resolved(
      R"({"name": "two", "duration": "20ms", "network": {"nodes": {"a": {"kind": "host", "os": "none"},
      "b": {"kind": "host", "os": "none"}, "c": {"kind": "host", "os": "none"},
      "d": {"kind": "host", "os": "none"}, "s": {"kind": "switch"}}, "links": [{"ends": ["a", "s"],
      "rate": "100Mbps"}, {"ends": ["d", "s"], "rate": "100Mbps"}, {"ends": ["b", "s"], "rate": "100Mbps"},
      {"ends": ["c", "s"], "rate": "100Mbps"}]},
    "streams": [{"name": "x", "from": "a", "to": "c", "payload": "100B", "every": "1ms", "pcp": 3}, {"name": "y",
      "from": "b", "to": "c", "payload": "1000B", "every": "1ms", "pcp": 4},
                {"name": "z", "from": "d", "to": "c", "payload": "100B", "every": "1ms", "pcp": 3}],
    "require": [{"stream": "x", "latency": "115us"}, {"name": "REQ-2", "stream": "y", "latency": "190us"}]})");
  Options options = small();
  options.helps = true;
  const Verification found = verify(*two, options);
  ASSERT_EQ(found.lines[1].verdict, Conclusion::pass) << json_report("two", found, {"", ""});
  const auto priority = std::ranges::find(found.lines[0].remedies, "priority of x at least", &Remedy::what);
  ASSERT_NE(priority, found.lines[0].remedies.end()) << json_report("two", found, {"", ""});
  EXPECT_EQ(priority->breaks, (std::vector<std::string>{"REQ-2: stream y latency at most 190us"}));
  EXPECT_NE(text_report("two", found, {"", ""}).find("; not proved any more: REQ-2: stream y"), std::string::npos);
}

// A hint by priority was said, and a later search found a run that fails it: the run that had failed before.
TEST(Remedies, TheWorstRunIsRunAgain) {
  const auto scenario = file("tests/findings/hint-by-priority.json");
  Options options = small();
  options.search.seeds = 2;
  options.search.events = 100'000;
  options.helps = true;
  const Verification found = verify(*scenario, options);
  options.helps = false;
  for (std::size_t i = 0; i < found.lines.size(); ++i)
    for (const Remedy& remedy : found.lines[i].remedies)
      EXPECT_EQ(with(*scenario, remedy, i, options), Conclusion::pass) << remedy.what << " " << remedy.value;
}

TEST(Remedies, NoneOfWhatIsProvedOrNotAskedFor) {
  EXPECT_TRUE(verify(*resolved(alone), small()).lines[0].remedies.empty());
  std::string proved = alone;
  proved.replace(proved.find("5us"), 3, "9us");
  Options options = small();
  options.helps = true;
  const Verification found = verify(*resolved(proved), options);
  EXPECT_EQ(found.lines[0].verdict, Conclusion::pass);
  EXPECT_TRUE(found.lines[0].remedies.empty());
  EXPECT_TRUE(found.lines[0].weighty.empty());
}

}  // namespace
}  // namespace takt::verify::remedy_test
