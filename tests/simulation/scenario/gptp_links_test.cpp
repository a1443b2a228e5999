// SPDX-License-Identifier: Apache-2.0
// What a scenario alone says of its gPTP: links that are too long, parts that do not hear each other, gates that let no
// message pass.
#include "scenario/resolve/gptp_links.hpp"

#include "support.hpp"

namespace takt::scenario::test::gptp_links_test {
namespace {

using namespace sim::literals;

/// a - s1 - s2 - b; `middle` goes into the link in the middle, `gptp` into gPTP, `clock` into all clocks.
std::string line(const std::string& middle, const std::string& gptp = "", const std::string& clock = "",
                 const std::string& of_s2 = "") {
  return R"({"name": "t", "duration": "1s", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "s1": {"kind": "switch"}, "s2": {"kind": "switch")" +
         of_s2 + R"(}},
    "links": [{"ends": ["a", "s1"]}, {"ends": ["s1", "s2"])" +
         middle + R"(}, {"ends": ["s2", "b"]}]}, "clocks": {"all": {)" + clock + R"(}, "gptp": {)" + gptp + "}}}";
}
std::string told(const std::string& text) { return load(text).diagnostics.to_text(); }
bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

TEST(GptpLinks, HaveTheThresholdOfTheirMedium) {
  struct Case {
    const char* middle;
    const char* gptp;
    std::optional<Duration> threshold;
  };
  const Case cases[] = {{R"(, "length": "100m")", "", 800_ns},
                        {R"(, "length": "101m")", "", {}},
                        {R"(, "delay": "500001ps")", "", {}},
                        {R"(, "length": "2km")", R"("link_delay_threshold": "20us")", 20_us}};
  for (const Case& each : cases) {
    const auto r = sound(line(each.middle, each.gptp));
    EXPECT_EQ(link_delay_threshold(*r->scenario.clocks.gptp, r->plan.links[1]), each.threshold) << each.middle;
    EXPECT_EQ(r->plan.gptp_stations[*r->plan.gptp[2]].ports_without_threshold.size(), each.threshold ? 0u : 1u)
        << each.middle;
    EXPECT_EQ(told(line(each.middle, each.gptp)), "") << each.middle;
    EXPECT_EQ(gptp_parts(*r).size(), 1u);
  }
}

TEST(GptpLinks, ThatAreTooLongAreTold) {
  const std::string text = told(line(R"(, "length": "2km")", R"("link_delay_threshold": "800ns")"));
  EXPECT_TRUE(has(text,
                  "warning at /network/links/1/length: a link that is not capable of gPTP: found a delay of 10us "
                  "between \"s1\" and \"s2\", expected at most 800ns"))
      << text;
  EXPECT_TRUE(has(
      text, "warning at /clocks/gptp: gPTP in parts of the network that do not hear each other: found 2: a, s1; b, s2"))
      << text;
  EXPECT_EQ(gptp_parts(*sound(line(R"(, "length": "2km")", R"("link_delay_threshold": "800ns")"))).size(), 2u);
}

// Half of 2 x 3177 ns, and 50 ns of cable.
TEST(GptpLinks, SeemLongerByLatenciesThatNothingMakesUpFor) {
  const std::string latencies =
      R"("tx_latency": "1044ns", "rx_latency": "2133ns", "tx_correction": "0ns", "rx_correction": "0ns")";
  const std::string text = told(line("", "", latencies));
  EXPECT_TRUE(
      has(text,
          "a delay of 3.227us between \"a\" and \"s1\": 50ns of cable, 3.177us of latencies that nothing makes up for"))
      << text;
  EXPECT_EQ(told(line("", "", R"("tx_latency": "1044ns", "rx_latency": "2133ns")")), "");
  // 790 ns within 8 ns of granularity and 4 ns of jitter at each end: (8 + 8) / 2 + 4 + 4.
  const std::string near = told(
      line(R"(, "delay": "490ns")", R"("link_delay_threshold": "500ns")", R"("granularity": "8ns", "jitter": "4ns")"));
  EXPECT_TRUE(has(near, "a link that is capable of gPTP at times only: found a delay of 490ns within 16ns")) << near;
  EXPECT_FALSE(has(near, "parts")) << near;
}

// Follow_Up and the Announce of the grandmaster have 76 octets: 94 as a frame, 102 with preamble and SFD, 816 ns. The
// Announce that s2 hands on names a, s1 and s2: 92, 118, 944 ns.
TEST(GptpLinks, NeedGatesThatLetMessagesPass) {
  const auto gates = [](const std::string& window) {
    return R"(, "egress": [{"to": "b", "gates": {"entries": [)" + window +
           R"({"open": [0, 1, 2, 3, 4, 5], "for": "100us"}]}}])";
  };
  const std::string first = R"("nodes": {"a": {"priority1": 100}})";
  const std::string closed = told(line("", first, "", gates(R"({"open": [6], "for": "100us"}, )")));
  EXPECT_TRUE(has(closed,
                  "at /clocks/gptp: gPTP that no gate window lets pass: found 944ns for a frame of class 7 from \"s2\" "
                  "to \"b\", whose longest window there is 0s"))
      << closed;
  EXPECT_TRUE(has(told(line("", first, "", gates(R"({"open": [7], "for": "943ns"}, )"))),
                  "gPTP that no gate window lets pass"));
  EXPECT_EQ(load(line("", first, "", gates(R"({"open": [7], "for": "943ns"}, )"))).resolved, nullptr);
  EXPECT_EQ(told(line("", first, "", gates(R"({"open": [7], "for": "944ns"}, )"))), "");
  // Towards a grandmaster no Announce is handed on.
  EXPECT_EQ(told(line("", R"("nodes": {"b": {"priority1": 100}})", "", gates(R"({"open": [7], "for": "816ns"}, )"))),
            "");
  EXPECT_TRUE(
      has(told(line("", R"("nodes": {"b": {"priority1": 100}})", "", gates(R"({"open": [7], "for": "815ns"}, )"))),
          "gPTP that no gate window lets pass"));
  // b does without.
  EXPECT_FALSE(
      has(told(line("", R"("without": ["b"])", "", gates(R"({"open": [6], "for": "100us"}, )"))), "lets pass"));
}

TEST(GptpLinks, TheFindingIsRefused) {
  json::Diagnostics diagnostics;
  EXPECT_EQ(load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/gptp-behind-closed-gate.json", {}, diagnostics),
            nullptr);
  EXPECT_TRUE(has(diagnostics.to_text(), "gPTP that no gate window lets pass")) << diagnostics.to_text();
}

}  // namespace
}  // namespace takt::scenario::test::gptp_links_test
