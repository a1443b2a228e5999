#include "node/hosted_program.hpp"

#include <time.h>

#include <algorithm>
#include <utility>

namespace takt::node {
namespace {

/// Cycles begin at multiples of the cycle on the clock, wherever local time begins.
wire::EndpointSettings settings_on(const HostedProgram::Node& node, wire::EndpointSettings settings) {
  settings.handshake.incarnation = node.incarnation;
  settings.offset = settings.offset - node.clock.phase_in(settings.cycle);
  if (settings.offset < Duration()) settings.offset = settings.offset + settings.cycle;
  return settings;
}

}  // namespace

std::int64_t thread_cpu_ns() {
  timespec time = {};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

HostedProgram::HostedProgram(const LoadedProgram& loaded, const Node& node, TransitionLog log, Application* application)
    : program_(loaded.program),
      node_(node),
      log_(std::move(log)),
      application_(application),
      format_(loaded.endpoint.format),
      plug_format_(loaded.roles ? loaded.roles->format : nullptr),
      member_(node.config, loaded, settings_on(node, loaded.endpoint)),
      alarms_(member_.alarm_count(), sim::LocalTime::never()),
      peers_(member_.peer_count()) {}

std::unique_ptr<wire::Nesting> HostedProgram::nest(HostedProgram& outer, HostedProgram& inner) {
  wire::EndpointHost& outer_host = outer;
  wire::EndpointHost& inner_host = inner;
  return std::make_unique<wire::Nesting>(outer.member_.plain(), outer_host, inner.member_.plain(), inner_host);
}

void HostedProgram::start() {
  cpu_at_last_cycle_ns_ = thread_cpu_ns();
  member_.start(*this);
}

program::StatusCode HostedProgram::call(program::Method method) {
  const program::StatusCode status = member_.call(*this, method);
  log_.called(now_ns(), method, status);
  return status;
}

program::StatusCode HostedProgram::plug(Plug what) {
  wire::CandidateEndpoint* const candidate = member_.candidate();
  if (candidate == nullptr) return program::StatusCode::BadInvalidState;
  log_.plugged(now_ns(), what);
  what == Plug::join ? candidate->join(*this) : candidate->leave(*this);
  return program::StatusCode::Good;
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
  if (member_.endpoint() == nullptr) {  // of a role that it had
    alarms_[alarm] = sim::LocalTime::never();
    return;
  }
  cycles_.late.add((now - due(alarm)).ps() / 1000);
  const std::uint64_t missed_before = member_.endpoint()->missed_cycles();
  if (node_.lead > Duration()) node_.socket.set_launch_time(node_.clock.nanoseconds_at(alarms_[alarm]));
  alarms_[alarm] = sim::LocalTime::never();
  member_.wake(*this, alarm);
  node_.socket.set_launch_time(0);
  const std::int64_t cpu = thread_cpu_ns();
  const std::int64_t used_ns = cpu - std::exchange(cpu_at_last_cycle_ns_, cpu);
  cycles_.cpu.add(used_ns);
  const std::uint64_t missed = member_.endpoint()->missed_cycles() - missed_before;
  const std::uint64_t by_code = std::min(missed, static_cast<std::uint64_t>(used_ns / (program_.cycle.ps() / 1000)));
  cycles_.missed_by_code += by_code;
  cycles_.missed_by_system += missed - by_code;
}

void HostedProgram::wake_others(sim::LocalTime now) {
  for (std::size_t alarm = wire::ProgramEndpoint::cycle_alarm + 1; alarm < alarms_.size(); ++alarm) {
    if (alarms_[alarm] > now) continue;
    alarms_[alarm] = sim::LocalTime::never();
    member_.wake(*this, alarm);
  }
}

void HostedProgram::publish(uadp::Octets network_message, const pubsub::Destination& destination) {
  node_.socket.publish(network_message, destination);
  if (destination.writer_group_id == wire::state_writer_group) peers_.published(member_.endpoint()->participant().word(), now());
}

void HostedProgram::process_data(const wire::ProcessDataMessage& message) {
  if (application_ != nullptr) application_->consume(message.data_set, now_ns(), message.fields);
}

void HostedProgram::fill(std::uint8_t data_set, std::span<std::byte> fields) {
  if (application_ != nullptr) application_->produce(data_set, now_ns(), fields);
}

/// Whoever has the role now has not been heard.
void HostedProgram::role_bound(std::size_t role, const handshake::Binding& binding) {
  peers_.forget(role);
  log_.bound(now_ns(), program_.roles[role].name, binding.bound() ? std::string_view(program_.candidates[binding.candidate]) : std::string_view(), binding.life);
}

void HostedProgram::role_taken(std::size_t role, const handshake::Binding& self) { log_.took_role(now_ns(), program_.roles[role].name, self.life); }

void HostedProgram::role_dropped(std::size_t, const handshake::Binding&) {
  peers_.forget(0);
  log_.dropped_role(now_ns());
}

void HostedProgram::stepped(const handshake::Outputs& outputs, const handshake::Word& after) {
  log_.stepped(now_ns(), outputs, after);
  if (application_ == nullptr) return;
  for (const handshake::StateChange& change : outputs.changes()) application_->changed(change);
}

}  // namespace takt::node
