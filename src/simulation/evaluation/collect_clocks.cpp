// SPDX-License-Identifier: Apache-2.0
#include "evaluation/collect_clocks.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "json/quantity.hpp"

namespace takt::evaluation {

using namespace results;
namespace {

const char* name_of(models::gptp::ClockState state) {
  constexpr const char* names[] = {"free-running", "acquiring", "locked", "holdover", "down"};
  return names[static_cast<std::size_t>(state)];
}

using models::gptp::NotCapable;

std::string why_not(NotCapable obstacle, const models::gptp::LinkDelay& link,
                    const std::optional<sim::Duration>& threshold, const std::string& peer) {
  switch (obstacle) {
    case NotCapable::none:
      return {};
    case NotCapable::link_down:
      return "the link is down";
    case NotCapable::unmeasured:
      return "its delay has not been measured yet";
    case NotCapable::no_answer:
      return peer + " does not answer: " + std::to_string(link.lost_responses()) + " requests in a row";
    case NotCapable::delay_too_long:
      return "its delay of " + json::to_text(link.mean_link_delay()) + " is beyond the threshold of " +
             json::to_text(threshold.value_or(sim::Duration()));
    case NotCapable::delay_too_short:
      return "its delay seems to be " + json::to_text(link.mean_link_delay());
    case NotCapable::several_answers:
      return "several answers to one request";
    case NotCapable::own_answer:
      return "the port hears itself";
    case NotCapable::neighbor_not_capable:
      return peer + " does not say that it is capable";
  }
  return {};
}

GptpLinkResult link_of(const scenario::Run& run, const models::gptp::Station& station, std::uint16_t port,
                       models::NodeIndex peer) {
  const auto& plan = run.resolved().plan;
  const auto number = static_cast<models::gptp::PortNumber>(port + 1);
  const models::gptp::LinkDelay& link = station.machine().link(number);
  GptpLinkResult result;
  result.node = plan.nodes[station.node().value].name;
  result.port = port;
  result.peer = plan.nodes[peer.value].name;
  result.is_capable = station.is_up() && station.obstacle(port) == NotCapable::none;
  result.threshold = link.threshold();
  result.since = station.capability_changed(port);
  if (link.is_measured()) result.link_delay = link.mean_link_delay();
  if (!station.is_up())
    result.why_not = result.node + " is down";
  else if (!plan.gptp[peer.value])
    result.why_not = result.peer + " is without gPTP";
  else
    result.why_not = why_not(station.obstacle(port), link, result.threshold, result.peer);
  return result;
}

}  // namespace

std::vector<GptpLinkResult> gptp_links_of(const scenario::Run& run) {
  std::vector<GptpLinkResult> results;
  if (run.resolved().plan.gptp.empty()) return results;
  for (const models::LinkPlan& link : run.resolved().plan.links)
    for (const auto& [own, peer] : {std::pair(&link.a, &link.b), std::pair(&link.b, &link.a)})
      if (const models::gptp::Station* const station = run.network().station(own->node))
        results.push_back(link_of(run, *station, own->port, peer->node));
  return results;
}

std::vector<ClockDifferenceResult> clock_differences_of(const scenario::Run& run, sim::Duration from) {
  std::vector<ClockDifferenceResult> results;
  if (run.clocks() == nullptr) return results;
  const auto& nodes = run.resolved().plan.nodes;
  for (std::size_t g = 0; g < run.clocks()->groups().size(); ++g) {
    const scenario::ClockDifferences& seen = run.clocks()->differences(g).from(from);
    ClockDifferenceResult& result = results.emplace_back();
    result.name = run.clocks()->groups()[g].name;
    result.samples = seen.samples;
    if (seen.samples == 0) continue;
    result.greatest = seen.greatest;
    result.at = seen.at;
    result.behind = nodes[seen.behind.value].name;
    result.ahead = nodes[seen.ahead.value].name;
  }
  return results;
}

std::vector<GrandmasterResult> grandmasters_of(const std::vector<ClockResult>& clocks) {
  constexpr std::size_t most = 4096;
  struct Change {
    sim::TrueTime at;
    std::size_t clock = 0;
    const ClockChangeResult* to = nullptr;
  };
  std::vector<Change> changes;
  for (std::size_t c = 0; c < clocks.size(); ++c)
    for (const ClockChangeResult& change : clocks[c].changes) changes.push_back({change.at, c, &change});
  std::ranges::stable_sort(changes, {}, &Change::at);
  std::vector<const ClockChangeResult*> now(clocks.size());
  struct Followers {
    std::size_t all = 0;     // other nodes that name it
    std::size_t locked = 0;  // and are locked to it
    bool is_up = true;
    bool leads = false;
  };
  std::map<std::string_view, Followers> of;
  const auto count = [&](std::size_t c, const ClockChangeResult* change, std::size_t by) {
    if (change == nullptr || change->state == "down" || change->grandmaster == clocks[c].node) return;
    Followers& followers = of[change->grandmaster];
    followers.all += by;
    if (change->state == "locked") followers.locked += by;
  };
  std::vector<GrandmasterResult> results;
  for (std::size_t i = 0; i < changes.size() && results.size() < most; ++i) {
    const Change& change = changes[i];
    count(change.clock, now[change.clock], static_cast<std::size_t>(-1));
    now[change.clock] = change.to;
    count(change.clock, change.to, 1);
    of[clocks[change.clock].node].is_up = change.to->state != "down";
    if (i + 1 < changes.size() && changes[i + 1].at == change.at) continue;
    // What ends stands before what begins.
    for (auto& [node, followers] : of)
      if (followers.leads && (!followers.is_up || followers.all == 0)) {
        followers.leads = false;
        results.push_back({change.at, std::string(node), followers.is_up ? "replaced" : "lost"});
      }
    for (auto& [node, followers] : of)
      if (!followers.leads && followers.is_up && followers.locked > 0) {
        followers.leads = true;
        results.push_back({change.at, std::string(node), "leads"});
      }
  }
  return results;
}

std::vector<ClockResult> clocks_of(const scenario::Run& run, sim::Duration from) {
  std::vector<ClockResult> results;
  if (run.clocks() == nullptr) return results;
  const models::Network& network = run.network();
  const auto name = [&](models::NodeIndex node) { return network.plan().nodes[node.value].name; };
  for (const scenario::ClockFigures& figures : run.clocks()->figures()) {
    const models::gptp::Station& station = *network.station(figures.node);
    ClockResult result;
    result.node = name(figures.node);
    result.grandmaster = name(station.grandmaster());
    result.state = station.is_up() && station.active_is_grandmaster() ? "grandmaster" : name_of(station.state());
    if (figures.locked) result.time_to_lock = figures.locked->since_start();
    result.has_led = figures.has_led;
    const scenario::ClockFigures::Offsets& offsets = figures.offsets.from(from);
    result.samples = offsets.samples;
    if (offsets.samples > 0) {
      result.least = offsets.least;
      result.greatest = offsets.greatest;
      result.greatest_at = offsets.greatest_at;
      const auto count = static_cast<double>(offsets.samples);
      result.mean = sim::Duration::from_ps(std::llround(static_cast<double>(offsets.sum) / count));
      result.rms = sim::Duration::from_ps(std::llround(std::sqrt(static_cast<double>(offsets.sum_of_squares) / count)));
    }
    const auto rate = [&](models::NodeIndex node) {
      return static_cast<long double>(network.clock(node).rate().multiple());
    };
    result.frequency_error_ppt = std::llround((rate(figures.node) / rate(station.grandmaster()) - 1.0L) * 1e12L);
    result.steps = station.steps();
    result.messages = station.messages_sent();
    for (const models::gptp::Station::Change& change : station.changes())
      result.changes.push_back({change.time, name(change.grandmaster), name_of(change.state)});
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace takt::evaluation
