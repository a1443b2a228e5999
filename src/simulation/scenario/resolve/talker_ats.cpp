// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/talker_ats.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "json/suggest.hpp"
#include "models/ethernet/sizes.hpp"
#include "scenario/resolve/ingress_tables.hpp"
#include "scenario/resolve/known_names.hpp"
#include "scenario/resolve/port_configs.hpp"
#include "scenario/resolve/stream_at_port.hpp"

namespace takt::scenario {
namespace {

class TalkerAtsResolver {
 public:
  TalkerAtsResolver(Resolved& resolved, json::Diagnostics& diagnostics) : r_(resolved), diagnostics_(diagnostics) {}

  void run() {
    for (std::uint32_t n = 0; n < r_.topology.nodes.size(); ++n)
      if (const EndStation* const station = end_station_of(r_.topology.nodes[n].description))
        for (const TalkerAts& entry : station->ats)
          if (!diagnostics_.is_refused(entry.where.place())) add(n, entry);
  }

 private:
  std::string name_of(std::uint32_t node) const { return json::quote(r_.topology.nodes[node].name); }

  void add(std::uint32_t node, const TalkerAts& entry) {
    const models::StreamIndex stream = find_stream(r_, entry.stream);
    if (stream.is_none()) {
      std::vector<std::string_view> names;
      for (const models::StreamPlan& plan : r_.plan.streams)
        if (plan.talker.value == node) names.push_back(plan.name);
      diagnostics_.error_unless(
          StreamNames(r_, diagnostics_).may_be(entry.stream), entry.where.at("stream"), "unknown stream",
          {json::quote(entry.stream), "a stream that " + name_of(node) + " sends", json::suggest(entry.stream, names)});
      return;
    }
    const models::StreamPlan& plan = r_.plan.streams[stream.value];
    if (plan.talker.value != node) {
      diagnostics_.error(entry.where.at("stream"), "a stream of another talker",
                         {json::quote(entry.stream) + ", which " + name_of(plan.talker.value) + " sends",
                          "a stream that " + name_of(node) + " sends"});
      return;
    }
    if (!shaped_.insert(stream.value).second) {
      diagnostics_.error(entry.where.at("stream"), "a stream with two schedulers",
                         {json::quote(entry.stream) + " a second time", "one scheduler for a stream"});
      return;
    }
    const bool launches = std::any_of(
        r_.plan.talkers.begin(), r_.plan.talkers.end(),
        [&](const models::TalkerPlan& talker) { return talker.stream == stream && talker.launch.has_value(); });
    if (launches)
      diagnostics_.error(entry.where.at("stream"), "ATS beside launch times",
                         {json::quote(entry.stream) + " with \"launch\"", "one of them: both say when a frame may go"});
    check_burst(plan, r_.streams[stream.value], entry);
    check_ports(node, stream, entry);
    r_.plan.talker_ats.push_back({stream, entry.rate, entry.burst, entry.length == LengthOf::wire});
  }

  void check_burst(const models::StreamPlan& plan, const ResolvedStream& stream, const TalkerAts& entry) {
    const Octets frame = models::frame_length(plan.headers + stream.largest_payload, plan.priority.has_value(), false);
    const Octets counted = entry.length == LengthOf::wire ? models::wire_length(frame) : frame;
    if (counted > entry.burst)
      diagnostics_.error(entry.where.at("burst"), "a burst smaller than a frame",
                         {json::to_text(entry.burst) + " for frames of " + json::quote(plan.name) + " of up to " +
                              json::to_text(counted) + (entry.length == LengthOf::wire ? " with preamble and gap" : ""),
                          "at least the longest frame"});
    const double asked = stream.demand.wire_bits_per_second -
                         (entry.length == LengthOf::wire ? 0 : 160 * stream.demand.frames_per_second);
    if (asked > static_cast<double>(entry.rate.bits_per_second) * (1 + 1e-9))
      diagnostics_.warning(
          entry.where.at("rate"), "a scheduler slower than its streams",
          {json::to_text(entry.rate) + " for " + json::to_text(DataRate{static_cast<std::uint64_t>(asked)}),
           "a rate that carries them"});
  }

  /// Where its frames leave the talker.
  void check_ports(std::uint32_t node, models::StreamIndex stream, const TalkerAts& entry) {
    std::set<std::uint32_t> next;
    for (const Path& path : r_.streams[stream.value].paths)
      if (path.size() > 1) next.insert(path[1]);
    for (const models::LinkPlan& link : r_.plan.links)
      for (const auto& [end, peer] : {std::pair(&link.a, &link.b), std::pair(&link.b, &link.a)}) {
        if (end->node.value != node || !next.contains(peer->node.value)) continue;
        const models::PortConfig& config = port_config_of(r_.plan, *end);
        const models::TrafficClass q =
            config.traffic_class_of_priority[r_.plan.streams[stream.value].priority_at_talker()];
        if (!config.shaping.is_timed(q))
          diagnostics_.error_unless(diagnostics_.has_errors(), entry.where.at("stream"),
                                    "eligibility times that no port minds",
                                    {"class " + std::to_string(q) + " of " + name_of(node) + " to " +
                                         name_of(peer->node.value) + ", which is not sent by them",
                                     "\"ats\": [" + std::to_string(q) + "] in its \"egress\""});
        if (entry.rate > link.rate)
          diagnostics_.error(entry.where.at("rate"), "a scheduler faster than its link",
                             {json::to_text(entry.rate),
                              "at most " + json::to_text(link.rate) + ", the link to " + name_of(peer->node.value)});
      }
  }

  Resolved& r_;
  json::Diagnostics& diagnostics_;
  std::set<std::uint32_t> shaped_;
};

}  // namespace

void resolve_talker_ats(Resolved& resolved, json::Diagnostics& diagnostics) {
  TalkerAtsResolver(resolved, diagnostics).run();
}

}  // namespace takt::scenario
