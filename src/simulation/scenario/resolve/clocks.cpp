// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/clocks.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "scenario/resolve/gptp_links.hpp"
#include "scenario/resolve/os_profiles.hpp"

namespace takt::scenario {
namespace {

using models::gptp::PortRole;

constexpr PortRole role_of(GptpRole role) {
  constexpr PortRole roles[] = {PortRole::time_transmitter, PortRole::time_receiver, PortRole::passive,
                                PortRole::disabled};
  return roles[static_cast<std::size_t>(role)];
}

/// What the file says of nodes, by their names.
template <class T>
std::map<std::string_view, const T*> by_name(const json::NameMap<T>& nodes) {
  std::map<std::string_view, const T*> found;
  for (const auto& [name, node] : nodes) found.emplace(name, &node);
  return found;
}

class ClockResolver {
 public:
  ClockResolver(const Resolved& resolved, json::Diagnostics& diagnostics)
      : r_(resolved), clocks_(resolved.scenario.clocks), diagnostics_(diagnostics) {}

  ClockPlans run() {
    const bool free_running = clocks_.model == ClockModel::free_running || clocks_.all || clocks_.gptp;
    if (clocks_.all) check(*clocks_.all);
    for (const auto& [name, clock] : clocks_.nodes) {
      node_named(name, clocks_.where.at("nodes"));
      check(clock);
    }
    if (!free_running && clocks_.nodes.empty()) return {};
    made_.of_nodes.resize(r_.plan.nodes.size());
    const auto own = by_name(clocks_.nodes);
    for (std::uint32_t n = 0; n < r_.plan.nodes.size(); ++n) {
      const auto found = own.find(r_.plan.nodes[n].name);
      const Clock* clock = found != own.end() ? found->second : clocks_.all ? &*clocks_.all : nullptr;
      if (clock != nullptr ? clock->ideal && !clocks_.gptp : !free_running) continue;
      made_.of_nodes[n] = plan_of(clock != nullptr ? *clock : Clock{}, r_.plan.nodes[n].name);
    }
    if (clocks_.gptp) plan_gptp(*clocks_.gptp);
    return std::move(made_);
  }

 private:
  struct Instance {
    std::uint8_t domain = 0;
    std::map<std::string_view, const GptpNode*> nodes;
  };

  std::optional<std::uint32_t> node_named(const std::string& name, const json::Place& place) {
    const auto node = r_.topology.find(name);
    if (!node) report_unknown_node(r_.topology, name, place, "the name of a node", diagnostics_);
    return node;
  }

  void check_range(const FrequencyRange& range) {
    if (range.from.has_value() != range.to.has_value())
      diagnostics_.error(range.where.place(), "half a range",
                         {range.from ? "\"from\" alone" : "\"to\" alone", "\"from\" and \"to\""});
    if (range.fixed && range.from)
      diagnostics_.error(range.where.place(), "a range and a value", {"\"fixed\" and \"from\"", "one of them"});
    if (range.from && range.to && range.from->parts_per_trillion > range.to->parts_per_trillion)
      diagnostics_.error(range.where.at("to"), "a range that ends before it begins",
                         {json::to_text(*range.to), "at least " + json::to_text(*range.from)});
  }
  void check(const Clock& clock) {
    check_range(clock.offset);
    check_range(clock.drift);
    for (std::size_t i = 1; i < clock.table.size(); ++i)
      if (clock.table[i].at <= clock.table[i - 1].at)
        diagnostics_.error(clock.where.at("table", i), "a point that is not after the one before",
                           {json::to_text(clock.table[i].at), "more than " + json::to_text(clock.table[i - 1].at)});
  }

  models::NodeClockPlan plan_of(const Clock& clock, const std::string& name) {
    models::NodeClockPlan plan;
    plan.initial_offset = clock.initial;
    if (!clock.ideal) {
      const auto bounds = [](const FrequencyRange& range) {
        return std::pair(range.from.value_or(range.fixed.value_or(sim::FrequencyOffset{0})),
                         range.to.value_or(range.fixed.value_or(sim::FrequencyOffset{0})));
      };
      const auto [lowest, highest] = bounds(clock.offset);
      const auto [least_drift, greatest_drift] = bounds(clock.drift);
      models::OscillatorConfig& config = plan.oscillator;
      if (lowest.parts_per_trillion <= highest.parts_per_trillion &&
          least_drift.parts_per_trillion <= greatest_drift.parts_per_trillion)
        models::draw_oscillator({lowest, highest, least_drift.parts_per_trillion, greatest_drift.parts_per_trillion},
                                r_.scenario.seed, name, config);
      if (clock.temperature)
        config.temperature = models::SinusoidalFrequency{
            clock.temperature->amplitude, clock.temperature->period,
            clock.temperature->phase >= 1.0 ? 0 : static_cast<std::uint64_t>(clock.temperature->phase * 0x1p64)};
      if (clock.temperature && clock.temperature->any_phase)
        config.temperature->phase += sim::RandomStream(r_.scenario.seed, name, "temperature phase").next();
      if (clock.walk) config.walk = models::FrequencyWalk{clock.walk->step, clock.walk->bound};
      for (const FrequencyAt& point : clock.table)
        config.table.push_back({sim::TrueTime() + point.at, point.frequency});
      config.update_interval = clock.update;
    }
    models::TimestampUnit& unit = plan.timestamps;
    unit.granularity = clock.granularity;
    unit.jitter = clock.jitter;
    unit.egress_latency = clock.tx_latency;
    unit.ingress_latency = clock.rx_latency;
    unit.egress_correction = clock.tx_correction.value_or(clock.tx_latency);
    unit.ingress_correction = clock.rx_correction.value_or(clock.rx_latency);
    return plan;
  }

  void plan_gptp(const Gptp& gptp) {
    if (gptp.drift_window % 2 != 0)
      diagnostics_.error(gptp.where.at("drift_window"), "an odd window",
                         {std::to_string(gptp.drift_window), "an even number, two halves"});
    if (gptp.hot_standby && gptp.domains.empty() && !diagnostics_.is_refused(gptp.where.at("domains")))
      diagnostics_.error(gptp.where.at("hot_standby"), "a standby without a domain",
                         {"no \"domains\"", "a second domain"});
    if (gptp.standby_thresholds && !gptp.hot_standby && !diagnostics_.is_refused(gptp.where.at("hot_standby")))
      diagnostics_.error(gptp.standby_thresholds->where.place(), "thresholds without a standby",
                         {"no \"hot_standby\"", "\"hot_standby\": true"});
    std::set<std::uint8_t> numbers{0};
    for (const GptpDomain& domain : gptp.domains) {
      if (!domain.where.is_known() && diagnostics_.has_errors()) continue;
      if (!numbers.insert(domain.domain).second)
        diagnostics_.error(domain.where.at("domain"), "a domain twice",
                           {std::to_string(domain.domain), "a number of its own (0 is there already)"});
      check_nodes(domain.nodes, domain.where);
    }
    check_nodes(gptp.nodes, gptp.where);
    if (gptp.hot_standby) {
      check_grandmaster(gptp.nodes, gptp.where);
      if (!gptp.domains.empty()) check_grandmaster(gptp.domains.front().nodes, gptp.domains.front().where);
    }
    std::set<std::string> without(gptp.without.begin(), gptp.without.end());
    for (std::size_t i = 0; i < gptp.without.size(); ++i) node_named(gptp.without[i], gptp.where.at("without", i));
    check_classes();
    for (const IntervalRequest& request : gptp.interval_requests) check_request(request, numbers, without);
    if (diagnostics_.has_errors()) return;
    made_.gptp.resize(r_.plan.nodes.size());
    without_threshold_.resize(r_.plan.nodes.size());
    for (const models::LinkPlan& link : r_.plan.links)
      for (const models::LinkPlan::End* const end : {&link.a, &link.b})
        if (!link_delay_threshold(gptp, link)) without_threshold_[end->node.value].push_back(end->port);
    std::vector<Instance> instances{{0, by_name(gptp.nodes)}};
    for (const GptpDomain& domain : gptp.domains) instances.push_back({domain.domain, by_name(domain.nodes)});
    for (std::uint32_t n = 0; n < r_.plan.nodes.size(); ++n) {
      if (without.contains(r_.plan.nodes[n].name) || r_.topology.neighbours[n].empty()) continue;
      made_.gptp[n] = static_cast<std::uint32_t>(made_.gptp_stations.size());
      made_.gptp_stations.push_back(station_of(gptp, instances, n));
    }
  }

  void check_request(const IntervalRequest& request, const std::set<std::uint8_t>& domains,
                     const std::set<std::string>& without) {
    if (!request.where.is_known() && diagnostics_.has_errors()) return;
    const auto node = node_named(request.node, request.where.at("node"));
    const auto to = r_.topology.find(request.to);
    if (node && (!to || !r_.topology.port_towards(*node, *to)))
      report_no_neighbour(r_.topology, request.to, request.node, request.where.at("to"), diagnostics_);
    for (const auto& [key, name] : {std::pair("node", &request.node), std::pair("to", &request.to)})
      if (without.contains(*name))
        diagnostics_.error(request.where.at(key), "a request without gPTP",
                           {json::quote(*name) + ", which is in \"without\"", "a node that speaks gPTP"});
    if (!domains.contains(request.domain))
      diagnostics_.error(request.where.at("domain"), "a domain that is not there",
                         {std::to_string(request.domain), "0, or one of \"domains\""});
    const std::pair<std::string_view, std::optional<std::int8_t>> intervals[] = {
        {"sync", request.sync}, {"announce", request.announce}, {"link_delay", request.link_delay}};
    bool asks = false;
    for (const auto& [key, log] : intervals) {
      asks = asks || log;
      if (log && *log > 24 && *log < models::gptp::MessageInterval::initial)
        diagnostics_.error(request.where.at(key), "no interval",
                           {std::to_string(*log), "from -24 to 24, 126 (as at the beginning) or 127 (none)"});
    }
    if (!asks)
      diagnostics_.error_unless(diagnostics_.has_errors(), request.where.place(), "a request for nothing",
                                {"none of \"sync\", \"announce\" and \"link_delay\"", "one of them"});
  }

  /// Of node `n`, when names are known to be right.
  std::vector<models::gptp::TimedIntervalRequest> requests_of(const Gptp& gptp, const std::vector<Instance>& instances,
                                                              std::uint32_t n) const {
    std::vector<models::gptp::TimedIntervalRequest> made;
    for (const IntervalRequest& request : gptp.interval_requests) {
      if (request.node != r_.plan.nodes[n].name) continue;
      const auto instance = std::ranges::find(instances, request.domain, &Instance::domain);
      constexpr std::int8_t same = models::gptp::MessageInterval::as_it_is;
      made.push_back(
          {sim::TrueTime() + request.at,
           *r_.topology.port_towards(n, *r_.topology.find(request.to)),
           static_cast<std::size_t>(instance - instances.begin()),
           {request.link_delay.value_or(same), request.sync.value_or(same), request.announce.value_or(same)}});
    }
    return made;
  }

  void check_nodes(const json::NameMap<GptpNode>& nodes, const json::Source& where) {
    for (const auto& [name, node] : nodes) {
      const auto index = node_named(name, where.at("nodes"));
      if (!index || !node.roles) continue;
      std::size_t receivers = 0;
      for (const GptpPortRole& role : *node.roles) {
        const auto to = r_.topology.find(role.to);
        receivers += role.role == GptpRole::time_receiver;
        if (!to || !r_.topology.port_towards(*index, *to))
          report_no_neighbour(r_.topology, role.to, name, role.where.at("to"), diagnostics_);
      }
      if (receivers > 1)
        diagnostics_.error(node.where.at("roles"), "several time receivers",
                           {std::to_string(receivers) + " ports", "at most one"});
    }
  }

  /// Nobody is elected grandmaster of a domain of a hot standby who is not named: that would be a third source of time.
  void check_grandmaster(const json::NameMap<GptpNode>& nodes, const json::Source& where) {
    const bool is_named = std::any_of(nodes.begin(), nodes.end(), [](const auto& node) {
      return node.second.roles || node.second.priority1.value_or(255) < 255;
    });
    if (!is_named)
      diagnostics_.error_unless(
          !where.is_known() || diagnostics_.is_refused(where.at("nodes")), where.place(),
          "a domain of a hot standby without a grandmaster",
          {"no node with \"priority1\" or \"roles\"",
           "a \"priority1\" below 255 at the node that is to be grandmaster, or the \"roles\" of the ports"});
  }

  /// A message that is cut has no time stamp that means anything.
  void check_classes() {
    for (const models::PortConfig& config : r_.plan.port_configs)
      if (config.preemption && models::contains(config.preemption->preemptable, config.traffic_class_of_priority[7]))
        diagnostics_.error(
            clocks_.gptp->where.place(), "gPTP in a preemptable class",
            {"a port that may cut frames of priority 7, which gPTP has", "an express class for priority 7"});
  }

  models::gptp::StationPlan station_of(const Gptp& gptp, const std::vector<Instance>& instances, std::uint32_t n) {
    models::gptp::StationPlan plan;
    plan.instances.clear();
    for (std::size_t i = 0; i < instances.size(); ++i)
      plan.instances.push_back(config_of(gptp, instances[i], gptp.hot_standby && i < 2, n));
    plan.link.log_pdelay_req_interval = gptp.log_pdelay_interval;
    plan.log_gptp_capable_interval = gptp.log_gptp_capable_interval;
    plan.link.neighbor_rate_ratio_window = gptp.rate_ratio_window;
    plan.link.compensate_drift = gptp.drift_window > 0 || gptp.drift_tracking;
    plan.link.average_over = gptp.average_link_delay;
    plan.link.mean_link_delay_thresh =
        gptp.link_delay_threshold ? gptp.link_delay_threshold : models::gptp::LinkDelayConfig{}.mean_link_delay_thresh;
    plan.ports_without_threshold = without_threshold_[n];
    models::ServoConfig& servo = plan.target.servo;
    servo.kind = gptp.servo.algorithm == ServoAlgorithm::pi ? models::ServoKind::pi : models::ServoKind::drift_tracking;
    servo.log_sync_interval = gptp.log_sync_interval;
    servo.first_step_threshold = gptp.servo.first_step_threshold;
    servo.step_threshold = gptp.servo.step_threshold;
    servo.highest_frequency = gptp.servo.max_frequency;
    plan.interval_requests = requests_of(gptp, instances, n);
    if (gptp.processing) plan.processing = distribution_of(*gptp.processing, diagnostics_);
    if (gptp.processing && plan.processing.greatest() > 1_s)
      diagnostics_.error(gptp.processing->where.place(), "a processing without a limit",
                         {"up to " + json::to_text(plan.processing.greatest()), "a \"max\" of at most 1s"});
    if (gptp.hot_standby) plan.standby = standby_of(gptp.standby_thresholds.value_or(StandbyThresholds()));
    return plan;
  }

  static models::gptp::HotStandbyConfig standby_of(const StandbyThresholds& thresholds) {
    return {{thresholds.offset_max, thresholds.offset_met, thresholds.offset_exceeded, thresholds.rx_sync_count},
            thresholds.primary_secondary_offset,
            thresholds.waiting_time};
  }

  static models::gptp::TimeProperties properties_of(const AnnouncedTime& time) {
    unsigned flags = 0x08;  // the time scale is that of PTP
    if (time.leap == LeapSecond::leap61) flags |= 0x01U;
    if (time.leap == LeapSecond::leap59) flags |= 0x02U;
    if (time.utc_offset_valid) flags |= 0x04U;
    if (time.time_traceable) flags |= 0x10U;
    if (time.frequency_traceable) flags |= 0x20U;
    return {time.utc_offset, time.source, static_cast<std::uint8_t>(flags)};
  }

  models::gptp::InstanceConfig config_of(const Gptp& gptp, const Instance& instance, bool is_of_standby,
                                         std::uint32_t n) {
    models::gptp::InstanceConfig config;
    config.domain = instance.domain;
    config.log_sync_interval = gptp.log_sync_interval;
    config.log_announce_interval = gptp.log_announce_interval;
    config.sync_receipt_timeout = gptp.sync_receipt_timeout;
    config.announce_receipt_timeout = gptp.announce_receipt_timeout;
    config.two_step = !gptp.one_step;
    config.sync_locked = gptp.sync_locked;
    config.boundary = gptp.boundary;
    config.drift_tracking = gptp.drift_tracking;
    config.rate_ratio_drift_window = gptp.drift_window;
    constexpr std::uint8_t never_grandmaster = 255;
    if (is_of_standby) config.system.priority1 = never_grandmaster;
    if (const auto found = instance.nodes.find(r_.plan.nodes[n].name); found != instance.nodes.end()) {
      const GptpNode& node = *found->second;
      config.system.priority1 =
          node.priority1.value_or(is_of_standby && !node.roles ? never_grandmaster : std::uint8_t{248});
      config.system.priority2 = node.priority2;
      config.system.quality.clock_class = node.clock_class;
      config.system.quality.clock_accuracy = node.clock_accuracy;
      config.boundary = node.boundary.value_or(gptp.boundary);
      if (node.time) config.time = properties_of(*node.time);
      if (!node.roles) return config;
      std::uint16_t ports = 0;
      for (const Neighbour& neighbour : r_.topology.neighbours[n])
        ports = std::max<std::uint16_t>(ports, static_cast<std::uint16_t>(neighbour.port + 1));
      config.external_roles.emplace(ports, PortRole::time_transmitter);
      for (const GptpPortRole& role : *node.roles)
        if (const auto to = r_.topology.find(role.to))
          if (const auto port = r_.topology.port_towards(n, *to)) (*config.external_roles)[*port] = role_of(role.role);
    }
    return config;
  }

  const Resolved& r_;
  ClockPlans made_;
  std::vector<std::vector<std::uint16_t>> without_threshold_;  // ports, by node
  const Clocks& clocks_;
  json::Diagnostics& diagnostics_;
};

}  // namespace

ClockPlans plan_clocks(const Resolved& resolved, json::Diagnostics& diagnostics) {
  return ClockResolver(resolved, diagnostics).run();
}

}  // namespace takt::scenario
