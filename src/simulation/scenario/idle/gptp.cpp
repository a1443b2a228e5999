// SPDX-License-Identifier: Apache-2.0
// Links that gPTP does not cross, and networks that it thereby leaves in parts, each with a grandmaster of its own.
#include <algorithm>

#include "scenario/idle/usage.hpp"
#include "scenario/resolve/gptp_links.hpp"

namespace takt::scenario {
namespace {

class GptpTeller {
 public:
  GptpTeller(const Usage& usage, json::Diagnostics& diagnostics)
      : usage_(usage), r_(usage.resolved()), diagnostics_(diagnostics) {}

  void run() {
    for (std::size_t l = 0; l < r_.plan.links.size(); ++l) look_at(l);
    for (const auto& [place, found] : generated_) warn(r_.scenario.clocks.gptp->where.place(), found);
    look_at_parts();
  }

 private:
  struct Found {
    LinkCapability capability{};
    std::string what;
    std::string threshold;
  };

  void look_at(std::size_t l) {
    const models::LinkPlan& link = r_.plan.links[l];
    if (!r_.plan.gptp[link.a.node.value] || !r_.plan.gptp[link.b.node.value]) return;
    const LinkCapability capability = capability_of(r_, link);
    if (capability == LinkCapability::always) return;
    const ShownLinkDelay shown = shown_link_delay(r_, link);
    std::string what = json::to_text(shown.mean());
    if (capability == LinkCapability::at_times) what += " within " + json::to_text(shown.noise);
    what += " between " + usage_.name(link.a.node.value) + " and " + usage_.name(link.b.node.value);
    if (shown.uncorrected != Duration())
      what += ": " + json::to_text(shown.cable) + " of cable, " + json::to_text(shown.uncorrected) +
              " of latencies that nothing makes up for";
    const Found found{capability, std::move(what),
                      json::to_text(link_delay_threshold(*r_.scenario.clocks.gptp, link).value_or(Duration()))};
    // Links that are written stand behind those that are generated, of which one speaks for all.
    const std::size_t generated = r_.plan.links.size() - r_.scenario.network.links.size();
    if (l < generated) {
      if (generated_.empty()) generated_.emplace_back(l, found);
      return;
    }
    const json::Source& where = r_.scenario.network.links[l - generated].where;
    warn(where.has("length") ? where.at("length") : where.has("delay") ? where.at("delay") : where.place(), found);
  }

  void warn(json::Place place, const Found& found) {
    const char* const what = found.capability == LinkCapability::never ? "a link that is not capable of gPTP"
                                                                       : "a link that is capable of gPTP at times only";
    warn_once(diagnostics_, std::move(place), what,
              {"a delay of " + found.what, "at most " + found.threshold + ", or a \"link_delay_threshold\" beyond it"});
  }

  void look_at_parts() {
    const std::vector<std::vector<std::uint32_t>> parts = gptp_parts(r_);
    if (parts.size() < 2) return;
    constexpr std::size_t most = 4;  // of parts that are named, and of nodes in each
    std::string text = std::to_string(parts.size()) + ": ";
    for (std::size_t p = 0; p < std::min(parts.size(), most); ++p) {
      text += p == 0 ? "" : "; ";
      for (std::size_t n = 0; n < std::min(parts[p].size(), most); ++n)
        text += (n == 0 ? "" : ", ") + r_.plan.nodes[parts[p][n]].name;
      if (parts[p].size() > most) text += " ...";
    }
    if (parts.size() > most) text += " ...";
    diagnostics_.warning(
        r_.scenario.clocks.gptp->where.place(), "gPTP in parts of the network that do not hear each other",
        {text, "one, with one grandmaster; each of them elects its own, and their clocks drift apart"});
  }

  const Usage& usage_;
  const Resolved& r_;
  json::Diagnostics& diagnostics_;
  std::vector<std::pair<std::size_t, Found>> generated_;
};

}  // namespace

void report_incapable_links(const Usage& usage, json::Diagnostics& diagnostics) {
  if (usage.resolved().scenario.clocks.gptp && !usage.resolved().plan.gptp.empty())
    GptpTeller(usage, diagnostics).run();
}

}  // namespace takt::scenario
