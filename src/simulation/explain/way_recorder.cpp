// SPDX-License-Identifier: Apache-2.0
#include "explain/way_recorder.hpp"

#include <algorithm>
#include <utility>

#include "models/egress/preemption.hpp"
#include "models/ethernet/sizes.hpp"
#include "sim/check.hpp"

namespace takt::explain {

using models::Occurrence;

WayRecorder::WayRecorder(const models::Network& network, WaySink& sink)
    : network_(&network), view_(network), sink_(&sink), directory_(network) {
  accounts_.resize(directory_.ports().size());
  waiting_.resize(directory_.ports().size());
  const auto know = [&](sim::ComponentId component, std::uint32_t node) {
    if (node_of_component_.size() <= component.index) node_of_component_.resize(component.index + std::size_t{1}, none);
    node_of_component_[component.index] = node;
  };
  for (std::uint32_t n = 0; n < network.plan().nodes.size(); ++n) {
    if (const models::Host* const host = network.host({n})) know(host->id(), n);
    if (network.plan().nodes[n].forwards()) know(network.bridge({n}).id(), n);
  }
  for (std::uint32_t s = 0; s < network.traffic().streams().size(); ++s)
    wanted_.push_back(!network.traffic().stream({s}).link_local && sink.wants({s}));
}

models::NodeIndex WayRecorder::node_of(sim::ComponentId component) const {
  return {component.index < node_of_component_.size() ? node_of_component_[component.index] : none};
}

WayRecorder::Copy* WayRecorder::copy_of(std::uint64_t record) {
  const auto number = static_cast<std::uint32_t>(record);
  return number >= copies_.size() || copies_[number].journey == none ? nullptr : &copies_[number];
}

WayRecorder::Copy& WayRecorder::make_copy(std::uint32_t record) {
  if (record >= copies_.size()) copies_.resize(record + std::size_t{1});
  return copies_[record];
}

WayRecorder::Place* WayRecorder::place_at(Copy& copy, models::NodeIndex node) {
  const auto found =
      std::find_if(copy.places.rbegin(), copy.places.rend(), [&](const Place& place) { return place.node == node; });
  return found == copy.places.rend() ? nullptr : &*found;
}

std::uint32_t WayRecorder::visit_at(const Copy& copy, std::uint32_t position) {
  const auto found =
      std::find_if(copy.ports.rbegin(), copy.ports.rend(), [&](const AtPort& at) { return at.position == position; });
  return found == copy.ports.rend() ? none : found->visit;
}

void WayRecorder::record(const sim::TraceRecord& record) {
  const auto kind = static_cast<Occurrence>(record.kind);
  switch (kind) {
    case Occurrence::produced:
      return produced(record);
    case Occurrence::arrived:
      return arrived(record);
    case Occurrence::started:
      return started(record);
    case Occurrence::resumed:
      return resumed(record);
    case Occurrence::cut:
      return cut(record);
    case Occurrence::received:
      return received(record);
    case Occurrence::drop:
      return dropped(record);
    case Occurrence::separated:
      return separated(record);
    case Occurrence::stored:
      return stored(record);
    case Occurrence::ended:
      return record_ends(static_cast<std::uint32_t>(record.what));
    case Occurrence::processing:
      if (Copy* const copy = copy_of(record.what)) {
        const models::NodeIndex node = node_of(record.where);  // a talker is none
        Place* const place = place_at(*copy, node.is_none() ? journeys_[copy->journey].talker : node);
        if (place != nullptr) place->processing = record.time;
      }
      return;
    case Occurrence::enqueued:
      if (Copy* const copy = copy_of(record.what)) {
        const std::uint32_t position = directory_.find(record.where);
        Visit& made = visit(*copy, position, record.time);
        made.hop.traffic_class = static_cast<models::TrafficClass>(record.detail);
        wait_at(position, made, record.time);
      }
      return;
    case Occurrence::refused:
      if (const std::uint32_t position = directory_.find(record.where); waiting_[position].empty())
        accounts_[position].forget(record.time);
      accounts_[directory_.find(record.where)].refused(record.time,
                                                       TrueTime::from_ps(static_cast<std::int64_t>(record.what)),
                                                       models::BlockedRecord::unpack(record.detail));
      return;
    default:
      return;
  }
}

void WayRecorder::produced(const sim::TraceRecord& record) {
  const auto handle = static_cast<std::uint32_t>(record.what);
  const models::Frame& frame = view_.frame({handle});
  if (!wanted_[frame.stream.value] || !sink_->wants_frame(frame)) return;
  if (free_journeys_.empty()) {
    free_journeys_.push_back(static_cast<std::uint32_t>(journeys_.size()));
    journeys_.emplace_back();
  }
  const std::uint32_t number = free_journeys_.back();
  free_journeys_.pop_back();
  Journey& journey = journeys_[number];
  journey.frame = {frame.stream, frame.sequence};
  journey.priority = frame.priority;
  journey.talker = network_->traffic().stream(frame.stream).talker;
  journey.produced = frame.produced;
  journey.visits.clear();
  journey.records.assign(1, handle);
  Copy& copy = make_copy(handle);
  copy.journey = number;
  copy.ports.clear();
  copy.stored.clear();
  copy.places.assign(1, {journey.talker});
}

void WayRecorder::separated(const sim::TraceRecord& record) {
  if (copy_of(record.detail) == nullptr) return;
  const auto number = static_cast<std::uint32_t>(record.what);
  Copy& made = make_copy(number);
  made = *copy_of(record.detail);
  journeys_[made.journey].records.push_back(number);
}

void WayRecorder::arrived(const sim::TraceRecord& record) {
  Copy* const copy = copy_of(record.what);
  if (copy == nullptr) return;
  const models::NodeIndex node = node_of(record.where);
  const auto detail = models::ArrivalDetail::unpack(record.detail);
  copy->places.push_back({node, visit_at(*copy, directory_.find(detail.sender)), detail.only_header});
}

void WayRecorder::stored(const sim::TraceRecord& record) {
  Copy* const copy = copy_of(record.what);
  if (copy == nullptr) return;
  const std::uint32_t position = directory_.find(record.where);
  Stored made{Stored::Because::port, models::StoringDetail::unpack(record.detail), {}};
  const models::Storing reason = made.detail.reason;
  if (reason == models::Storing::medium_busy || reason == models::Storing::goes_first)
    made.who = accounts_[position].last_started();
  copy->stored.emplace_back(position, made);
}

/// Of a frame that has come wholly, or that the port has stored.
std::optional<Stored> WayRecorder::why_stored(const Journey& journey, const Visit& visit) const {
  const models::PortConfig& config = network_->ports(visit.hop.port.node)[visit.hop.port.port].config();
  if (!models::contains(config.cut_through, visit.hop.traffic_class) || visit.from == none) return std::nullopt;
  if (visit.hop.stored || visit.has_header_come) return visit.hop.stored;
  const Visit& before = journey.visits[visit.from];
  const std::optional<models::PreemptionConfig>& preemption =
      network_->ports(before.hop.port.node)[before.hop.port.port].config().preemption;
  if (preemption && models::contains(preemption->preemptable, before.hop.traffic_class))
    return Stored{Stored::Because::preemptable, {}, {}};
  const models::NodePlan& node = network_->plan().nodes[visit.hop.port.node.value];
  if (models::preamble_and_sfd.count + before.hop.octets <=
      (node.cut_through_header + models::vlan_tag + models::r_tag).count)
    return Stored{Stored::Because::short_frame, {}, {}};
  const auto is_timed = [&](const models::EgressPort& port) {
    return port.is_connected() &&
           port.config().shaping.is_timed(port.config().traffic_class_of_priority[journey.priority]);
  };
  const bool any_is = std::ranges::any_of(network_->ports(visit.hop.port.node), is_timed);
  return Stored{any_is ? Stored::Because::timed : Stored::Because::doubled, {}, {}};
}

/// The visit of the frame to that port: the one under way, or a new one.
WayRecorder::Visit& WayRecorder::visit(Copy& copy, std::uint32_t position, TrueTime now) {
  Journey& journey = journeys_[copy.journey];
  if (const std::uint32_t known = visit_at(copy, position); known != none && journey.visits[known].is_waiting)
    return journey.visits[known];
  const models::PortDirectory::Port& port = directory_.ports()[position];
  const Place* const place = place_at(copy, port.id.node);
  TAKT_CHECK(place != nullptr, "a frame leaves a node that it has come to");
  copy.ports.push_back({position, static_cast<std::uint32_t>(journey.visits.size())});
  Visit made;
  made.position = position;
  made.from = place->from;
  made.has_header_come = place->only_header;
  made.has_launch_time = made.from == none && !is_shaped_at_talker(journey.frame.stream);
  made.octet_time = port.octet_time;
  made.hop.port = port.id;
  made.hop.peer = port.peer;
  made.hop.came = now;
  made.hop.started = TrueTime::never();
  const auto kept = std::ranges::find(copy.stored, position, &std::pair<std::uint32_t, Stored>::first);
  if (kept != copy.stored.end()) {
    made.hop.stored = kept->second;
    copy.stored.erase(kept);
  }
  journey.visits.push_back(std::move(made));
  return journey.visits.back();
}

bool WayRecorder::is_shaped_at_talker(models::StreamIndex stream) const {
  const std::vector<models::TalkerAtsPlan>& shaped = network_->plan().talker_ats;
  return std::ranges::find(shaped, stream, &models::TalkerAtsPlan::stream) != shaped.end();
}

void WayRecorder::wait_at(std::uint32_t position, Visit& visit, TrueTime since) {
  if (visit.is_waiting) return;
  visit.is_waiting = true;
  visit.waits_since = since;
  waiting_[position].insert(since);
}

void WayRecorder::waits_no_more(std::uint32_t position, Visit& visit, TrueTime now) {
  if (!visit.is_waiting) return;
  visit.is_waiting = false;
  std::multiset<TrueTime>& waiting = waiting_[position];
  waiting.erase(waiting.find(visit.waits_since));
  if (waiting.empty())
    accounts_[position].forget(now);
  else
    accounts_[position].forget_before(*waiting.begin());
}

void WayRecorder::explain_wait(Visit& visit, TrueTime from, TrueTime until, bool is_rest) {
  if (from < until)
    accounts_[visit.position].explain({from, until, visit.hop.traffic_class, is_rest, visit.has_launch_time},
                                      visit.hop.parts);
}

void WayRecorder::started(const sim::TraceRecord& record) {
  const std::uint32_t position = directory_.find(record.where);
  const auto detail = models::TransmissionDetail::unpack(record.detail);
  const Duration octet_time = directory_.ports()[position].octet_time;
  const models::Frame& frame = view_.frame({static_cast<std::uint32_t>(record.what)});
  if (Copy* const copy = copy_of(record.what)) {
    Visit& here = visit(*copy, position, record.time);
    here.hop.traffic_class = detail.traffic_class;
    explain_wait(here, here.hop.came, record.time, false);
    waits_no_more(position, here, record.time);
    here.hop.started = here.last_start = record.time;
    here.hop.octets = here.left = detail.octets;
    here.node_delay = view_.node_delay(here.hop.port.node, here.hop.port.port);
    here.cable = view_.delay(here.hop.port.node, here.hop.port.port) - here.node_delay;
  }
  if (waiting_[position].empty()) accounts_[position].forget(record.time);
  accounts_[position].started(record.time,
                              record.time + octet_time * models::wire_length(models::Octets{detail.octets}).count,
                              {frame.stream, frame.sequence}, detail.traffic_class, false);
}

void WayRecorder::cut(const sim::TraceRecord& record) {
  const std::uint32_t position = directory_.find(record.where);
  const auto data = std::int64_t{models::TransmissionDetail::unpack(record.detail).octets};
  const Duration octet_time = directory_.ports()[position].octet_time;
  if (Copy* const copy = copy_of(record.what)) {
    Visit& here = journeys_[copy->journey].visits[visit_at(*copy, position)];
    const Duration sent = octet_time * (models::preamble_and_sfd.count + data);
    const Duration lost = octet_time * std::int64_t{models::mcrc.count + models::inter_packet_gap.count};
    const Duration preamble =
        here.hop.cuts > 0 ? octet_time * std::int64_t{models::preamble_and_sfd.count} : Duration();
    if (preamble > Duration()) here.hop.parts.push_back({Cause::preemption, here.last_start, preamble});
    here.hop.parts.push_back({Cause::transmission, here.last_start + preamble, sent - preamble});
    here.hop.parts.push_back({Cause::preemption, here.last_start + sent, lost});
    here.last_free = here.last_start + sent + lost;
    ++here.hop.cuts;
    wait_at(position, here, here.last_free);
  }
  accounts_[position].cut(
      octet_time * (models::preamble_and_sfd.count + data + models::mcrc.count + models::inter_packet_gap.count));
}

void WayRecorder::resumed(const sim::TraceRecord& record) {
  const std::uint32_t position = directory_.find(record.where);
  const auto detail = models::TransmissionDetail::unpack(record.detail);
  const models::Frame& frame = view_.frame({static_cast<std::uint32_t>(record.what)});
  if (Copy* const copy = copy_of(record.what)) {
    Visit& here = journeys_[copy->journey].visits[visit_at(*copy, position)];
    explain_wait(here, here.last_free, record.time, true);
    waits_no_more(position, here, record.time);
    here.last_start = record.time;
    here.left = detail.octets;
  }
  if (waiting_[position].empty()) accounts_[position].forget(record.time);
  const Duration length =
      directory_.ports()[position].octet_time * models::wire_length(models::Octets{detail.octets}).count;
  accounts_[position].started(record.time, record.time + length, {frame.stream, frame.sequence}, detail.traffic_class,
                              true);
}

/// From the start of the last fragment to where the next node acts (`arrives`), or the frame is lost on the way. `host`
/// takes it in, if one does.
void WayRecorder::add_flight(const Visit& visit, TrueTime until, bool arrives, const Place* host,
                             std::vector<Part>& parts) const {
  TrueTime at = visit.last_start;
  const auto add = [&](Cause cause, Duration length) {
    length = std::min(length, until - at);
    if (length <= Duration()) return;
    parts.push_back({cause, at, length});
    at += length;
  };
  const Duration preamble = visit.octet_time * std::int64_t{models::preamble_and_sfd.count};
  const Duration fixed = visit.cable + visit.node_delay;
  Duration whole = preamble + visit.octet_time * std::int64_t{visit.left};
  // What is cut through goes on before it has come wholly.
  if (arrives) whole = std::min(whole, until - at - fixed);
  TAKT_CHECK(whole >= Duration(), "a frame that arrives takes the delay of its cable at least");
  if (visit.hop.cuts > 0) {
    add(Cause::preemption, std::min(preamble, whole));
    whole -= std::min(preamble, whole);
  }
  add(Cause::transmission, whole);
  add(Cause::cable, visit.cable);
  add(network_->plan().nodes[visit.hop.peer.value].forwards() ? Cause::forwarding : Cause::os_receive,
      visit.node_delay);
  if (host == nullptr) {
    add(Cause::jitter, until - at);
    return;
  }
  if (host->processing != TrueTime::never()) {
    add(Cause::os_receive, host->processing - at);
    add(Cause::processor, until - at);
  }
  add(Cause::os_receive, until - at);
}

namespace {

/// What would be behind that instant has not come about.
void end_at(std::vector<Part>& parts, TrueTime until) {
  while (!parts.empty() && parts.back().begin >= until) parts.pop_back();
  if (!parts.empty()) parts.back().length = std::min(parts.back().length, until - parts.back().begin);
}

}  // namespace

Way WayRecorder::way_of(const Copy& copy, std::uint32_t last, const Place* place, TrueTime ended) {
  Journey& journey = journeys_[copy.journey];
  Way way;
  way.frame = journey.frame;
  way.priority = journey.priority;
  way.talker = journey.talker;
  way.produced = journey.produced;
  way.ended = ended;
  std::vector<std::uint32_t> order;
  for (std::uint32_t at = last; at != none; at = journey.visits[at].from) {
    order.push_back(at);
    TAKT_CHECK(order.size() <= journey.visits.size(), "a way has an end");
  }
  std::reverse(order.begin(), order.end());
  add_talker(copy, order.empty() ? ended : journey.visits[order[0]].hop.came, way);
  for (std::size_t i = 0; i < order.size(); ++i) {
    Visit& visit = journey.visits[order[i]];
    Hop hop = visit.hop;
    hop.stored = why_stored(journey, visit);
    hop.is_reported = std::exchange(visit.is_reported, true);
    const bool is_last = i + 1 == order.size();
    const TrueTime until = is_last ? ended : journey.visits[order[i + 1]].hop.came;
    const bool has_started = hop.started != TrueTime::never();
    if (visit.is_waiting) {
      const TrueTime since = has_started ? visit.last_free : hop.came;
      if (since < until)
        accounts_[visit.position].explain({since, until, hop.traffic_class, has_started, visit.has_launch_time},
                                          hop.parts);
    } else if (has_started) {
      const bool arrives = !is_last || place != nullptr;
      const bool at_host = is_last && place != nullptr && network_->plan().nodes[place->node.value].is_end_station() &&
                           (ended_in_host_ || !network_->plan().nodes[place->node.value].forwards());
      add_flight(visit, until, arrives, at_host ? place : nullptr, hop.parts);
    }
    end_at(hop.parts, until);
    way.hops.push_back(std::move(hop));
  }
  static_cast<void>(parts_of(way));
  return way;
}

void WayRecorder::add_talker(const Copy& copy, TrueTime until, Way& way) const {
  const TrueTime processing = copy.places.front().processing;
  const TrueTime through = std::min(processing, until);
  if (through > way.produced) way.before.push_back({Cause::os_transmit, way.produced, through - way.produced});
  if (until > through) way.before.push_back({Cause::processor, through, until - through});
}

void WayRecorder::received(const sim::TraceRecord& record) {
  Copy* const copy = copy_of(record.what);
  if (copy == nullptr) return;
  const models::NodeIndex node = node_of(record.where);
  const models::Frame& frame = view_.frame({static_cast<std::uint32_t>(record.what)});
  const Place* const place = place_at(*copy, node);
  TAKT_CHECK(place != nullptr && place->from != none, "a frame that is delivered has come there");
  journeys_[copy->journey].visits[place->from].is_over = true;
  if (sink_->wants_delivery(frame, node, record.time)) {
    ended_in_host_ = true;
    Way way = way_of(*copy, place->from, place, record.time);
    way.end = Way::End::delivered;
    way.node = node;
    sink_->ended(way);
  }
  copy_ends(static_cast<std::uint32_t>(record.what), frame);
}

void WayRecorder::dropped(const sim::TraceRecord& record) {
  Copy* const copy = copy_of(record.what);
  if (copy == nullptr) return;
  Journey& journey = journeys_[copy->journey];
  const models::Frame& frame = view_.frame({static_cast<std::uint32_t>(record.what)});
  const auto reason = static_cast<models::DropReason>(record.detail);
  const std::uint32_t position = directory_.find(record.where);
  models::NodeIndex node = node_of(record.where);
  std::optional<std::uint16_t> port;
  std::uint32_t last = none;
  bool on_wire = false;
  if (position != models::PortDirectory::none) {
    const models::PortId id = directory_.ports()[position].id;
    node = id.node;
    port = id.port;
    last = visit_at(*copy, position);
    if (last != none) on_wire = !journey.visits[last].is_waiting;
  }
  if (node.is_none()) node = journey.talker;
  // Neither at the port nor behind it: it was not let in.
  const Place* const place = last == none ? place_at(*copy, node) : nullptr;
  if (place != nullptr) last = place->from;
  if (sink_->wants_loss(frame, reason)) {
    ended_in_host_ = position == models::PortDirectory::none && network_->host(node) != nullptr &&
                     network_->host(node)->id() == record.where;
    Way way = way_of(*copy, last, place, record.time);
    way.end = Way::End::dropped;
    way.node = node;
    way.port = port;
    way.on_wire = on_wire;
    way.reason = reason;
    sink_->ended(way);
  }
  if (last != none) {
    journey.visits[last].is_over = true;
    if (place == nullptr) waits_no_more(journey.visits[last].position, journey.visits[last], record.time);
  }
  copy_ends(static_cast<std::uint32_t>(record.what), frame);
}

/// The last copy that shares a record ends it.
void WayRecorder::copy_ends(std::uint32_t record, const models::Frame& frame) {
  if (!view_.is_told_of_ends() && frame.references == 1) record_ends(record);
}

void WayRecorder::record_ends(std::uint32_t record) {
  if (copy_of(record) == nullptr) return;
  const std::uint32_t number = std::exchange(copies_[record].journey, none);
  if (std::erase(journeys_[number].records, record) == 1 && journeys_[number].records.empty())
    free_journeys_.push_back(number);
}

void WayRecorder::finish(TrueTime now) {
  std::vector<std::uint32_t> left;
  for (std::uint32_t j = 0; j < journeys_.size(); ++j)
    if (!journeys_[j].records.empty()) left.push_back(j);
  std::ranges::sort(left, {}, [&](std::uint32_t j) { return std::pair(journeys_[j].produced, journeys_[j].frame); });
  for (const std::uint32_t number : left) {
    Journey& journey = journeys_[number];
    std::vector<bool> goes_on(journey.visits.size());
    for (const Visit& visit : journey.visits)
      if (visit.from != none) goes_on[visit.from] = true;
    const Copy& copy = copies_[journey.records.front()];
    ended_in_host_ = false;
    const auto tell = [&](std::uint32_t last) {
      Way way = way_of(copy, last, nullptr, now);
      way.end = Way::End::under_way;
      way.node = last == none ? journey.talker : journey.visits[last].hop.port.node;
      if (last != none) way.port = journey.visits[last].hop.port.port;
      sink_->ended(way);
    };
    if (journey.visits.empty()) tell(none);
    for (std::uint32_t v = 0; v < journey.visits.size(); ++v)
      if (!goes_on[v] && !journey.visits[v].is_over) tell(v);
  }
}

}  // namespace takt::explain
