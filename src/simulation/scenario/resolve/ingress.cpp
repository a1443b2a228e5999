// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/ingress.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "json/suggest.hpp"
#include "scenario/resolve/cqf.hpp"
#include "scenario/resolve/ingress_tables.hpp"
#include "scenario/resolve/known_names.hpp"
#include "scenario/resolve/port_configs.hpp"
#include "scenario/resolve/redundancy.hpp"

namespace takt::scenario {
namespace {

/// What crosses a switch, and what of it the switch splits or makes one again.
struct Crossing {
  std::vector<std::uint32_t> streams;                   // ascending
  std::vector<const ResolvedRedundancy*> redundancies;  // of those streams
};

/// Whether the bridge of that node does it.
bool splits_at(const ResolvedRedundancy& redundancy, std::uint32_t node) {
  return redundancy.split == node && !redundancy.splits_in_host;
}
bool merges_at(const ResolvedRedundancy& redundancy, std::uint32_t node) {
  return redundancy.merge == node && !redundancy.merges_in_host;
}
bool numbers_at(const ResolvedRedundancy& redundancy, std::uint32_t node) {
  return redundancy.number == node && redundancy.number != redundancy.split && !redundancy.numbers_in_host;
}
/// The relay of a ladder there, if it is the bridge of that node.
const ResolvedRedundancy::Relay* relay_at(const ResolvedRedundancy& redundancy, std::uint32_t node) {
  const bool is_in_host = (redundancy.split == node && redundancy.splits_in_host) ||
                          (redundancy.merge == node && redundancy.merges_in_host);
  return is_in_host ? nullptr : redundancy.relay_at(node);
}
bool has_function_at(const ResolvedRedundancy& redundancy, std::uint32_t node) {
  return splits_at(redundancy, node) || merges_at(redundancy, node) || numbers_at(redundancy, node) ||
         relay_at(redundancy, node) != nullptr;
}
/// Of a host that is a relay at one end of a ladder.
std::vector<models::StreamMember> members_of(const ResolvedRedundancy& redundancy,
                                             const std::vector<std::uint32_t>& numbers) {
  std::vector<models::StreamMember> members;
  for (const std::uint32_t number : numbers) members.push_back(redundancy.members[number]);
  return members;
}

/// The ingress of one switch or station.
class NodeIngress {
 public:
  NodeIngress(Resolved& resolved, std::uint32_t node, const Crossing& crossing, json::Diagnostics& diagnostics)
      : r_(resolved),
        node_(node),
        crossing_(crossing),
        description_(relay_of(resolved.topology.nodes[node].description)->ingress),
        diagnostics_(diagnostics) {
    config_.traffic_class_of_priority = r_.plan.port_configs[r_.plan.nodes[node].port_config].traffic_class_of_priority;
    for (const models::LinkPlan& link : r_.plan.links)
      if (link.a.node.value == node || link.b.node.value == node) fastest_ = std::max(fastest_, link.rate);
  }

  models::IngressConfig build() {
    for (const ResolvedRedundancy* const redundancy : crossing_.redundancies)
      if (has_function_at(*redundancy, node_)) add_redundancy(*redundancy);
    if (description_) add_description();
    return std::move(config_);
  }

 private:
  std::string name_of_node() const { return json::quote(r_.topology.nodes[node_].name); }

  void add_redundancy(const ResolvedRedundancy& redundancy) {
    const models::StreamHandle handle = handle_of(redundancy.stream.value);
    if (numbers_at(redundancy, node_)) config_.splits.push_back({handle, numbering_config(r_, redundancy)});
    if (redundancy.is_ladder()) {
      const ResolvedRedundancy::Relay* const relay = relay_at(redundancy, node_);
      if (relay != nullptr && relay->in.size() > 1)
        config_.recoveries.push_back({handle, ladder_recovery(r_, redundancy, *relay, diagnostics_)});
      if (relay != nullptr && relay->out.size() > 1)
        config_.splits.push_back({handle, {members_of(redundancy, relay->out)}});
      return;
    }
    if (splits_at(redundancy, node_)) config_.splits.push_back({handle, {redundancy.members}});
    if (merges_at(redundancy, node_))
      config_.recoveries.push_back({handle, recovery_config(r_, redundancy, diagnostics_)});
  }

  /// The handle of a stream of the plan; identified by its address, and by those of its members.
  models::StreamHandle handle_of(std::uint32_t stream) {
    const auto [at, is_new] =
        handles_.try_emplace(stream, models::StreamHandle{static_cast<std::uint32_t>(config_.streams.size())});
    if (!is_new) return at->second;
    const models::StreamPlan& plan = r_.plan.streams[stream];
    config_.streams.push_back(plan.name);
    config_.stream_identity_table.push_back(
        {at->second, models::AddressIdentification{plan.destination, models::Tagged::all, plan.vlan}});
    for (const ResolvedRedundancy* const redundancy : crossing_.redundancies) {
      if (redundancy->stream.value != stream || splits_at(*redundancy, node_)) continue;
      for (std::size_t i = 0; i < redundancy->members.size(); ++i) {
        const models::StreamMember& member = redundancy->members[i];
        models::StreamIdentityEntry entry{
            at->second, models::AddressIdentification{member.destination, models::Tagged::all, member.vlan}};
        if (redundancy->is_ladder()) {
          const ResolvedRedundancy::Relay* const relay = relay_at(*redundancy, node_);
          const auto place =
              relay == nullptr ? std::vector<std::uint32_t>::const_iterator() : std::ranges::find(relay->in, i);
          if (relay != nullptr && relay->in.size() > 1 && place != relay->in.end())
            entry.member = static_cast<std::uint16_t>(place - relay->in.begin());
        } else if (merges_at(*redundancy, node_)) {
          entry.member = static_cast<std::uint16_t>(i);
        }
        config_.stream_identity_table.push_back(entry);
      }
    }
    return at->second;
  }

  void add_description() {
    check_names(description_->streams);
    check_names(description_->gates);
    check_names(description_->meters);
    check_names(description_->ats);
    check_names(description_->ats_groups);
    for (const IdentifiedStream& stream : description_->streams) add_stream(stream);
    for (const StreamGateEntryList& gate : description_->gates)
      config_.stream_gates.push_back(stream_gate_of(gate, diagnostics_));
    for (const Meter& meter : description_->meters)
      config_.flow_meters.push_back(meter_of(r_, meter, fastest_, diagnostics_));
    for (const AtsGroupEntry& group : description_->ats_groups)
      config_.ats_groups.push_back(
          {group.name, group.max_residence_time.value_or(description_->max_residence_time.value_or(Duration::max()))});
    config_.maximum_residence_time = description_->max_residence_time.value_or(Duration::max());
    for (const AtsEntry& entry : description_->ats) add_scheduler(entry);
    if (description_->cqf) add_cqf_gate(*description_->cqf);
    for (const StreamFilterEntry& filter : description_->filters) add_filter(filter);
    if (description_->cqf) add_cqf_filters(*description_->cqf);
  }

  template <class Entry>
  void check_names(const std::vector<Entry>& entries) {
    std::set<std::string_view> names;
    for (const Entry& entry : entries)
      if (!names.insert(entry.name).second)
        diagnostics_.error(entry.where.at("name"), "duplicate name",
                           {json::quote(entry.name) + " a second time", "a name of its own in its table"});
  }

  /// The index of what is called so; none if nothing is (reported).
  template <class Index, class Entry, class Written>
  Index find(const std::vector<Entry>& made, const std::vector<Written>& entries, const std::string& name,
             const json::Place& place, std::string_view what, std::string_view table) {
    std::vector<std::string_view> names;
    for (std::uint32_t i = 0; i < made.size(); ++i) {
      if (made[i].name == name) return Index{i};
      names.push_back(made[i].name);
    }
    diagnostics_.error_unless(
        !are_all_named(entries, description_->where.at(table), diagnostics_), place, "unknown " + std::string(what),
        {json::quote(name), "a name under \"" + std::string(table) + "\" of this ingress", json::suggest(name, names)});
    return {};
  }

  void add_stream(const IdentifiedStream& stream) {
    const models::StreamHandle handle{static_cast<std::uint32_t>(config_.streams.size())};
    config_.streams.push_back(stream.name);
    named_.try_emplace(stream.name, handle);
    auto entry = identity_of(r_, stream, diagnostics_);
    if (!entry) return;
    entry->stream = handle;
    config_.stream_identity_table.push_back(std::move(*entry));
  }

  void add_scheduler(const AtsEntry& entry) {
    models::AtsSchedulerConfig scheduler{entry.name, entry.rate, entry.burst, entry.length == LengthOf::wire, {}};
    if (entry.group)
      scheduler.group = find<models::AtsGroupIndex>(config_.ats_groups, description_->ats_groups, *entry.group,
                                                    entry.where.at("group"), "group of ATS schedulers", "ats_groups");
    if (entry.rate > fastest_)
      diagnostics_.error_unless(
          !r_.topology.has_all_links, entry.where.at("rate"), "a scheduler faster than every link",
          {json::to_text(entry.rate), "at most " + json::to_text(fastest_) + ", the fastest link of the switch"});
    config_.ats_schedulers.push_back(std::move(scheduler));
  }

  void add_filter(const StreamFilterEntry& filter) {
    models::StreamFilterConfig config;
    if (filter.stream) config.stream_handle = handle_of_name(*filter.stream, filter.where.at("stream"));
    config.priority = filter.pcp;
    config.maximum_sdu_size = filter.max_sdu.value_or(Octets{0});
    if (filter.block_oversize && !filter.max_sdu)
      diagnostics_.error(filter.where.at("block_oversize"), "no frame is too long",
                         {"\"block_oversize\" without \"max_sdu\"", "\"max_sdu\" too"});
    config.stream_blocked_due_to_oversize_frame_enable = filter.block_oversize;
    if (filter.gate)
      config.stream_gate = find<models::StreamGateIndex>(config_.stream_gates, description_->gates, *filter.gate,
                                                         filter.where.at("gate"), "stream gate", "gates");
    if (filter.meter)
      config.flow_meter = find<models::FlowMeterIndex>(config_.flow_meters, description_->meters, *filter.meter,
                                                       filter.where.at("meter"), "flow meter", "meters");
    if (filter.ats)
      config.ats_scheduler = find<models::AtsSchedulerIndex>(config_.ats_schedulers, description_->ats, *filter.ats,
                                                             filter.where.at("ats"), "ATS scheduler", "ats");
    const auto shadows = [&](const models::StreamFilterConfig& other) {
      return (!other.stream_handle || other.stream_handle == config.stream_handle) &&
             (!other.priority || other.priority == config.priority);
    };
    if (!diagnostics_.has_errors() &&
        std::any_of(config_.stream_filters.begin(), config_.stream_filters.end(), shadows))
      diagnostics_.warning(filter.where.place(), "a filter that no frame reaches",
                           {"an earlier filter for the same frames", "the more special filter first"});
    config_.stream_filters.push_back(config);
  }

  std::optional<models::StreamHandle> handle_of_name(const std::string& name, const json::Place& place) {
    if (const auto named = named_.find(name); named != named_.end()) return named->second;
    const models::StreamIndex stream = find_stream(r_, name);
    if (!stream.is_none()) {
      // The switches of a generator share one description; what only some of them need is no mistake.
      const bool is_generated = place.pointer.starts_with("/network/generate/");
      if (!diagnostics_.has_errors() && !is_generated &&
          !std::binary_search(crossing_.streams.begin(), crossing_.streams.end(), stream.value))
        diagnostics_.warning(place, "a filter that no frame reaches",
                             {json::quote(name) + ", which does not cross " + name_of_node(), "a stream that does"});
      return handle_of(stream.value);
    }
    std::vector<std::string_view> names;
    for (const auto& [known, handle] : named_) names.push_back(known);
    for (const models::StreamPlan& plan : r_.plan.streams) names.push_back(plan.name);
    const StreamNames known(r_, diagnostics_);
    const bool is_refused =
        known.may_be(name) || !are_all_named(description_->streams, description_->where.at("streams"), diagnostics_);
    diagnostics_.error_unless(
        is_refused, place, "unknown stream",
        {json::quote(name), "a name under \"streams\" of this ingress or of the scenario", json::suggest(name, names)});
    return models::StreamHandle{};
  }

  void add_cqf_gate(const Cqf& cqf) {
    times_ = cqf_times(cqf, r_.topology, node_);
    if (cqf.buffers && *cqf.buffers != cqf.classes.size())
      diagnostics_.error(
          cqf.where.at("buffers"), "not a class for each buffer",
          {std::to_string(*cqf.buffers) + " buffers in " + std::to_string(cqf.classes.size()) + " classes",
           "as many classes as buffers"});
    if (cqf.offset && *cqf.offset > Duration() && cqf.classes.size() == 2)
      diagnostics_.error(cqf.where.at("offset"), "receiving into the buffer that is sent from",
                         {json::to_text(*cqf.offset) + " with two buffers", "three buffers, or \"dead_time\""});
    cqf_fits_ = cqf.classes.size() >= 2 && cqf.cycle > Duration() &&
                !diagnostics_.is_refused(cqf.where.place());  // else refused by the table
    if (!cqf_fits_) return diagnostics_.consequence();
    if (times_.dead_time >= cqf.cycle) {
      diagnostics_.error(
          cqf.where.at("dead_time"), "no time to send",
          {"a dead time of " + json::to_text(times_.dead_time) + " in a cycle of " + json::to_text(cqf.cycle),
           "a shorter one"});
      cqf_fits_ = false;
    }
    if (times_.offset >= cqf.cycle) {
      diagnostics_.error(cqf.where.at("offset"), "an offset beyond the cycle",
                         {json::to_text(times_.offset), "less than " + json::to_text(cqf.cycle)});
      cqf_fits_ = false;
    }
    for (const models::StreamGateConfig& gate : config_.stream_gates)
      if (gate.name == "cqf")
        diagnostics_.error(cqf.where.place(), "duplicate name",
                           {"a stream gate \"cqf\" beside CQF", "another name for that gate"});
    if (!cqf_fits_) return;
    config_.stream_gates.push_back(cqf_stream_gate(cqf, times_, config_.traffic_class_of_priority));
    set_port_gates(cqf);
  }

  void set_port_gates(const Cqf& cqf) {
    const GatesSet done = set_gates(r_.plan, models::NodeIndex{node_}, cqf_port_gates(cqf, times_),
                                    [](const models::LinkPlan::End&) { return true; });
    if (done.twice)
      diagnostics_.error(cqf.where.place(), "a port configured twice",
                         {"gates in \"egress\" beside CQF, which makes them", "one of the two"});
  }

  void add_cqf_filters(const Cqf& cqf) {
    if (!cqf_fits_) return;
    for (const models::Priority priority : cqf_priorities(cqf, config_.traffic_class_of_priority)) {
      models::StreamFilterConfig filter;
      filter.priority = priority;
      filter.stream_gate = models::StreamGateIndex{static_cast<std::uint32_t>(config_.stream_gates.size() - 1)};
      config_.stream_filters.push_back(filter);
    }
  }

  Resolved& r_;
  std::uint32_t node_;
  const Crossing& crossing_;
  const std::optional<Ingress>& description_;
  json::Diagnostics& diagnostics_;
  models::IngressConfig config_;
  DataRate fastest_;
  std::map<std::uint32_t, models::StreamHandle> handles_;  // of streams of the plan
  std::map<std::string, models::StreamHandle, std::less<>> named_;
  CqfTimes times_;
  bool cqf_fits_ = false;
};

std::vector<Crossing> crossings_of(const Resolved& r) {
  std::vector<Crossing> crossings(r.topology.nodes.size());
  for (const ResolvedStream& stream : r.streams)
    for (const Path& path : stream.paths)
      for (const std::uint32_t node : path)
        if (auto& streams = crossings[node].streams; streams.empty() || streams.back() != stream.index.value)
          streams.push_back(stream.index.value);
  for (const ResolvedRedundancy& redundancy : r.redundancies) {
    std::set<std::uint32_t> nodes;
    for (const Path& path : r.streams[redundancy.stream.value].paths) nodes.insert(path.begin(), path.end());
    for (const std::uint32_t node : nodes) crossings[node].redundancies.push_back(&redundancy);
  }
  return crossings;
}

}  // namespace

void resolve_ingress(Resolved& r, json::Diagnostics& diagnostics) {
  const std::vector<Crossing> crossings = crossings_of(r);
  for (const ResolvedRedundancy& redundancy : r.redundancies) {
    if (redundancy.numbers_in_host) r.plan.host_splits.push_back({redundancy.stream, numbering_config(r, redundancy)});
    if (redundancy.splits_in_host)
      r.plan.host_splits.push_back(
          {redundancy.stream,
           {redundancy.is_ladder() ? members_of(redundancy, redundancy.relay_at(redundancy.split)->out)
                                   : redundancy.members}});
    if (redundancy.merges_in_host)
      for (const models::NodeIndex listener : r.plan.streams[redundancy.stream.value].listeners)
        r.plan.host_recoveries.push_back(
            {listener, redundancy.stream,
             redundancy.is_ladder()
                 ? ladder_recovery(r, redundancy, *redundancy.relay_at(redundancy.merge), diagnostics)
                 : recovery_config(r, redundancy, diagnostics)});
  }
  for (std::uint32_t n = 0; n < r.topology.nodes.size(); ++n) {
    if (!r.topology.nodes[n].forwards()) continue;
    const bool has_functions =
        std::any_of(crossings[n].redundancies.begin(), crossings[n].redundancies.end(),
                    [&](const ResolvedRedundancy* redundancy) { return has_function_at(*redundancy, n); });
    if (!has_functions && !relay_of(r.topology.nodes[n].description)->ingress) continue;
    models::IngressConfig config = NodeIngress(r, n, crossings[n], diagnostics).build();
    r.plan.nodes[n].ingress = static_cast<std::uint32_t>(r.plan.ingress_configs.size());
    r.plan.ingress_configs.push_back(std::move(config));
  }
}

}  // namespace takt::scenario
