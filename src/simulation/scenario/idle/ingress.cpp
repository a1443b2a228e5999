// SPDX-License-Identifier: Apache-2.0
// The ingress of switches: filters that no frame meets, functions that no filter names or that change nothing, meters
// below their load.
#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "models/ethernet/sizes.hpp"
#include "scenario/idle/usage.hpp"
#include "scenario/resolve/control_list.hpp"
#include "scenario/resolve/cqf.hpp"

namespace takt::scenario {
namespace {

using Met = std::vector<const StreamAtPort*>;

class IngressTeller {
 public:
  IngressTeller(const Usage& usage, const IngressUse& use, json::Diagnostics& diagnostics)
      : usage_(usage), ingress_(*use.ingress), nodes_(use.nodes), diagnostics_(diagnostics) {
    for (const StreamAtPort& at : usage.streams())
      if (std::binary_search(nodes_.begin(), nodes_.end(), at.node)) here_.push_back(&at);
  }

  void run() {
    for (std::size_t i = 0; i < ingress_.filters.size(); ++i) filter(ingress_.filters[i], met_by(i));
    for (const IdentifiedStream& each : ingress_.streams)
      named(each, &StreamFilterEntry::stream, "an identified stream that no filter names", "\"stream\"");
    for (const StreamGateEntryList& each : ingress_.gates)
      if (named(each, &StreamFilterEntry::gate, "a stream gate that no filter names", "\"gate\"")) gate(each);
    for (const Meter& each : ingress_.meters)
      if (named(each, &StreamFilterEntry::meter, "a flow meter that no filter names", "\"meter\"")) meter(each);
    for (const AtsEntry& each : ingress_.ats)
      named(each, &StreamFilterEntry::ats, "an ATS scheduler that no filter names", "\"ats\"");
    for (const AtsGroupEntry& each : ingress_.ats_groups)
      if (std::none_of(ingress_.ats.begin(), ingress_.ats.end(),
                       [&](const AtsEntry& entry) { return entry.group == each.name; }))
        warn(each.where.at("name"), "a group without ATS schedulers",
             {json::quote(each.name), "\"group\" of an entry of \"ats\""});
    if (ingress_.max_residence_time && ingress_.ats.empty())
      warn(ingress_.where.at("max_residence_time"), "a residence time without ATS schedulers",
           {"no \"ats\"", "an ATS scheduler"});
    if (ingress_.cqf && met_by_cqf().empty())
      warn(ingress_.cqf->where.place(), "cyclic queuing without frames",
           {"no stream that crosses " + names() + " meets it", "streams with its priorities"});
    if (ingress_.cqf) cqf(*ingress_.cqf);
  }

 private:
  void warn(json::Place place, std::string message, json::Details details) {
    warn_once(diagnostics_, std::move(place), std::move(message), std::move(details));
  }
  std::string names() const {
    return nodes_.size() == 1 ? usage_.name(nodes_[0]) : std::to_string(nodes_.size()) + " switches";
  }
  const models::IngressConfig& config_of(const StreamAtPort& at) const {
    const Resolved& r = usage_.resolved();
    return r.plan.ingress_configs[*r.plan.nodes[at.node].ingress];
  }

  Met met_by(std::size_t filter) const {
    Met met;
    for (const StreamAtPort* at : here_)
      if (at->filter == filter) met.push_back(at);
    return met;
  }
  Met met_by_cqf() const {
    Met met;
    for (const StreamAtPort* at : here_)
      if (at->filter && !config_of(*at).stream_filters[*at->filter].stream_gate.is_none() &&
          config_of(*at).stream_gates[config_of(*at).stream_filters[*at->filter].stream_gate.value].name == "cqf")
        met.push_back(at);
    return met;
  }
  /// The streams whose filters name the entry.
  Met met_through(const std::string& name, std::optional<std::string> StreamFilterEntry::*member) const {
    Met all;
    for (std::size_t i = 0; i < ingress_.filters.size(); ++i)
      if (ingress_.filters[i].*member == name) {
        const Met met = met_by(i);
        all.insert(all.end(), met.begin(), met.end());
      }
    return all;
  }

  void filter(const StreamFilterEntry& filter, const Met& met) {
    if (met.empty()) {
      if (!filter.stream && !filter.pcp) return;  // for whatever else may come
      std::string what = filter.stream ? "stream " + json::quote(*filter.stream) : std::string("streams");
      if (filter.pcp) what += " of priority " + std::to_string(*filter.pcp);
      return warn(filter.where.place(), "a filter that no frame reaches",
                  {what + ", none of which crosses " + names() + " past earlier filters", "frames that do"});
    }
    if (filter.max_sdu) {
      const auto longest = *std::max_element(
          met.begin(), met.end(), [](const auto* a, const auto* b) { return a->policed_msdu < b->policed_msdu; });
      if (longest->policed_msdu > *filter.max_sdu)
        warn(filter.where.at("max_sdu"), "a maximum SDU that drops frames",
             {json::to_text(*filter.max_sdu) + ", and frames of " + json::quote(usage_.plan(*longest).name) + " of " +
                  json::to_text(longest->policed_msdu),
              "at least the longest"});
      else if (longest->policed_msdu < *filter.max_sdu)
        warn(filter.where.at("max_sdu"), "a maximum SDU that no frame exceeds",
             {json::to_text(*filter.max_sdu) + ", and the longest frame has " + json::to_text(longest->policed_msdu),
              "a size below it"});
    }
    if (!filter.ats) return;
    const bool is_minded = std::any_of(met.begin(), met.end(), [&](const StreamAtPort* at) {
      return (usage_.port(at->node, at->port).config->shaping.timed() & at->classes) != 0;
    });
    if (!is_minded)
      warn(filter.where.at("ats"), "eligibility times that no port minds",
           {"class " + text_of_classes(met.front()->classes) + " at " +
                usage_.name({&usage_.port(met.front()->node, met.front()->port)}) + ", which is not sent by them",
            "the class in \"ats\" of \"egress\""});
  }

  /// Whether a filter names the entry; if not, that is told.
  template <class Entry>
  bool named(const Entry& entry, std::optional<std::string> StreamFilterEntry::*member, const char* message,
             const char* key) {
    const bool is_named = std::any_of(ingress_.filters.begin(), ingress_.filters.end(),
                                      [&](const StreamFilterEntry& filter) { return filter.*member == entry.name; });
    if (!is_named)
      warn(entry.where.at("name"), message,
           {json::quote(entry.name), std::string(key) + " of an entry of \"filters\""});
    return is_named;
  }

  /// Before its list begins a gate is as it was made.
  bool begins_late_at_a_node(const StreamGateEntryList& gate) const {
    const models::NetworkPlan& plan = usage_.resolved().plan;
    return std::ranges::any_of(nodes_, [&](std::uint32_t n) {
      const auto& gates = plan.ingress_configs[*plan.nodes[n].ingress].stream_gates;
      return std::ranges::any_of(gates, [&](const models::StreamGateConfig& each) {
        return each.name == gate.name && begins_after_the_start(plan.nodes[n], each);
      });
    });
  }

  void gate(const StreamGateEntryList& gate) {
    const auto any_entry = [&](auto&& predicate) {
      return std::any_of(gate.entries.begin(), gate.entries.end(), predicate);
    };
    const bool begins_late = !gate.entries.empty() && usage_.is_after_the_end(gate.base_time);
    if (begins_late)
      return warn(gate.where.at("base_time"), "a gate list that begins after the end of the simulation",
                  {json::to_text(gate.base_time), "less than " + json::to_text(usage_.resolved().scenario.duration)});
    if (gate.extension > Duration())
      warn(gate.where.at("extension"), "an extension that nothing needs",
           {"the list of a stream gate, which never changes", "no \"extension\""});
    const bool acts_at_first = gate.entries.empty() || begins_late_at_a_node(gate);
    if (gate.running && gate.entries.empty())
      warn(gate.where.at("running"), "a list that is running, and none is there", {"no \"entries\"", "\"entries\""});
    Duration cycle;
    for (const StreamGateStep& step : gate.entries) cycle += step.interval;
    cycle = gate.cycle.value_or(cycle);
    if (gate.running && begins_at_the_start(gate, cycle) && std::ranges::none_of(nodes_, [&](std::uint32_t n) {
          return usage_.resolved().plan.nodes[n].clock.has_value();
        }))
      warn(gate.where.at("running"), "a list that begins at the start in any case",
           {"\"base_time\" of " + json::to_text(gate.base_time) + " and a cycle of " + json::to_text(cycle),
            "a \"base_time\" in the middle of a cycle"});
    const bool closes =
        (acts_at_first && !gate.open) || any_entry([](const StreamGateStep& step) { return !step.open; });
    const bool counts = any_entry([](const StreamGateStep& step) { return step.octets.has_value(); });
    const bool gives =
        (acts_at_first && gate.ipv) || any_entry([](const StreamGateStep& step) { return step.ipv.has_value(); });
    if (gate.block_invalid_rx && !closes)
      warn(gate.where.at("block_invalid_rx"), "a block that nothing sets off",
           {json::quote(gate.name) + " is never closed", "entries with \"open\": false"});
    if (gate.block_octets_exceeded && !counts)
      warn(gate.where.at("block_octets_exceeded"), "a block that nothing sets off",
           {"no entry of " + json::quote(gate.name) + " with \"octets\"", "\"octets\" of an entry"});
    if (!closes && !counts && !gives)
      warn(gate.where.place(), "a stream gate that does nothing",
           {json::quote(gate.name) + ", always open, without \"ipv\" and \"octets\"",
            "entries that close it or give an \"ipv\""});
  }

  /// What is received in a cycle must be sent in one, but for the dead time and the gap behind its last frame.
  void cqf(const Cqf& cqf) {
    for (const PortUse& port : usage_.ports()) {
      if (!std::binary_search(nodes_.begin(), nodes_.end(), port.node)) continue;
      double load = 0;
      for (const std::uint8_t q : cqf.classes) load += usage_.load(port, q);
      const Duration sends = cqf.cycle - cqf_times(cqf, usage_.resolved().topology, port.node).dead_time;
      const Duration gap = port.link->rate.octet_time() * models::inter_packet_gap.count;
      const double carries =
          static_cast<double>(port.link->rate.bits_per_second) *
          std::min(1.0, static_cast<double>((sends + gap).ps()) / static_cast<double>(cqf.cycle.ps()));
      if (load <= carries * (1 + 1e-9)) continue;
      return warn(cqf.where.place(), "cyclic queuing of more than is sent",
                  {json::to_text(sends) + " of " + json::to_text(cqf.cycle) + ", " +
                       json::to_text(DataRate{static_cast<std::uint64_t>(carries)}) + ", for " +
                       json::to_text(DataRate{static_cast<std::uint64_t>(load)}) + " at " + usage_.name({&port}) +
                       ", preamble and gap included",
                   "streams that fit"});
    }
  }

  void meter(const Meter& meter) {
    const Met met = met_through(meter.name, &StreamFilterEntry::meter);
    // At each switch for itself: a meter of generated switches is one for each.
    std::map<std::uint32_t, double> load;  // by node; a stream counts once, however many ports it goes on through
    std::set<std::pair<std::uint32_t, std::uint32_t>> counted;
    for (const StreamAtPort* at : met)
      if (counted.insert({at->node, at->stream.value}).second)
        load[at->node] += 8.0 * static_cast<double>(at->policed_frame.count) *
                          usage_.resolved().streams[at->stream.value].demand.frames_per_second;
    for (const auto& [node, asked] : load) {
      const double passes = static_cast<double>(meter.cir.bits_per_second) +
                            (meter.drop_on_yellow ? 0.0 : static_cast<double>(meter.eir.bits_per_second));
      if (asked <= passes * (1 + 1e-9)) continue;
      warn(meter.where.at("cir"), "a meter slower than its streams",
           {json::to_text(DataRate{static_cast<std::uint64_t>(passes)}) + " for " +
                json::to_text(DataRate{static_cast<std::uint64_t>(asked)}) + " at " + usage_.name(node) +
                ", so that frames are dropped",
            "a rate that carries them"});
      break;
    }
    if (meter.eir.bits_per_second > 0 && meter.ebs.count == 0)
      warn(meter.where.at("eir"), "an excess rate without a bucket", {"\"ebs\" of 0", "\"ebs\" too"});
    if (meter.coupling && meter.ebs.count == 0)
      warn(meter.where.at("coupling"), "coupling without a second bucket", {"\"ebs\" of 0", "\"ebs\" too"});
    std::size_t meters = 0;
    for (const models::IngressConfig& config : usage_.resolved().plan.ingress_configs)
      meters += config.flow_meters.size();
    if (meter.color_aware && meters == 1)
      warn(meter.where.at("color_aware"), "colours that nobody gives",
           {"no other flow meter in the network", "a meter before this one"});
  }

  const Usage& usage_;
  const Ingress& ingress_;
  const std::vector<std::uint32_t>& nodes_;
  json::Diagnostics& diagnostics_;
  Met here_;
};

}  // namespace

void report_ineffective_ingress(const Usage& usage, json::Diagnostics& diagnostics) {
  for (const IngressUse& use : usage.ingress()) IngressTeller(usage, use, diagnostics).run();
}

}  // namespace takt::scenario
