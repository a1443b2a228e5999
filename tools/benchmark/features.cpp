// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>
#include <string>

#include "measure.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "workloads.hpp"

namespace takt::benchmark {
namespace {

struct Parts {
  const char* talker = "";
  const char* switches = "";
  const char* redundancy = "";
};

/// What each node has besides strict priority; the rates are above those of the streams, so nothing is lost, and below
/// the link's, so something waits.
Parts parts_of(LineFeature feature) {
  switch (feature) {
    case LineFeature::none:
      return {};
    case LineFeature::credit_based_shaper:
      return {R"(, "egress": [{"shapers": [{"class": 5, "idle_slope": "600Mbps"}]}])",
              R"(, "egress": [{"shapers": [{"class": 5, "idle_slope": "600Mbps"}]}])"};
    case LineFeature::asynchronous_shaper:
      return {
          "",
          R"(, "egress": [{"ats": [5]}], "ingress": {"filters": [{"stream": "small", "ats": "small"}, {"stream": "large", "ats": "large"}],
               "ats": [{"name": "small", "rate": "20Mbps", "burst": "400B"}, {"name": "large", "rate": "600Mbps", "burst": "2200B"}], "max_residence_time": "2ms"})"};
    case LineFeature::policing:
      return {
          "",
          R"(, "ingress": {"filters": [{"stream": "small", "gate": "slot", "max_sdu": "400B"}, {"stream": "large", "meter": "rate"}],
               "gates": [{"name": "slot", "entries": [{"open": true, "ipv": 5, "for": "150us"}, {"open": false, "for": "50us"}]}],
               "meters": [{"name": "rate", "cir": "600Mbps", "cbs": "4000B", "drop_on_yellow": true}]})"};
    case LineFeature::redundancy:
      return {
          "", "",
          R"(, "redundancy": {"paths": [["talker", "a1", "a2", "a3", "a4", "a5", "listener"], ["talker", "b1", "b2", "b3", "b4", "b5", "listener"]], "split": "talker", "merge": "listener"})"};
  }
  return {};
}

std::string text_of(LineFeature feature, double simulated_seconds) {
  const Parts parts = parts_of(feature);
  std::string nodes = R"("talker": {"kind": "host")" + std::string(parts.talker) + R"(}, "listener": {"kind": "host"})";
  std::string links;
  for (const char line : {'a', 'b'}) {
    if (line == 'b' && feature != LineFeature::redundancy) continue;
    std::string before = "talker";
    for (int n = 1; n <= 5; ++n) {
      const std::string name = line + std::to_string(n);
      nodes += ", \"" + name + R"(": {"kind": "switch", "forwarding_delay": "0ns")" + parts.switches + "}";
      links += std::string(links.empty() ? "" : ", ") + R"({"ends": [")" + before + "\", \"" + name +
               R"("], "rate": "1Gbps", "delay": "50ns"})";
      before = name;
    }
    links += R"(, {"ends": [")" + before + R"(", "listener"], "rate": "1Gbps", "delay": "50ns"})";
  }
  const auto stream = [&](const char* name, const char* payload, const char* every) {
    return R"({"name": ")" + std::string(name) + R"(", "from": "talker", "to": "listener", "pcp": 5, "payload": ")" +
           payload + R"(", "every": ")" + every + "\"" + parts.redundancy + "}";
  };
  return R"({"name": "line", "duration": ")" + std::to_string(static_cast<long long>(simulated_seconds * 1e6)) +
         R"(us", "network": {"nodes": {)" + nodes + R"(}, "links": [)" + links + R"(]}, "streams": [)" +
         stream("small", "100B", "200us") + ", " + stream("large", "1000B", "20us") + "]}";
}

}  // namespace

LineFigures run_line_with(LineFeature feature, double simulated_seconds) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text_of(feature, simulated_seconds), "line.json", {}, diagnostics);
  if (!resolved) {
    std::fputs(diagnostics.to_text().c_str(), stderr);
    std::abort();
  }
  scenario::Run run(*resolved);
  LineFigures figures;
  const double before = cpu_seconds();
  run.advance();
  figures.cpu_seconds = cpu_seconds() - before;
  figures.events = run.simulation().event_count();
  figures.population = run.simulation().pending_peak();
  for (std::uint32_t n = 0; n < run.network().plan().nodes.size(); ++n)
    for (const models::EgressPort& port : run.network().ports(models::NodeIndex{n}))
      figures.frame_hops += port.frames_sent();
  return figures;
}

}  // namespace takt::benchmark
