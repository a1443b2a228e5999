// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "json/override.hpp"
#include "json/suggest.hpp"
#include "models/ethernet/sizes.hpp"
#include "plant/limits.hpp"
#include "plant/program_check.hpp"
#include "plant/protocol.hpp"
#include "plant/topic_check.hpp"
#include "scenario/applications/resolve_applications.hpp"
#include "scenario/figures/requirement.hpp"
#include "scenario/gates/resolve_gates.hpp"
#include "scenario/idle/idle.hpp"
#include "scenario/resolve/clocks.hpp"
#include "scenario/resolve/cpus.hpp"
#include "scenario/resolve/demand.hpp"
#include "scenario/resolve/devices.hpp"
#include "scenario/resolve/egress.hpp"
#include "scenario/resolve/faults.hpp"
#include "scenario/resolve/gate_limits.hpp"
#include "scenario/resolve/ingress.hpp"
#include "scenario/resolve/known_names.hpp"
#include "scenario/resolve/nesting.hpp"
#include "scenario/resolve/os_profiles.hpp"
#include "scenario/resolve/policing.hpp"
#include "scenario/resolve/port_abilities.hpp"
#include "scenario/resolve/port_configs.hpp"
#include "scenario/resolve/program_streams.hpp"
#include "scenario/resolve/replies.hpp"
#include "scenario/resolve/requirements.hpp"
#include "scenario/resolve/roles.hpp"
#include "scenario/resolve/stream_builder.hpp"
#include "scenario/resolve/talker_ats.hpp"
#include "scenario/resolve/trace_file.hpp"
#include "scenario/resolve/windows.hpp"

namespace takt::scenario {
namespace {

using plant::most_publishers;

class Resolver {
 public:
  Resolver(Resolved& resolved, json::Diagnostics& diagnostics) : r_(resolved), diagnostics_(diagnostics) {}

  void run() {
    r_.scenario.streams.shrink_to_fit();  // before anybody points into them
    read_devices(r_.scenario, diagnostics_);
    r_.topology = build_topology(r_.scenario.network, diagnostics_);
    set_device_clocks(r_.topology, r_.scenario);
    plan_nodes();
    r_.plan.links = r_.topology.links;
    resolve_egress(r_, diagnostics_);
    take(plan_clocks(r_, diagnostics_));
    StreamBuilder builder(r_, diagnostics_);
    builder_ = &builder;
    check_names();
    for (const Stream& stream : r_.scenario.streams)
      if (is_read(stream)) add_stream(stream);
    check_processing(r_.topology, diagnostics_);
    for (const Program& program : r_.scenario.programs)
      if (is_read(program)) add_program(program);
    resolve_applications(r_, builder, publishers_, diagnostics_);
    check_publishers();
    resolve_cpus(r_, diagnostics_);
    resolve_nesting(r_, diagnostics_);
    check_candidates(r_, diagnostics_);
    resolve_ingress(r_, diagnostics_);
    r_.ports = demands_of(r_, diagnostics_);
    check_policing(r_, diagnostics_);
    resolve_talker_ats(r_, diagnostics_);
    resolve_gates_and_offsets(r_, diagnostics_);
    check_cut_through(r_, diagnostics_);
    check_slopes(r_, diagnostics_);
    add_launch_classes(r_, diagnostics_);
    for (const ScriptEntry& entry : r_.scenario.script)
      if (is_read(entry)) add_action(entry);
    check_gate_limits(r_, diagnostics_);
    check_port_abilities(r_, diagnostics_);
    check_devices(r_, diagnostics_);
    take(plan_faults(r_, diagnostics_));
    check_windows(r_, diagnostics_);
    std::stable_sort(r_.script.begin(), r_.script.end(),
                     [](const ResolvedAction& a, const ResolvedAction& b) { return a.at < b.at; });
    r_.requirements = requirements_of(r_, diagnostics_);
    if (!diagnostics_.has_errors()) report_ineffective(r_, diagnostics_);
    builder_ = nullptr;
    r_.give_back_room();
  }

 private:
  /// Of an entry that is no object nothing is known.
  template <class Entry>
  bool is_read(const Entry& entry) const {
    return entry.where.is_known() || !diagnostics_.has_errors();
  }

  void plan_nodes() {
    r_.plan.port_configs.clear();
    r_.plan.os_latencies.clear();
    std::vector<OperatingSystem> systems;  // equal ones share their entry
    for (const TopologyNode& node : r_.topology.nodes) {
      models::NodePlan plan;
      plan.name = node.name;
      plan.kind = !node.forwards()        ? models::NodeKind::host
                  : node.is_end_station() ? models::NodeKind::station
                                          : models::NodeKind::bridge;
      plan.port_config = port_config_index(r_.plan, port_config_of(ports_of(node.description)));
      if (const EndStation* const host = end_station_of(node.description)) {
        auto found = std::find(systems.begin(), systems.end(), host->os);
        if (found == systems.end()) {
          r_.plan.os_latencies.push_back(os_latency_of(host->os, diagnostics_));
          systems.push_back(host->os);
          found = systems.end() - 1;
        }
        plan.os_latency = static_cast<std::uint32_t>(found - systems.begin());
      }
      if (const Relay* const bridge = relay_of(node.description)) {
        plan.forwarding_delay = bridge->forwarding_delay;
        plan.cut_through_header = bridge->cut_through_header;
        plan.forwarding_jitter = jitter_of(*bridge, ports_of(node.description));
      }
      r_.plan.nodes.push_back(std::move(plan));
    }
    const NetworkSection& network = r_.scenario.network;
    if (network.nodes.empty() && network.generate.empty())
      diagnostics_.error_unless(!r_.topology.has_all_nodes, network.where.place(), "a network without nodes",
                                {"no nodes", "\"nodes\" or \"generate\""});
  }

  /// Nothing if there is none; one that is not limited, or stands where the delay must be known, is refused.
  std::shared_ptr<const sim::Distribution> jitter_of(const Relay& bridge, const NodePorts& ports) {
    if (!bridge.forwarding_jitter) return nullptr;
    const json::Source& where = bridge.forwarding_jitter->where;
    if (diagnostics_.is_refused(where.place())) return nullptr;  // generated switches share theirs
    const sim::Distribution jitter = distribution_of(*bridge.forwarding_jitter, diagnostics_);
    if (jitter.greatest() > 1_s)
      diagnostics_.error(where.place(), "a jitter without a limit",
                         {"up to " + json::to_text(jitter.greatest()), "a \"max\" of at most 1s"});
    const bool cuts = std::any_of(ports.egress.begin(), ports.egress.end(),
                                  [](const Egress& egress) { return !egress.cut_through.empty(); });
    if (cuts)
      diagnostics_.error(where.place(), "jitter where frames are cut through",
                         {"\"cut_through\" in \"egress\"", "one of them"});
    if (bridge.ingress && bridge.ingress->cqf)
      diagnostics_.error(where.place(), "jitter beside cyclic queuing",
                         {"\"cqf\", whose buffers frames reach at known times", "one of them"});
    return jitter.greatest() > Duration() ? std::make_shared<const sim::Distribution>(jitter) : nullptr;
  }

  void take(ClockPlans clocks) {
    for (std::size_t n = 0; n < clocks.of_nodes.size(); ++n) r_.plan.nodes[n].clock = std::move(clocks.of_nodes[n]);
    r_.plan.gptp = std::move(clocks.gptp);
    r_.plan.gptp_stations = std::move(clocks.gptp_stations);
  }

  void take(FaultPlan faults) {
    std::ranges::move(faults.actions, std::back_inserter(r_.script));
    std::ranges::move(faults.impairments, std::back_inserter(r_.plan.impairments));
    std::ranges::move(faults.babblers, std::back_inserter(r_.plan.talkers));
    for (const std::uint32_t link : faults.failing_links) r_.plan.links[link].may_fail = true;
    for (models::LinkPlan& link : r_.plan.links)
      for (models::LinkPlan::End* const end : {&link.a, &link.b})
        end->gates_may_stick = faults.stuck_ports.contains({end->node.value, end->port});
  }

  void check_names() {
    std::set<std::string, std::less<>> names;
    const auto check = [&](const std::string& name, const json::Source& where) {
      if (name.empty() && diagnostics_.has_errors()) return;  // refused by the table
      if (name.find('/') != std::string::npos)
        diagnostics_.error(where.at("name"), "not a name for a stream, program or application",
                           {json::quote(name), "no '/', which stands in the names of streams"});
      if (!names.insert(name).second)
        diagnostics_.error(
            where.at("name"), "duplicate name",
            {json::quote(name) + " a second time", "a name of its own for each stream, program and application"});
    };
    for (const Stream& stream : r_.scenario.streams) check(stream.name, stream.where);
    for (const Program& program : r_.scenario.programs) check(program.name, program.where);
    for (const Application& application : r_.scenario.applications) check(application.name, application.where);
    for (const Gateway& gateway : r_.scenario.gateways) check(gateway.name, gateway.where);
    for (const Persistence& service : r_.scenario.persistence) check(service.name, service.where);
  }

  void add_stream(const Stream& stream) {
    NewStream wanted;
    wanted.name = stream.name;
    wanted.where = stream.where;
    if (stream.path) wanted.path = &*stream.path;
    if (stream.redundancy) wanted.redundancy = &*stream.redundancy;
    wanted.from = builder_->host(stream.from, stream.where.at("from"));
    for (std::size_t i = 0; i < stream.to.names.size(); ++i) {
      const json::Place place = stream.to.names.size() == 1 ? stream.where.at("to") : stream.where.at("to", i);
      if (const auto host = builder_->host(stream.to.names[i], place)) wanted.to.push_back({*host, place});
    }
    wanted.priority = stream.pcp;
    wanted.vlan = stream.vlan;
    if (!stream.pcp && stream.vlan != 0)
      diagnostics_.error(stream.where.at("vlan"), "a VLAN without a priority",
                         {"\"vlan\" alone", "\"pcp\" too, since the tag carries both"});
    wanted.headers = stream.encapsulation == Encapsulation::udp ? models::ipv4_and_udp_headers : Octets{0};
    check_route(stream);
    models::TalkerSchedule schedule = schedule_of(stream);
    wanted.payload = stream.payload;
    if (const auto* trace = std::get_if<models::TraceSchedule>(&schedule))
      for (const auto& entry : trace->entries) wanted.payload = std::max(wanted.payload, entry.payload);
    if (stream.host_priority && stream.pcp)
      diagnostics_.error(
          stream.where.at("host_priority"), "two priorities",
          {"\"host_priority\" beside \"pcp\"", "\"pcp\" alone, by which the host queues tagged frames, too"});
    const auto index = builder_->add(wanted);
    if (!index) return;
    if (!stream.pcp) r_.plan.streams[index->value].host_priority = stream.host_priority;
    r_.streams[index->value].demand = demand_of(schedule, stream, *index);
    models::TalkerPlan talker{*index, stream.payload, std::move(schedule), stream.launch};
    if (stream.until) talker.until = sim::LocalTime() + *stream.until;
    if (stream.until && stream.offset && !stream.offset->is_auto && *stream.until <= stream.offset->value)
      diagnostics_.error_unless(
          diagnostics_.is_refused(stream.where.at("offset")) || diagnostics_.is_refused(stream.where.at("until")),
          stream.where.at("until"), "a stream that ends before it begins",
          {json::to_text(*stream.until), "more than its \"offset\" of " + json::to_text(stream.offset->value)});
    r_.plan.talkers.push_back(std::move(talker));
  }

  /// Of one path, from one host to another.
  void check_route(const Stream& stream) {
    if (!stream.route) return;
    if (stream.path)
      diagnostics_.error(stream.where.at("route"), "two ways of one stream",
                         {"\"route\" beside \"path\"", "one of the two"});
    if (stream.redundancy)
      diagnostics_.error(stream.where.at("route"), "a route of a redundant stream",
                         {"\"route\" beside \"redundancy\"", "\"count\" or \"paths\" in \"redundancy\""});
    if (stream.to.names.size() > 1)
      diagnostics_.error(stream.where.at("route"), "a route for several receivers",
                         {std::to_string(stream.to.names.size()) + " receivers", "one receiver"});
    if (r_.scenario.rerouting)
      diagnostics_.error(
          stream.where.at("route"), "a route beside rerouting",
          {"\"auto\" beside \"rerouting\", which takes the shortest paths that are left", "one of the two"});
  }

  models::TalkerSchedule schedule_of(const Stream& stream) {
    if (stream.every) {
      if (stream.jitter > *stream.every && !diagnostics_.is_refused(stream.where.at("every")))
        diagnostics_.error(stream.where.at("jitter"), "jitter above the period",
                           {json::to_text(stream.jitter), "at most " + json::to_text(*stream.every)});
      return models::PeriodicSchedule{stream.offset.value_or(Duration()), *stream.every, stream.jitter};
    }
    if (stream.offset && stream.offset->is_auto)
      diagnostics_.error_unless(diagnostics_.is_refused(stream.where.at("every")), stream.where.at("offset"),
                                "an offset that is chosen belongs to a periodic stream",
                                {"\"auto\" without \"every\"", "\"every\", or an offset"});
    if (stream.jitter > Duration())
      diagnostics_.error(stream.where.at("jitter"), "jitter belongs to a periodic stream",
                         {"\"jitter\" without \"every\"", "\"every\""});
    if (stream.exponential)
      return models::ExponentialSchedule{stream.offset.value_or(Duration()), stream.exponential->mean};
    if (stream.normal) return normal_gaps_of(stream, *stream.normal);
    if (stream.burst) {
      if (stream.burst->frames > 1 &&
          stream.burst->spacing > stream.burst->every / static_cast<std::int64_t>(stream.burst->frames - 1))
        diagnostics_.error(
            stream.where.at("burst"), "a burst longer than its period",
            {std::to_string(stream.burst->frames) + " frames " + json::to_text(stream.burst->spacing) + " apart",
             "at most " + json::to_text(stream.burst->every)});
      return models::BurstSchedule{stream.offset.value_or(Duration()), stream.burst->every, stream.burst->frames,
                                   stream.burst->spacing};
    }
    if (stream.trace) {
      models::TraceSchedule schedule{read_trace(*stream.trace, stream.where.at("trace"), diagnostics_)};
      for (auto& entry : schedule.entries) entry.time += stream.offset.value_or(Duration());
      return schedule;
    }
    return models::PeriodicSchedule{{}, 1_s, {}};  // none of them: the table has reported it
  }

  models::TalkerSchedule normal_gaps_of(const Stream& stream, const NormalGaps& normal) {
    const Duration longest = normal.max.value_or(Duration::max());
    const auto is_sound = [&](std::string_view key) { return !diagnostics_.is_refused(normal.where.at(key)); };
    // A deviation of 0 is one that is missing, which the table has reported.
    if (!is_sound("mean") || !is_sound("deviation") || !is_sound("min") || !is_sound("max") ||
        normal.deviation <= Duration())
      return models::PeriodicSchedule{{}, 1_s, {}};
    if (normal.min > normal.mean || normal.mean > longest)
      diagnostics_.error(
          normal.where.at("mean"), "a mean outside of what is left of the distribution",
          {json::to_text(normal.mean), normal.max ? json::to_text(normal.min) + " to " + json::to_text(*normal.max)
                                                  : "at least " + json::to_text(normal.min)});
    else if (normal.min == longest)
      diagnostics_.error(normal.where.at("max"), "gaps that are all alike",
                         {"\"min\" and \"max\" of " + json::to_text(longest), "a \"max\" above, or \"every\""});
    else
      return models::RandomGapSchedule{stream.offset.value_or(Duration()),
                                       std::make_shared<const sim::Distribution>(sim::Distribution::truncated_normal(
                                           normal.mean, normal.deviation, normal.min, longest))};
    return models::PeriodicSchedule{{}, 1_s, {}};
  }

  StreamDemand demand_of(const models::TalkerSchedule& schedule, const Stream& stream,
                         models::StreamIndex index) const {
    const models::StreamPlan& plan = r_.plan.streams[index.value];
    const auto wire_bits = [&](Octets payload) {
      return 8.0 * models::wire_length(models::frame_length(plan.headers + payload, plan.priority.has_value())).count;
    };
    // A period of 0 was refused by the table.
    const auto per_second = [](double frames, Duration in) {
      return in > Duration() ? frames * 1e12 / static_cast<double>(in.ps()) : 0.0;
    };
    StreamDemand demand;
    if (const auto* periodic = std::get_if<models::PeriodicSchedule>(&schedule))
      demand.frames_per_second = per_second(1, periodic->period);
    if (const auto* random = std::get_if<models::ExponentialSchedule>(&schedule))
      demand.frames_per_second = per_second(1, random->mean);
    if (const auto* random = std::get_if<models::RandomGapSchedule>(&schedule))
      demand.frames_per_second = per_second(1, random->gap->truncated_mean());
    if (const auto* burst = std::get_if<models::BurstSchedule>(&schedule))
      demand.frames_per_second = per_second(burst->frames, burst->period);
    demand.wire_bits_per_second = demand.frames_per_second * wire_bits(stream.payload);
    if (const auto* trace = std::get_if<models::TraceSchedule>(&schedule); trace != nullptr) {
      // Averaged over the whole run, or over the trace where that is longer: a short trace is a burst, not a load.
      Duration span = r_.scenario.duration;
      if (!trace->entries.empty()) span = std::max(span, trace->entries.back().time.since_start());
      double bits = 0;
      for (const auto& entry : trace->entries) bits += wire_bits(entry.payload);
      if (span > Duration()) {
        demand.frames_per_second = per_second(static_cast<double>(trace->entries.size()), span);
        demand.wire_bits_per_second = per_second(bits, span);
      }
    }
    return demand;
  }

  void add_program(const Program& program) {
    ResolvedProgram resolved;
    resolved.name = program.name;
    resolved.description = &program;
    resolved.receive_timeout = plant::receive_timeout_of(program);
    const std::size_t errors_before = diagnostics_.errors();
    if (program.roles.empty() && diagnostics_.is_refused(program.where.at("roles")))
      return;  // who is in it is not known
    plant::check_program(program, diagnostics_);
    resolved.participant_names = plant::participants_of(program);
    for (const std::string& name : resolved.participant_names)
      resolved.phases.push_back(plant::phase_of(program, name));
    if (program.roles.empty())
      add_slaves(program, resolved);
    else
      resolve_roles(r_, *builder_, resolved, diagnostics_);
    plant::check_members(program, static_cast<std::uint32_t>(models::maximum_msdu.count), may_be_node(), diagnostics_);
    if (program.roles.empty()) check_replies(program, diagnostics_);
    if (diagnostics_.errors() != errors_before) return;
    const std::size_t wanted = resolved.participant_names.size() + resolved.candidates().size();
    if (program.publisher_id) publishers_ = *program.publisher_id - std::size_t{1};
    if (publishers_ + wanted > most_publishers) {
      diagnostics_.error(
          program.where.place(), "too many participants of all programs together",
          {std::to_string(publishers_ + wanted) + " with this program", "at most " + std::to_string(most_publishers)});
      return;
    }
    resolved.first_publisher_id = static_cast<std::uint16_t>(publishers_ + 1);
    publishers_ += wanted;
    if (!lay_program_streams(r_, *builder_, resolved, diagnostics_)) return;
    resolve_replies(r_.topology, resolved);
    r_.programs.push_back(std::move(resolved));
  }

  /// The PublisherId says who sends, so no two have the same. Numbers that are not written are the next ones.
  void check_publishers() {
    struct Publishers {
      std::size_t first;
      std::size_t behind;
      const std::string* name;
      const json::Source* where;
    };
    std::vector<Publishers> all;
    for (const ResolvedProgram& each : r_.programs)
      all.push_back({each.first_publisher_id,
                     each.first_publisher_id + each.participant_names.size() + each.candidates().size(), &each.name,
                     &each.description->where});
    for (const ResolvedTopic& each : r_.topics)
      if (plant::has_uint16_publisher(*each.description))
        all.push_back(
            {each.publisher_id, each.publisher_id + std::size_t{1}, &each.description->name, &each.description->where});
    std::ranges::stable_sort(all, {}, &Publishers::first);
    for (std::size_t i = 1; i < all.size(); ++i)
      if (all[i].first < all[i - 1].behind)
        diagnostics_.error(all[i].where->at("publisher_id"), "a PublisherId twice",
                           {std::to_string(all[i].first) + ", which " + json::quote(*all[i - 1].name) + " has",
                            "PublisherIds of its own for " + json::quote(*all[i].name)});
  }

  /// Without roles: all are participants from the beginning.
  void add_slaves(const Program& program, ResolvedProgram& resolved) {
    const auto add_participant = [&](const std::string& name, const json::Place& place) {
      if (const auto host = builder_->host(name, place)) resolved.members.push_back({.node = models::NodeIndex{*host}});
    };
    add_participant(program.master, program.where.at("master"));
    for (std::size_t i = 0; i < program.slaves.size(); ++i)
      add_participant(program.slaves[i], program.where.at("slaves", i));
  }

  plant::MayBeNode may_be_node() const {
    return [this](std::string_view name) { return r_.topology.find(name).has_value(); };
  }

  void add_action(const ScriptEntry& entry) {
    if (r_.scenario.duration > Duration() && entry.at > r_.scenario.duration)  // 0: refused by the table
      diagnostics_.warning(entry.where.at("at"), "after the end of the simulation",
                           {json::to_text(entry.at), "at most " + json::to_text(r_.scenario.duration)});
    if (entry.call) {
      check_caller(entry);
      add_call(entry);
    }
    if (entry.join || entry.leave)
      if (const auto action = membership_of(r_, entry, diagnostics_)) r_.script.push_back(*action);
    if (entry.call || (!entry.set_gates && !entry.join && !entry.leave)) return;
    for (const auto& [present, name] :
         {std::pair(entry.program.has_value(), "program"), std::pair(entry.on.has_value(), "on")})
      if (present)
        diagnostics_.error(entry.where.at(name), "does not belong to this action",
                           {json::quote(name), "\"call\" with it"});
    if (entry.set_gates && is_read(*entry.set_gates)) add_gates(entry);
  }

  void add_gates(const ScriptEntry& entry) {
    const SetGates& set = *entry.set_gates;
    const auto node = r_.topology.find(set.node);
    if (!node) {
      report_unknown_node(r_.topology, set.node, set.where.at("node"), "the name of a node", diagnostics_);
      return;
    }
    if (set.gates.running)
      diagnostics_.error(
          set.gates.where.at("running"), "a list that is running before it is set",
          {"\"running\" of a list that the script sets", "a \"base_time\" alone, which may lie in the past"});
    const models::GateConfig gates = gate_config_of(set.gates, diagnostics_);
    bool found = false;
    for (const Neighbour& neighbour : r_.topology.neighbours[*node]) {
      if (set.to && !r_.topology.is_named(*set.to, neighbour.node, neighbour.their_port)) continue;
      found = true;
      check_slopes_of(set, *node, neighbour.port, gates);
      for (models::LinkPlan& link : r_.plan.links)
        for (models::LinkPlan::End* const end : {&link.a, &link.b})
          end->gates_may_change = end->gates_may_change || (end->node.value == *node && end->port == neighbour.port);
      r_.script.push_back({sim::TrueTime() + entry.at, ResolvedGates{models::NodeIndex{*node}, neighbour.port, gates}});
    }
    if (!found)
      report_no_neighbour(r_.topology, set.to.value_or(set.node), set.node, set.where.at(set.to ? "to" : "node"),
                          diagnostics_);
  }

  /// New gates must leave the shapers of the port a slope that its link can give.
  void check_slopes_of(const SetGates& set, std::uint32_t node, std::uint16_t port, const models::GateConfig& gates) {
    for (const models::LinkPlan& link : r_.plan.links) {
      for (const models::LinkPlan::End* end : {&link.a, &link.b}) {
        if (end->node.value != node || end->port != port || !end->port_config) continue;
        const models::ShapingConfig& shaping = r_.plan.port_configs[*end->port_config].shaping;
        for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
          if (const models::CreditBased* const shaper = shaping.shaper_of(q);
              shaper != nullptr && !slope_is_possible(*shaper, q, gates, link.rate))
            diagnostics_.error(set.where.at("gates"), "a shaper faster than its link while its gate is open",
                               {json::to_text(shaper->idle_slope) +
                                    " of the whole cycle in the part of it for which the gate of class " +
                                    std::to_string(q) + " is open",
                                "at most " + json::to_text(link.rate) + " then"});
      }
    }
  }

  /// Whatever the program is: who is a participant of none is a mistake of its own.
  void check_caller(const ScriptEntry& entry) {
    if (!entry.on || is_program(entry.program) ||
        !are_all_named(r_.scenario.programs, r_.scenario.where.at("programs"), diagnostics_))
      return;
    std::vector<std::string> names;
    for (const Program& program : r_.scenario.programs) {
      if (plant::may_be_participant(program, *entry.on, may_be_node(), diagnostics_)) return;
      for (std::string& name : plant::participants_of(program)) names.push_back(std::move(name));
    }
    const std::vector<std::string_view> known(names.begin(), names.end());
    if (std::ranges::find(known, *entry.on) == known.end())
      diagnostics_.error_unless(
          diagnostics_.is_refused(entry.where.at("on")), entry.where.at("on"), "not a participant of a program",
          {json::quote(*entry.on), "the master or a slave of one", json::suggest(*entry.on, known)});
  }

  bool is_program(const std::optional<std::string>& name) const {
    return name &&
           std::ranges::any_of(r_.scenario.programs, [&](const Program& program) { return program.name == *name; });
  }

  void add_call(const ScriptEntry& entry) {
    if (!entry.program) {
      diagnostics_.error(entry.where.place(), "missing key", {"\"call\" without a program", "\"program\""});
      return;
    }
    const Program* const program = find_program(r_.scenario, *entry.program, entry.where.at("program"), diagnostics_);
    if (program == nullptr) return;
    const auto participant =
        entry.on ? plant::participant_of(*program, *entry.on, entry.where.at("on"), may_be_node(), diagnostics_)
                 : std::optional<std::uint8_t>(0);
    if (!participant) return;
    if (const auto& callers = plant::callers_of(*program, *entry.call);
        callers && !diagnostics_.is_refused(entry.where.at("call")) &&
        !diagnostics_.is_refused(program->where.at("callers"))) {
      const std::string& on = entry.on ? *entry.on : program->master;
      if (std::ranges::find(*callers, on) == callers->end())
        diagnostics_.error(
            entry.on ? entry.where.at("on") : entry.where.at("call"), "a call that the program's \"callers\" exclude",
            {std::string(program::name_of(*entry.call)) + " on " + json::quote(on), "a participant that they name"});
    }
    // In the paper's handshake all participants may be started from outside; `robust` begins a run at the master.
    if (diagnostics_.is_refused(entry.where.at("call"))) return;
    if (*entry.call == Method::Start && *participant != 0 && program->variant == Variant::robust) {
      diagnostics_.error(entry.where.at("on"), "Start at a slave",
                         {json::quote(*entry.on), "the master, " + json::quote(program->master)});
      return;
    }
    if (*entry.call == Method::Start && program->within) {
      diagnostics_.error(entry.where.at("program"), "Start of a nested program",
                         {json::quote(program->name), "the outermost program, which starts it"});
      return;
    }
    const auto found = std::find_if(r_.programs.begin(), r_.programs.end(),
                                    [&](const ResolvedProgram& p) { return p.description == program; });
    if (found == r_.programs.end()) return;  // the program itself was refused
    r_.script.push_back(
        {sim::TrueTime() + entry.at,
         ResolvedCall{static_cast<std::uint32_t>(found - r_.programs.begin()), *participant, *entry.call}});
  }

  Resolved& r_;
  json::Diagnostics& diagnostics_;
  StreamBuilder* builder_ = nullptr;
  std::size_t publishers_ = 0;  // PublisherIds that are taken, from 1 on
};

}  // namespace

std::unique_ptr<Resolved> resolve(Scenario scenario, json::Diagnostics& diagnostics) {
  auto resolved = std::make_unique<Resolved>();
  resolved->scenario = std::move(scenario);
  const std::size_t errors_before = diagnostics.errors();
  Resolver(*resolved, diagnostics).run();
  if (diagnostics.errors() != errors_before) return nullptr;
  return resolved;
}

namespace {

std::unique_ptr<Resolved> load(std::optional<json::Document> document, const std::vector<std::string>& overrides,
                               json::Diagnostics& diagnostics) {
  if (!document) return nullptr;
  for (const std::string& option : overrides) json::apply(*document, option, diagnostics);
  Scenario scenario;
  // Checks of meaning run even if single values are wrong, so that all mistakes are seen at once; a wrong value keeps
  // its default there. Only a scenario without a network has nothing to check.
  json::decode(*document, scenario, diagnostics);
  auto resolved = scenario.network.where.is_known() ? resolve(std::move(scenario), diagnostics) : nullptr;
  return diagnostics.has_errors() ? nullptr : std::move(resolved);
}

}  // namespace

std::unique_ptr<Resolved> load_text(std::string_view text, const std::string& file_name,
                                    const std::vector<std::string>& overrides, json::Diagnostics& diagnostics) {
  return load(json::parse(text, file_name, diagnostics), overrides, diagnostics);
}

std::unique_ptr<Resolved> load_file(const std::string& path, const std::vector<std::string>& overrides,
                                    json::Diagnostics& diagnostics) {
  return load(json::parse_file(path, diagnostics), overrides, diagnostics);
}

}  // namespace takt::scenario
