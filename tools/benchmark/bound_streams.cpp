// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "analysis/bounds.hpp"
#include "measure.hpp"
#include "scenario/resolve.hpp"
#include "workloads.hpp"

namespace takt::benchmark {
namespace {

/// A mesh of ten rows with two hosts at each switch; streams of four classes, three sizes and four periods between
/// hosts all over it.
std::string mesh_text(unsigned switches, unsigned streams) {
  constexpr std::array<const char*, 4> classes = {"0", "3", "5", "6"};
  constexpr std::array<const char*, 3> payloads = {"100B", "400B", "1000B"};
  constexpr std::array<const char*, 4> periods = {"500us", "1ms", "2ms", "4ms"};
  const unsigned hosts = 2 * switches;
  std::string text =
      R"({"name": "mesh", "duration": "10ms", "network": {"generate": [{"topology": "mesh", "rows": 10, "columns": )" +
      std::to_string(switches / 10) +
      R"(, "hosts_per_switch": 2, "rate": "1Gbps", "forwarding_delay": "1us"}]}, "streams": [)";
  for (unsigned s = 0; s < streams; ++s) {
    const unsigned from = s * 37 % hosts + 1;
    unsigned to = (s * 61 + s / hosts * 17 + hosts / 3) % hosts + 1;
    if (to == from) to = to % hosts + 1;
    text += (s > 0 ? "," : "") + std::string(R"({"name": "s)") + std::to_string(s) + R"(", "from": "h)" +
            std::to_string(from) + R"(", "to": "h)" + std::to_string(to) + R"(", "payload": ")" +
            payloads[s % payloads.size()] + R"(", "every": ")" + periods[s / 3 % periods.size()] + R"(", "pcp": )" +
            classes[s / 7 % classes.size()] + "}";
  }
  return text + "]}";
}

}  // namespace

BoundFigures run_bound(unsigned switches, unsigned streams) {
  BoundFigures figures;
  const std::string text = mesh_text(switches, streams);
  const double before = cpu_seconds();
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text, "mesh.json", {}, diagnostics);
  if (!resolved) {
    std::fputs(diagnostics.to_text().c_str(), stderr);
    std::abort();
  }
  const double loaded = cpu_seconds();
  const analysis::Bounds bounds = analysis::bound(*resolved);
  figures.load_cpu_seconds = loaded - before;
  figures.cpu_seconds = cpu_seconds() - before;
  figures.streams = bounds.streams.size();
  figures.rounds = bounds.rounds;
  for (const analysis::StreamBound& stream : bounds.streams) figures.bounded += stream.latency.has_value();
  return figures;
}

}  // namespace takt::benchmark
