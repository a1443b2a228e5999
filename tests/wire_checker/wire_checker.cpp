// SPDX-License-Identifier: Apache-2.0
#include "tests/wire_checker/wire_checker.hpp"

#include "tests/wire_checker/wire_checker_parts.hpp"

namespace takt::wire_checker {

using models::DropReason;
using models::Occurrence;

WireChecker::WireChecker(const models::NetworkPlan& plan, std::vector<Change> changes, const Directory& directory,
                         FrameLookup frame_of)
    : plan_(plan),
      changes_(std::move(changes)),
      frame_of_(std::move(frame_of)),
      direction_of_port_(plan.nodes.size()),
      reasons_down_(plan.links.size(), 0),
      accounts_(plan.streams.size()) {
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    const models::NodePlan& node = plan.nodes[n];
    auto made = std::make_unique<Node>();
    made->name = node.name;
    made->is_end_station = node.is_end_station();
    made->forwards = node.forwards();
    const sim::Distribution& receive = plan.os_latencies[node.os_latency].receive;
    made->fixed_delay = made->forwards                                              ? node.forwarding_delay.ps()
                        : receive.is_constant() && !(node.cpu && node.cpu->receive) ? receive.greatest().ps()
                                                                                    : 0;
    if (node.forwarding_jitter) {
      made->least_jitter = node.forwarding_jitter->least().ps();
      made->greatest_jitter = node.forwarding_jitter->greatest().ps();
    }
    if (node.ingress)
      made->ingress = std::make_unique<IngressOracle>(plan.ingress_configs[*node.ingress],
                                                      static_cast<std::uint32_t>(plan.nodes.size()));
    nodes_.push_back(std::move(made));
  }
  for (const models::HostRecoveryPlan& recovery : plan.host_recoveries)
    nodes_[recovery.host.value]->recoveries[recovery.stream.value] = &recovery.recovery;
  for (const models::LinkPlan& link : plan.links) {
    connect(link, link.a, link.b);
    connect(link, link.b, link.a);
  }
  for (const models::ImpairmentPlan& impairment : plan.impairments) {
    if (!impairment.impairment.duplication) continue;
    directions_[impairment.link * 2 + (impairment.from_a_to_b ? 0u : 1u)]->duplicates = true;
    duplicates_ = true;
  }
  announce_cut_through();
  // Which of two copies a bridge has cut through can't be told from outside, and then not what its buckets hold.
  for (const std::unique_ptr<Direction>& direction : directions_)
    if (direction->duplicates && (direction->noticed != 0 || nodes_[direction->to]->greatest_jitter > 0))
      nodes_[direction->to]->ingress.reset();
  const auto place_of = [&](sim::ComponentId component) -> Place& {
    if (places_.size() <= component.index) places_.resize(component.index + std::size_t{1});
    return places_[component.index];
  };
  for (std::uint32_t n = 0; n < directory.nodes.size(); ++n)
    for (const sim::ComponentId part : directory.nodes[n]) place_of(part).node = n;
  for (std::uint32_t n = 0; n < directory.ports.size(); ++n)
    for (std::size_t p = 0; p < directory.ports[n].size(); ++p)
      if (p < direction_of_port_[n].size() && direction_of_port_[n][p] != no_direction)
        place_of(directory.ports[n][p]).direction = direction_of_port_[n][p];
  for (const Change& change : changes_) routes_change_ |= std::holds_alternative<Change::Routes>(change.what);
}

WireChecker::~WireChecker() = default;

void WireChecker::connect(const models::LinkPlan& link, const models::LinkPlan::End& from,
                          const models::LinkPlan::End& to) {
  const models::PortConfig& config =
      plan_.port_configs[from.port_config.value_or(plan_.nodes[from.node.value].port_config)];
  const std::string name =
      plan_.nodes[from.node.value].name + ":" + std::to_string(from.port) + " to " + plan_.nodes[to.node.value].name;
  const Ps delay = link.delay.ps() + nodes_[to.node.value]->fixed_delay;
  const auto link_index = static_cast<std::uint32_t>(&link - plan_.links.data());
  std::vector<std::uint32_t>& ports = direction_of_port_[from.node.value];
  if (ports.size() <= from.port) ports.resize(from.port + std::size_t{1}, no_direction);
  ports[from.port] = static_cast<std::uint32_t>(directions_.size());
  directions_.push_back(
      std::make_unique<Direction>(Direction{PortChecker(name, config, link.rate, violations_), link_index,
                                            from.node.value, to.node.value, to.port, delay, 0, 0, false}));
}

/// Which priorities' headers a bridge looks at: those that another port of it cuts through, and no port of it sends by
/// eligibility times.
void WireChecker::announce_cut_through() {
  for (const std::unique_ptr<Direction>& incoming : directions_) {
    if (!nodes_[incoming->to]->forwards) continue;
    unsigned cut = 0, timed = 0;
    for (std::size_t port = 0; port < direction_of_port_[incoming->to].size(); ++port) {
      if (direction_of_port_[incoming->to][port] == no_direction) continue;
      const models::PortConfig& config = directions_[direction_of_port_[incoming->to][port]]->checker.config();
      for (unsigned p = 0; p < 8; ++p) {
        const models::TrafficClass q = config.traffic_class_of_priority[p];
        if (port != incoming->to_port && models::contains(config.cut_through, q)) cut |= 1u << p;
        if (config.shaping.is_timed(q)) timed |= 1u << p;
      }
    }
    incoming->noticed = static_cast<std::uint8_t>(cut & ~timed);
    incoming->header = plan_.nodes[incoming->to].cut_through_header.count;
  }
}

void WireChecker::record(const sim::TraceRecord& record) {
  if (record.time.ps() > batch_time_) work_up_to(record.time.ps(), false);
  if (record.time.ps() < batch_time_) violations_.add(record.time.ps(), "trace", "time runs backwards");
  // What the model says of its reasons is no evidence.
  const auto kind = static_cast<Occurrence>(record.kind);
  if (kind == Occurrence::refused || kind == Occurrence::stored || kind == Occurrence::processing ||
      kind == Occurrence::arrived || kind == Occurrence::separated)
    return;
  Recorded recorded{record, {}, long_ago, false};
  if (kind != Occurrence::gates_changed) {
    const models::FrameIndex handle{static_cast<std::uint32_t>(record.what)};
    recorded.frame = frame_of_(handle);
    handles_.insert(handle.value);
  }
  batch_.push_back(recorded);
}

/// Works off every instant before `time` (and, with its records, `time` itself).
void WireChecker::work_up_to(Ps time, bool with_records) {
  for (;;) {
    Ps next = batch_.empty() ? never : batch_time_;
    if (!wakes_.empty()) next = std::min(next, wakes_.begin()->first);
    if (next_change_ < changes_.size()) next = std::min(next, changes_[next_change_].at);
    if (next > time || (next == time && !with_records)) break;
    instant(next);
  }
  if (!with_records) batch_time_ = time;
}

void WireChecker::instant(Ps now) {
  std::vector<Recorded> batch;
  if (!batch_.empty() && batch_time_ == now) batch.swap(batch_);
  std::set<std::uint32_t> touched;
  for (const Recorded& recorded : batch)
    if (const std::uint32_t where = recorded.record.where.index;
        where < places_.size() && places_[where].direction != 0xFFFF'FFFF)
      touched.insert(places_[where].direction);
  const std::set<std::uint32_t> cutting = ports_with_headers(now);
  touched.insert(cutting.begin(), cutting.end());
  const std::size_t first_change = next_change_;
  while (next_change_ < changes_.size() && changes_[next_change_].at <= now) ++next_change_;
  for (std::size_t c = first_change; c < next_change_; ++c) {
    if (const auto* const gates = std::get_if<Change::Gates>(&changes_[c].what))
      touched.insert(direction_of_port_[gates->node.value][gates->port]);
    if (const auto* const stuck = std::get_if<Change::StuckGate>(&changes_[c].what))
      touched.insert(direction_of_port_[stuck->node.value][stuck->port]);
    if (const auto* const link = std::get_if<Change::LinkState>(&changes_[c].what))
      touched.insert({link->link * 2, link->link * 2 + 1});
  }
  for (const std::uint32_t direction : touched) directions_[direction]->checker.begin(now);
  for (std::size_t c = first_change; c < next_change_; ++c) apply(changes_[c]);
  for (const std::uint32_t direction : touched) directions_[direction]->checker.advance_gates();

  attribute(now, batch);
  for (const Recorded& recorded : batch) feed(recorded);
  for (const std::uint32_t direction : touched) directions_[direction]->checker.end();
  note_what_could_be_cut_through(cutting, now);
}

/// The ports of nodes that have a header at this instant, if they cut anything through.
std::set<std::uint32_t> WireChecker::ports_with_headers(Ps now) const {
  std::set<std::uint32_t> ports;
  for (auto wake = wakes_.lower_bound({now, 0}); wake != wakes_.end() && wake->first == now; ++wake) {
    const Node& node = *nodes_[wake->second];
    const auto is_header = [&](const Arrival& arrival) { return arrival.looked_at == now && arrival.complete > now; };
    if (!node.forwards || std::ranges::none_of(node.arrivals, is_header)) continue;
    for (const std::uint32_t direction : direction_of_port_[wake->second])
      if (direction != no_direction && directions_[direction]->checker.config().cut_through != 0)
        ports.insert(direction);
  }
  return ports;
}

/// Frames of one instant that nothing kept from being cut through, and which were not: at these ports they must not
/// turn up later.
void WireChecker::note_what_could_be_cut_through(const std::set<std::uint32_t>& ports, Ps now) {
  for (const std::uint32_t port : ports) {
    const Direction& direction = *directions_[port];
    const std::optional<std::uint32_t>& ingress = plan_.nodes[direction.from].ingress;
    // Members of redundant streams may leave with other tags than they came with.
    if (ingress &&
        !(plan_.ingress_configs[*ingress].splits.empty() && plan_.ingress_configs[*ingress].recoveries.empty()))
      continue;
    for (Arrival& arrival : nodes_[direction.from]->arrivals) {
      const Direction& incoming = *directions_[arrival.direction];
      if (arrival.looked_at != now || arrival.complete <= now || arrival.lost || arrival.was_dropped) continue;
      if (incoming.link == direction.link || incoming.duplicates ||
          incoming.checker.octet_time() != direction.checker.octet_time())
        continue;
      models::Priority priority = arrival.frame.priority;
      if (!arrival.verdicts.empty()) priority = arrival.verdicts.front().ipv.value_or(priority);
      if (direction.checker.could_cut_through(arrival.frame, priority)) arrival.missed.push_back(port);
    }
  }
}

/// The record is of a start before the frame has come wholly.
bool WireChecker::is_cut_through(const Direction& direction, const Recorded& recorded) const {
  if (recorded.is_of_queue || !nodes_[direction.from]->forwards || is_own(direction.from, recorded.frame.stream, 0))
    return false;
  const Ps now = recorded.record.time.ps();
  bool has_header = false, is_whole = false;
  for (const Arrival& arrival : nodes_[direction.from]->arrivals) {
    if (arrival.frame.stream != recorded.frame.stream || arrival.frame.sequence != recorded.frame.sequence) continue;
    has_header = has_header || (arrival.looked_at == now && arrival.complete > now);
    is_whole = is_whole || arrival.complete == now;
  }
  return has_header && !is_whole;
}

void WireChecker::apply(const Change& change) {
  if (const auto* const gates = std::get_if<Change::Gates>(&change.what))
    directions_[direction_of_port_[gates->node.value][gates->port]]->checker.request_gates(
        list_config_of(gates->gates));
  if (const auto* const stuck = std::get_if<Change::StuckGate>(&change.what))
    directions_[direction_of_port_[stuck->node.value][stuck->port]]->checker.force_gate(stuck->traffic_class,
                                                                                        stuck->open);
  if (const auto* const link = std::get_if<Change::LinkState>(&change.what)) {
    std::uint32_t& reasons = reasons_down_[link->link];
    reasons += link->up ? -1u : 1u;
    for (const std::uint32_t direction : {link->link * 2, link->link * 2 + 1})
      directions_[direction]->checker.set_up(reasons == 0);
  }
}

/// Hands a record to the port or the account that it belongs to.
void WireChecker::feed(const Recorded& recorded) {
  const sim::TraceRecord& record = recorded.record;
  const Ps now = record.time.ps();
  const auto occurrence = static_cast<Occurrence>(record.kind);
  if (occurrence == Occurrence::produced || occurrence == Occurrence::received) return;
  if (occurrence == Occurrence::drop) ++accounts_[recorded.frame.stream.value].dropped[record.detail];
  const std::uint32_t index = record.where.index < places_.size() ? places_[record.where.index].direction : 0xFFFF'FFFF;
  if (index == 0xFFFF'FFFF || occurrence == Occurrence::gates_changed) return;
  Direction& direction = *directions_[index];
  const bool is_cut = occurrence == Occurrence::started && is_cut_through(direction, recorded);
  const SeenFrame seen{models::FrameIndex{static_cast<std::uint32_t>(record.what)}, recorded.frame, recorded.eligible,
                       is_cut};
  const auto detail = models::TransmissionDetail::unpack(record.detail);
  switch (occurrence) {
    case Occurrence::started:
      ++transmissions_;
      direction.checker.started(seen, detail);
      send(index, recorded, recorded.frame.length);
      break;
    case Occurrence::enqueued:
      direction.checker.enqueued(seen, static_cast<models::TrafficClass>(record.detail));
      break;
    case Occurrence::dequeued:
      direction.checker.dequeued(seen, static_cast<models::TrafficClass>(record.detail));
      break;
    case Occurrence::cut:
      direction.checker.cut(seen, detail);
      remove(index, seen.handle, now);
      break;
    case Occurrence::resumed:
      direction.checker.resumed(seen, detail);
      send(index, recorded, detail.octets);
      break;
    case Occurrence::drop:
      if (recorded.is_of_queue)
        direction.checker.dropped(seen.handle, static_cast<DropReason>(record.detail));
      else
        direction.checker.refused(seen, static_cast<DropReason>(record.detail));
      break;
    default:
      break;
  }
}

/// The last fragment of a frame has started: unless it is cut it will arrive.
void WireChecker::send(std::uint32_t index, const Recorded& recorded, std::uint32_t octets) {
  Direction& direction = *directions_[index];
  const Ps now = recorded.record.time.ps();
  const Ps octet = direction.checker.octet_time();
  const models::Frame& frame = recorded.frame;
  Arrival arrival;
  arrival.handle = models::FrameIndex{static_cast<std::uint32_t>(recorded.record.what)};
  arrival.frame = frame;
  arrival.port = direction.to_port;
  arrival.direction = index;
  arrival.complete = now + octet * (models::preamble_and_sfd.count + Ps{octets}) + direction.delay;
  arrival.looked_at = arrival.complete;
  arrival.least_jitter = nodes_[direction.to]->least_jitter;
  arrival.greatest_jitter = nodes_[direction.to]->greatest_jitter;
  const auto q = models::TransmissionDetail::unpack(recorded.record.detail).traffic_class;
  if ((direction.noticed >> frame.priority & 1) != 0 && !direction.checker.is_preemptable(q))
    arrival.looked_at =
        std::min(arrival.complete, now +
                                       octet * (direction.header + (frame.tagged ? models::vlan_tag.count : 0) +
                                                (frame.r_tagged ? models::r_tag.count : 0)) +
                                       direction.delay);
  nodes_[direction.to]->arrivals.push_back(arrival);
  wakes_.insert({arrival.looked_at, direction.to});
  wakes_.insert({arrival.complete, direction.to});
  wakes_.insert({arrival.latest(), direction.to});
}

void WireChecker::remove(std::uint32_t index, models::FrameIndex handle, Ps now) {
  std::erase_if(nodes_[directions_[index]->to]->arrivals, [&](const Arrival& arrival) {
    return arrival.handle == handle && arrival.direction == index && arrival.complete > now;
  });
}

void WireChecker::finish(Ps end) {
  work_up_to(end, true);
  for (const std::unique_ptr<Direction>& direction : directions_) {
    direction->checker.finish(end);
    direction->checker.for_each_waiting([&](models::StreamIndex stream) { ++accounts_[stream.value].in_flight; });
  }
  for (const std::unique_ptr<Node>& node : nodes_)
    for (const Arrival& arrival : node->arrivals)
      if (!arrival.has_outcome) ++accounts_[arrival.frame.stream.value].in_flight;
}

void WireChecker::compare(std::span<const models::Stream> streams, bool hosts_hold) {
  bool has_latencies = hosts_hold;
  bool cuts_through = false;
  for (const models::NodePlan& node : plan_.nodes)
    has_latencies |= node.cpu != nullptr || (node.kind == models::NodeKind::station &&
                                             plan_.os_latencies[node.os_latency].receive.greatest() != sim::Duration());
  const bool has_jitter = std::ranges::any_of(plan_.nodes, [](const models::NodePlan& node) {
    return node.forwarding_jitter != nullptr;
  });  // which of several copies is in a switch can't be told
  for (const models::OsLatency& latency : plan_.os_latencies)
    has_latencies |= !latency.receive.is_constant() || !latency.transmit.is_constant() ||
                     latency.transmit.greatest() != sim::Duration();
  for (const models::PortConfig& config : plan_.port_configs) cuts_through |= config.cut_through != 0;
  for (std::size_t s = 0; s < streams.size(); ++s) {
    const StreamAccount& mine = accounts_[s];
    const models::Stream& theirs = streams[s];
    const auto differ = [&](const std::string& what, std::uint64_t seen, std::uint64_t counted) {
      violations_.add(batch_time_, "stream " + theirs.name,
                      what + ": " + std::to_string(seen) + " on the wire, " + std::to_string(counted) + " counted");
    };
    if (mine.produced != theirs.sent) differ("frames sent", mine.produced, theirs.sent);
    for (std::size_t reason = 0; reason < mine.dropped.size(); ++reason)
      if (mine.dropped[reason] != theirs.dropped[reason])
        differ(std::string("frames dropped for ") + name_of(static_cast<DropReason>(reason)), mine.dropped[reason],
               theirs.dropped[reason]);
    if (theirs.delivered + theirs.dropped_in_all() > theirs.sent + theirs.copies)
      differ("more frames ended than there were", theirs.delivered + theirs.dropped_in_all(),
             theirs.sent + theirs.copies);
    if (has_latencies || duplicates_) continue;
    if (mine.delivered != theirs.delivered) differ("frames delivered", mine.delivered, theirs.delivered);
    if (!cuts_through && !has_jitter && mine.in_flight != theirs.in_flight())
      differ("frames in flight", mine.in_flight, theirs.in_flight());
  }
}

}  // namespace takt::wire_checker
