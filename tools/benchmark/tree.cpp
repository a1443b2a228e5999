// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "measure.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "workloads.hpp"

namespace takt::benchmark {
namespace {

std::string tree_text(unsigned depth, unsigned fanout, unsigned hosts_per_leaf, std::size_t hosts,
                      double simulated_seconds) {
  std::string text = R"({"name": "tree", "duration": ")" +
                     std::to_string(static_cast<long long>(simulated_seconds * 1e6)) +
                     R"(us", "network": {"generate": [{"topology": "tree", "depth": )" + std::to_string(depth) +
                     R"(, "fanout": )" + std::to_string(fanout) + R"(, "hosts_per_switch": )" +
                     std::to_string(hosts_per_leaf) + R"(, "rate": "100Gbps", "host_rate": "1Gbps"}]}, "streams": [)";
  for (std::size_t host = 1; host <= hosts; ++host) {
    // A multiplier that is coprime to the number of hosts spreads the receivers over the whole tree; phases differ too.
    std::size_t to = (host * 7 + hosts / 2) % hosts + 1;
    if (to == host) to = to % hosts + 1;
    text += (host > 1 ? "," : "") + std::string(R"({"name": "s)") + std::to_string(host) + R"(", "from": "h)" +
            std::to_string(host) + R"(", "to": "h)" + std::to_string(to) +
            R"(", "payload": "200B", "every": "1ms", "offset": ")" + std::to_string(host * 7919 % 1'000'000) +
            R"(ns"})";
  }
  return text + "]}";
}

}  // namespace

TreeFigures run_tree(unsigned depth, unsigned fanout, unsigned hosts_per_leaf, double simulated_seconds) {
  TreeFigures figures;
  std::size_t leaves = 1;
  for (unsigned level = 0; level < depth; ++level) leaves *= fanout;
  figures.hosts = leaves * hosts_per_leaf;
  const std::string text = tree_text(depth, fanout, hosts_per_leaf, figures.hosts, simulated_seconds);

  const std::size_t octets_before = allocated_octets();
  const double setup_before = cpu_seconds();
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text, "tree.json", {}, diagnostics);
  if (!resolved) {
    std::fputs(diagnostics.to_text().c_str(), stderr);
    std::abort();
  }
  auto run = std::make_unique<scenario::Run>(*resolved);
  figures.setup_cpu_seconds = cpu_seconds() - setup_before;
  figures.setup_octets = allocated_octets() - octets_before;

  const double before = cpu_seconds();
  run->advance();
  figures.cpu_seconds = cpu_seconds() - before;
  for (std::uint32_t n = 0; n < run->network().plan().nodes.size(); ++n)
    for (const models::EgressPort& port : run->network().ports(models::NodeIndex{n}))
      figures.frame_hops += port.frames_sent();
  return figures;
}

}  // namespace takt::benchmark
