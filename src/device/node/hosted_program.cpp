// SPDX-License-Identifier: Apache-2.0
#include "node/hosted_program.hpp"

#include <time.h>

#include <algorithm>
#include <utility>

namespace takt::node {
namespace {

/// Cycles begin at multiples of the cycle on the clock, wherever local time begins.
wire::NodeSettings settings_on(const HostedProgram::Node& node, wire::NodeSettings settings) {
  settings.set_incarnation(node.incarnation);
  wire::EndpointSettings& endpoint = settings.endpoint;
  endpoint.offset = endpoint.offset - node.clock.phase_in(endpoint.cycle);
  if (endpoint.offset < Duration()) endpoint.offset = endpoint.offset + endpoint.cycle;
  return settings;
}

}  // namespace

std::int64_t thread_cpu_ns() {
  timespec time = {};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

HostedProgram::HostedProgram(const LoadedProgram& loaded, const Node& node, std::size_t number, TransitionLog log,
                             Application* application)
    : loaded_(loaded),
      node_(node),
      log_(std::move(log)),
      application_(application),
      part_(settings_on(node, loaded)),
      alarms_(part_.alarm_count(), sim::LocalTime::never()),
      peers_(part_.peer_count()),
      reporter_(node.hand_over, number, part_.peer_count()) {}

std::unique_ptr<wire::Nesting> HostedProgram::nest(HostedProgram& outer, HostedProgram& inner) {
  outer.other_ = &inner;
  inner.other_ = &outer;
  inner.side_ = handshake::Side::inner;
  return std::make_unique<wire::Nesting>(outer.part_, inner.part_);
}

void HostedProgram::start() {
  cpu_at_last_cycle_ns_ = thread_cpu_ns();
  carry_out(part_.start(now()));
  reporter_.methods(part_);
}

program::StatusCode HostedProgram::call(program::Method method) {
  wire::NodeOutputs& outputs = part_.call(now(), method);
  const program::StatusCode status = outputs.status;
  reporter_.calling(method);
  carry_out(outputs);
  reporter_.calling({});
  log_.called(now_ns(), method, status);
  return status;
}

program::StatusCode HostedProgram::change(Membership what) {
  if (!is_candidate()) return program::StatusCode::BadInvalidState;
  log_.membership(now_ns(), what);
  carry_out(what == Membership::join ? part_.join(now()) : part_.leave(now()));
  return program::StatusCode::Good;
}

void HostedProgram::carry_out(wire::NodeOutputs& outputs) {
  bool& is_busy = side_ == handshake::Side::inner ? other_->carries_out_ : carries_out_;
  if (is_busy) return;  // who is at it takes these, too
  is_busy = true;
  while (const auto* const output = outputs.next())
    std::visit([&](const auto& what) { (output->side == side_ ? this : other_)->act(what); }, output->what);
  is_busy = false;
}

sim::LocalTime HostedProgram::due(std::size_t alarm) const {
  const bool leads = alarm == wire::ProgramEndpoint::cycle_alarm && alarms_[alarm] != sim::LocalTime::never();
  return leads ? alarms_[alarm] - node_.lead : alarms_[alarm];
}

sim::LocalTime HostedProgram::next_time() const {
  sim::LocalTime next = sim::LocalTime::never();
  for (std::size_t alarm = 0; alarm < alarms_.size(); ++alarm) next = std::min(next, due(alarm));
  return next;
}

void HostedProgram::wake_cycle(sim::LocalTime now) {
  constexpr std::size_t alarm = wire::ProgramEndpoint::cycle_alarm;
  if (due(alarm) > now) return;
  if (part_.endpoint() == nullptr) {  // of a role that it had
    alarms_[alarm] = sim::LocalTime::never();
    return;
  }
  cycles_.late.add((now - due(alarm)).ps() / 1000);
  const std::uint64_t missed_before = part_.endpoint()->missed_cycles();
  if (node_.lead > Duration()) node_.socket.set_launch_time(node_.clock.nanoseconds_at(alarms_[alarm]));
  alarms_[alarm] = sim::LocalTime::never();
  carry_out(part_.wake(this->now(), alarm));
  node_.socket.set_launch_time(0);
  const std::int64_t cpu = thread_cpu_ns();
  const std::int64_t used_ns = cpu - std::exchange(cpu_at_last_cycle_ns_, cpu);
  cycles_.cpu.add(used_ns);
  const std::uint64_t missed = part_.endpoint()->missed_cycles() - missed_before;
  const std::uint64_t by_code =
      std::min(missed, static_cast<std::uint64_t>(used_ns / (loaded_.program.cycle.ps() / 1000)));
  cycles_.missed_by_code += by_code;
  cycles_.missed_by_system += missed - by_code;
}

void HostedProgram::wake_others(sim::LocalTime now) {
  for (std::size_t alarm = wire::ProgramEndpoint::cycle_alarm + 1; alarm < alarms_.size(); ++alarm) {
    if (alarms_[alarm] > now) continue;
    alarms_[alarm] = sim::LocalTime::never();
    carry_out(part_.wake(this->now(), alarm));
  }
}

void HostedProgram::act(const wire::Heard& heard) {
  peers_.heard(heard.peer, heard.word, now());
  reporter_.heard(heard.peer, heard.word, part_);
}

void HostedProgram::act(const wire::Publish& message) {
  const bool is_data = !message.is_state() && !message.is_of_roles();
  if (is_data && application_ != nullptr) application_->produce(message.data_set(), now_ns(), message.fields());
  const uadp::Octets octets =
      node_.security != nullptr ? node_.security->seal(message.octets) : uadp::Octets(message.octets);
  if (!octets.empty()) node_.socket.publish(octets, message.destination);
  if (message.is_state()) peers_.published(message.word, now());
}

void HostedProgram::act(const wire::ProcessDataMessage& message) {
  if (application_ != nullptr) application_->consume(message.data_set, now_ns(), message.fields);
}

/// Whoever has the role now has not been heard.
void HostedProgram::act(const wire::RoleBound& bound) {
  peers_.forget(bound.role);
  const Program& program = loaded_.program;
  log_.bound(now_ns(), program.roles[bound.role].name,
             bound.binding.bound() ? std::string_view(program.candidates[bound.binding.candidate]) : std::string_view(),
             bound.binding.life);
}

void HostedProgram::act(const wire::RoleTaken& taken) {
  log_.took_role(now_ns(), loaded_.program.roles[taken.role].name, taken.self.life);
  reporter_.methods(part_);
}

void HostedProgram::act(const wire::RoleDropped&) {
  peers_.forget(0);
  log_.dropped_role(now_ns());
  reporter_.methods(part_);
}

void HostedProgram::act(const wire::Stepped& step) {
  log_.stepped(now_ns(), step.outputs, step.after);
  reporter_.stepped(step.outputs, part_);
  if (application_ == nullptr) return;
  for (const handshake::StateChange& change : step.outputs.changes()) application_->changed(change);
}

}  // namespace takt::node
