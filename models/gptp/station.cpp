// SPDX-License-Identifier: Apache-2.0
#include "models/gptp/station.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "models/gptp/codec.hpp"
#include "sim/insertion_sort.hpp"

namespace takt::models::gptp {
namespace {

constexpr sim::EventKind timer_due = 0;
constexpr sim::EventKind hand_over_now = 1;
constexpr sim::EventKind has_left = 2;
constexpr sim::EventKind messages_have_come = 3;
constexpr sim::EventKind ask_now = 4;
constexpr sim::Duration software_delay =
    sim::Duration::from_ps(1000);  // from the last bit of a message to what it causes

NodeConfig node_config(const StationPlan& plan, NodeIndex node, std::size_t ports) {
  NodeConfig config{Station::identity_of(node), std::vector<LinkDelayConfig>(ports, plan.link), plan.instances,
                    plan.log_gptp_capable_interval};
  for (const std::uint16_t port : plan.ports_without_threshold) config.ports.at(port).mean_link_delay_thresh.reset();
  return config;
}

MessageType type_of(const Message& message) {
  if (std::holds_alternative<Sync>(message)) return MessageType::sync;
  return std::holds_alternative<PdelayReq>(message) ? MessageType::pdelay_req : MessageType::pdelay_resp;
}

}  // namespace

Station::Station(sim::Simulation& simulation, Traffic& traffic, std::span<EgressPort> ports, NodeClock& clock,
                 const TimestampUnit& timestamps, const StationPlan& plan, NodeIndex node, StreamIndex stream,
                 std::string_view path)
    : simulation_(&simulation),
      traffic_(&traffic),
      ports_(ports),
      clock_(&clock),
      timestamps_(timestamps),
      plan_(plan),
      config_(node_config(plan, node, ports.size())),
      node_(node),
      stream_(stream),
      source_(simulation.add(*this)),
      machine_(config_),
      target_(plan.target),
      timer_(source_.id(), sim::Phase::timer, timer_due) {
  if (plan.standby) standby_.emplace(*plan.standby, plan.target);
  sent_by_port_.resize(ports.size());
  capability_.resize(ports.size());
  for (std::size_t port = 0; port < ports.size(); ++port) {
    const std::string name = std::string(path) + ":" + std::to_string(port);
    egress_chance_.emplace_back(simulation.seed(), name, "egress timestamps");
    ingress_chance_.emplace_back(simulation.seed(), name, "ingress timestamps");
    for (std::size_t kind = 0;
         !plan.processing.is_constant() && kind < std::variant_size_v<Message> * (plan.instances.size() + 1); ++kind)
      processing_chance_.emplace_back(simulation.seed(), name, "processing " + std::to_string(kind));
  }
  clock.free_running().add_listener(*this);
}

std::optional<NodeIndex> Station::node_of(const ClockIdentity& identity) {
  std::uint64_t number = 0;
  for (const std::uint8_t octet : identity.octets) number = number << 8 | octet;
  const std::uint64_t first = 0x0200'5EFF'FE00'0000;
  if (number < first || number - first > 0xFF'FFFF) return std::nullopt;
  return NodeIndex{static_cast<std::uint32_t>(number - first)};
}

void Station::start() {
  outputs_.clear();
  give_time();
  machine_.start(local(), outputs_);
  link_is_up_.resize(ports_.size());
  for (std::uint16_t port = 0; port < ports_.size(); ++port) {
    link_is_up_[port] = ports_[port].is_connected();
    if (link_is_up_[port]) machine_.link_up(static_cast<PortNumber>(port + 1), local(), outputs_);
  }
  carry_out();
  note_change();
  for (std::size_t i = 0; i < plan_.interval_requests.size(); ++i)
    simulation_->schedule(source_, plan_.interval_requests[i].at, sim::Phase::timer, source_.id(), ask_now, i);
}

void Station::ask_for_intervals(const TimedIntervalRequest& asked) {
  if (!up_) return;
  outputs_.clear();
  machine_.ask_for_intervals(asked.instance, static_cast<PortNumber>(asked.port + 1), asked.request, outputs_);
  carry_out();
}

void Station::handle(sim::Simulation& simulation, const sim::Event& event) {
  switch (event.kind()) {
    case timer_due:
      if (timer_.fired(simulation, source_, event)) expire();
      break;
    case hand_over_now:
      hand_over(event.argument);
      break;
    case messages_have_come:
      receive_all();
      break;
    case ask_now:
      ask_for_intervals(plan_.interval_requests[event.argument]);
      break;
    default:
      report_egress(event.argument);
      break;
  }
}

void Station::expire() {
  const sim::LocalTime now = local();
  is_expiring_ = true;
  due_.clear();
  for (const Armed& armed : armed_)
    if (armed.at <= now) due_.push_back(armed);
  std::sort(due_.begin(), due_.end(), [](const Armed& a, const Armed& b) { return a.timer < b.timer; });
  for (const Armed& armed : due_) {
    // An earlier one of them may have moved or cancelled it.
    const auto still = std::find_if(armed_.begin(), armed_.end(), [&](const Armed& other) {
      return other.timer == armed.timer && other.at == armed.at;
    });
    if (still == armed_.end()) continue;
    armed_.erase(still);
    outputs_.clear();
    machine_.timer_expired(armed.timer, now, outputs_);
    carry_out();
  }
  is_expiring_ = false;
  rearm();
}

void Station::rearm() {
  if (is_expiring_) return;  // once at its end
  sim::LocalTime first = sim::LocalTime::never();
  for (const Armed& armed : armed_) first = std::min(first, armed.at);
  if (first == sim::LocalTime::never() || !up_)
    timer_.cancel();
  else
    timer_.arm(*simulation_, source_, std::max(clock_->free_running().true_at(first), simulation_->now()));
}

void Station::clock_changed(const LocalClock&, sim::TrueTime) { rearm(); }

void Station::carry_out() {
  bool timers_changed = false;
  bool ports_changed = false;
  for (const Output& output : outputs_) {
    if (const auto* const message = std::get_if<SendMessage>(&output)) {
      send(*message);
    } else if (const auto* const arm = std::get_if<ArmTimer>(&output)) {
      timers_changed = true;
      const auto found = std::ranges::find(armed_, arm->timer, &Armed::timer);
      if (found != armed_.end())
        found->at = arm->at;
      else
        armed_.push_back({arm->timer, arm->at});
    } else if (const auto* const cancel = std::get_if<CancelTimer>(&output)) {
      timers_changed = true;
      std::erase_if(armed_, [&](const Armed& armed) { return armed.timer == cancel->timer; });
    } else if (std::holds_alternative<AsCapableChange>(output) || std::holds_alternative<RoleChange>(output)) {
      ports_changed = true;
    } else if (const auto* const sample = std::get_if<SyncSample>(&output)) {
      discipline(*sample);
    } else if (const auto* const lost = std::get_if<SyncLost>(&output)) {
      if (lost->instance == active()) target_.sync_lost();
      if (has_standby_role(lost->instance)) standby_->sync_lost(static_cast<HotStandbyRole>(lost->instance), local());
    } else if (const auto* const change = std::get_if<GrandmasterChange>(&output)) {
      if (change->instance == active()) target_.sync_lost();  // until the first Sync of the new one
      if (has_standby_role(change->instance))
        standby_->set_grandmaster(static_cast<HotStandbyRole>(change->instance), gives_time(change->instance), local());
      give_time();
    }
  }
  note_change();
  if (ports_changed) note_capability();
  if (timers_changed) rearm();
}

std::uint32_t Station::keep(const SendMessage& message) {
  if (free_slots_.empty()) {
    free_slots_.push_back(static_cast<std::uint32_t>(waiting_.size()));
    waiting_.emplace_back();
  }
  const std::uint32_t slot = free_slots_.back();
  free_slots_.pop_back();
  waiting_[slot] = {message, {}, 0};
  return slot;
}

sim::Duration Station::processing_of(const SendMessage& message) {
  if (processing_chance_.empty()) return plan_.processing.greatest();
  // Requests for the delay of the link are of no domain, and behind those of all.
  std::size_t domain = 0;
  while (domain < plan_.instances.size() && plan_.instances[domain].domain != header_of(message.message).domain)
    ++domain;
  const std::size_t kinds = std::variant_size_v<Message>;
  return plan_.processing.draw(
      processing_chance_[((message.port - std::size_t{1}) * (plan_.instances.size() + 1) + domain) * kinds +
                         message.message.index()]);
}

void Station::send(const SendMessage& message) {
  simulation_->schedule(source_, simulation_->now() + processing_of(message), sim::Phase::timer, source_.id(),
                        hand_over_now, of_this_life(keep(message)));
}

void Station::hand_over(std::uint64_t argument) {
  const auto slot = static_cast<std::uint32_t>(argument);
  Waiting& waiting = waiting_[slot];
  EgressPort& port = ports_[waiting.send.port - 1u];
  if (!up_ || argument >> 32 != epoch_ || !port.is_connected()) {
    free_slots_.push_back(slot);
    return;
  }
  encode(waiting.send.message, octets_);
  const FrameIndex frame = traffic_->produce(stream_, octets_, simulation_->now());
  // All nodes share the stream; each port numbers what it sends, so that the order of nodes within an instant does not
  // matter.
  traffic_->frame(frame).source = AddressIndex{node_.value};
  waiting.sequence = traffic_->frame(frame).sequence = sent_by_port_[waiting.send.port - 1u]++;
  traffic_->count_production(traffic_->frame(frame), *simulation_);
  ++messages_sent_;
  if (is_event(waiting.send.message))
    waiting.frame = frame;
  else
    free_slots_.push_back(slot);
  port.offer(*simulation_, frame, source_.id().index);
}

void Station::transmission_starts(std::uint16_t port, FrameIndex frame) {
  const std::uint64_t sequence = traffic_->frame(frame).sequence;
  auto found = waiting_.end();
  for (auto w = waiting_.begin(); w != waiting_.end(); ++w) {
    if (w->frame == FrameIndex{} || w->send.port != port + 1u) continue;
    if (w->sequence == sequence) found = w;
    // All of a port's messages are of one class and leave in order: what should have left before has been dropped.
    if (w->sequence >= sequence) continue;
    w->frame = FrameIndex{};
    free_slots_.push_back(static_cast<std::uint32_t>(w - waiting_.begin()));
  }
  if (found == waiting_.end()) return;  // no event message
  // The timestamp point is the first symbol after the SFD (11.3.9).
  const sim::TrueTime point = simulation_->now() + ports_[port].octet_time() * preamble_and_sfd.count;
  const sim::LocalTime egress = timestamps_.egress(clock_->free_running().local_at(point), egress_chance_[port]);
  if (found->send.one_step) {
    found->send.one_step->apply(found->send.message, egress);
    encode(found->send.message, octets_);
    Payload& payload = traffic_->payload(traffic_->frame(frame).payload);
    TAKT_CHECK(octets_.size() == payload.length, "a message keeps its length");
    std::copy(octets_.begin(), octets_.end(), payload.octets.begin());
  }
  found->frame = FrameIndex{};
  found->send.one_step.reset();
  const auto slot = static_cast<std::uint32_t>(found - waiting_.begin());
  egress_of_slot_.resize(waiting_.size());
  egress_of_slot_[slot] = egress;
  simulation_->schedule(source_, point, sim::Phase::timer, source_.id(), has_left, of_this_life(slot));
}

void Station::report_egress(std::uint64_t argument) {
  const auto slot = static_cast<std::uint32_t>(argument);
  const SendMessage message = waiting_[slot].send;
  free_slots_.push_back(slot);
  if (!up_ || argument >> 32 != epoch_) return;
  const Header& header = header_of(message.message);
  outputs_.clear();
  machine_.transmitted(
      {message.port, type_of(message.message), header.domain, header.sequence_id, egress_of_slot_[slot]}, local(),
      outputs_);
  carry_out();
}

void Station::receive(sim::Simulation& simulation, FrameIndex frame, std::uint16_t port, sim::TrueTime last_bit) {
  if (cpu_ == nullptr) {
    receive_after_timestamp(simulation, {frame, port, last_bit});
    return;
  }
  std::size_t slot = 0;
  while (slot < on_cpu_.size() && on_cpu_[slot]) ++slot;
  if (slot == on_cpu_.size()) on_cpu_.emplace_back();
  on_cpu_[slot] = Arrived{frame, port, last_bit};
  cpu_->submit(thread_, *this, source_.id().index, port, slot, simulation.now());
}

void Station::job_ended(sim::Simulation& simulation, std::uint64_t job, Ending ending) {
  const Arrived arrived = *std::exchange(on_cpu_[job], std::nullopt);
  if (ending == Ending::done)
    receive_after_timestamp(simulation, arrived);
  else
    traffic_->drop(arrived.frame, ending == Ending::crashed ? DropReason::node_down : DropReason::host_overload,
                   source_.id(), simulation);
}

void Station::receive_after_timestamp(sim::Simulation& simulation, const Arrived& arrived) {
  // Clocks change in the control phase of an instant only, so that all that happens in it sees one clock.
  if (arrived_.empty())
    simulation.schedule(source_, simulation.now() + software_delay, sim::Phase::control, source_.id(),
                        messages_have_come, 0);
  arrived_.push_back(arrived);
}

void Station::receive_all() {
  sim::insertion_sort(arrived_, [](const Arrived& a, const Arrived& b) {
    return a.last_bit != b.last_bit ? a.last_bit < b.last_bit : a.port < b.port;
  });
  for (const Arrived& arrived : arrived_) receive_one(arrived);
  arrived_.clear();
}

void Station::receive_one(const Arrived& arrived) {
  const Frame& record = traffic_->frame(arrived.frame);
  if (!up_) {
    traffic_->drop(arrived.frame, DropReason::node_down, source_.id(), *simulation_);
    return;
  }
  traffic_->count_delivery(record, Traffic::delivery_key(record.stream, node_), *simulation_);
  const std::span<const std::byte> octets = traffic_->payload(record.payload).view();
  note(Occurrence::clock_message, sim::Content(sim::hash_of(octets), arrived.port).value());
  const std::optional<Message> message = decode(octets);
  // The first symbol after the SFD came a frame's length before its last bit.
  const sim::TrueTime point = arrived.last_bit - ports_[arrived.port].octet_time() * std::int64_t{record.length};
  traffic_->release(arrived.frame);
  if (!message) return;
  const sim::LocalTime ingress =
      timestamps_.ingress(clock_->free_running().local_at(point), ingress_chance_[arrived.port]);
  outputs_.clear();
  machine_.received(static_cast<PortNumber>(arrived.port + 1), *message, ingress, local(), outputs_);
  carry_out();
}

void Station::discipline(const SyncSample& sample) {
  LocalClock& disciplined = clock_->disciplined();
  const sim::LocalTime shown = disciplined.local_at(clock_->free_running().true_at(sample.at));
  if (has_standby_role(sample.instance))
    standby_->sample(static_cast<HotStandbyRole>(sample.instance), sample, shown, local());
  if (sample.instance != active()) return;
  const ServoAction action = target_.sample(sample, shown);
  if (action.step != sim::Duration()) {
    ++steps_;
    note(Occurrence::clock_step, static_cast<std::uint64_t>(action.step.ps()));
  }
  note(Occurrence::clock_rate, static_cast<std::uint64_t>(action.adjustment.multiple()));
  disciplined.step_and_adjust(simulation_->now(), action.step, action.adjustment);
  give_time();
}

void Station::note(Occurrence kind, std::uint64_t what) const {
  simulation_->digest().add(static_cast<std::uint32_t>(kind), node_.value, simulation_->now(), what);
}

/// A grandmaster gives the time of its disciplined clock, and so does a boundary clock.
void Station::give_time() {
  const SourceTime source{local(), sim::PtpTime::from_ps(clock_->disciplined().local_at(simulation_->now()).ps()),
                          clock_->disciplined().rate() / clock_->free_running().rate()};
  for (std::size_t i = 0; i < machine_.instance_count(); ++i)
    if (machine_.instance(i).gives_own_time()) machine_.instance(i).set_source_time(source);
}

void Station::set_link(std::uint16_t port, bool up) {
  link_is_up_[port] = up;
  if (!up_) return;
  outputs_.clear();
  if (up)
    machine_.link_up(static_cast<PortNumber>(port + 1), local(), outputs_);
  else
    machine_.link_down(static_cast<PortNumber>(port + 1), local(), outputs_);
  carry_out();
}

void Station::set_up(bool up) {
  if (up == up_) return;
  up_ = up;
  ++epoch_;
  armed_.clear();
  rearm();
  if (!up) {
    note_change();
    note_capability();
    return;
  }
  machine_ = Node(config_);
  target_ = ClockTarget(plan_.target);
  if (plan_.standby) standby_.emplace(*plan_.standby, plan_.target);
  outputs_.clear();
  machine_.start(local(), outputs_);
  give_time();
  for (std::uint16_t port = 0; port < ports_.size(); ++port)
    if (link_is_up_[port]) machine_.link_up(static_cast<PortNumber>(port + 1), local(), outputs_);
  carry_out();
}

NodeIndex Station::grandmaster() const {
  return node_of(machine_.instance(active()).grandmaster().root.clock).value_or(node_);
}

void Station::note_capability() {
  for (std::uint16_t port = 0; port < capability_.size(); ++port)
    if (const bool is_capable = up_ && obstacle(port) == NotCapable::none; is_capable != capability_[port].is_capable)
      capability_[port] = {is_capable, simulation_->now()};
}

void Station::note_change() {
  const Change now{simulation_->now(), grandmaster(), state()};
  if (!changes_.empty() && changes_.back().grandmaster == now.grandmaster && changes_.back().state == now.state) return;
  constexpr std::size_t most = 4096;
  if (changes_.size() < most) changes_.push_back(now);
}

}  // namespace takt::models::gptp
