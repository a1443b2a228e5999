#include "scenario/programs/plug_application.hpp"

namespace takt::scenario {

void PlugApplication::crash() {
  if (has_crashed_) return;
  has_crashed_ = true;
  forget();
}

void PlugApplication::restart(models::HostServices& host) {
  crash();
  has_crashed_ = false;
  came_back();
  start(host);
}

void PlugApplication::publish(uadp::Octets network_message, const pubsub::Destination& destination) {
  const std::uint16_t group = destination.writer_group_id;
  if (group == wire::state_writer_group)
    host_->send(streams_.state, network_message);
  else if (group == wire::announcement_writer_group || group == wire::table_writer_group)
    host_->send(streams_.announcements, network_message);
  else if (const auto& data = streams_.data[group - std::size_t{wire::first_data_writer_group}])
    host_->send(*data, network_message);
}

void PlugMasterApplication::call(models::HostServices& host, program::Method method) {
  monitor_->before_call();
  monitor_->on_call(0, method, endpoint_.call(at(host), method));
}

void PlugMasterApplication::forget() {
  const handshake::PublishedState before = state();
  endpoint_.forget(++incarnation_);
  monitor_->on_crash(0, before);
}

std::optional<handshake::PublishedState> CandidateApplication::state_of(std::uint32_t life) const {
  if (endpoint_.endpoint() == nullptr || endpoint_.candidate().announcement().life != life) return std::nullopt;
  return endpoint_.endpoint()->participant().state();
}

void CandidateApplication::call(models::HostServices& host, program::Method method) {
  const auto role = endpoint_.candidate().role();
  if (role) monitor_->before_call();
  const program::StatusCode status = endpoint_.call(at(host), method);
  if (role) monitor_->on_call(*role + std::size_t{1}, method, status);
}

void CandidateApplication::forget() {
  const auto role = endpoint_.candidate().role();
  const handshake::Binding before = endpoint_.self();
  endpoint_.forget(handshake::next_life(before.life));
  if (role) roles_->on_dropped(*role, before, true);
}

void CandidateApplication::wake(models::HostServices& host, models::AlarmId alarm) {
  const wire::ProgramEndpoint* const endpoint = endpoint_.endpoint();
  if (const auto role = endpoint_.candidate().role(); role && endpoint != nullptr && endpoint->peer_of_alarm(alarm) == 0) monitor_->on_silence(*role + std::size_t{1}, 0, last_heard(0));
  endpoint_.wake(at(host), alarm);
}

void CandidateApplication::stepped(const handshake::Outputs& outputs, const handshake::Word& after) {
  roles_->on_step(*endpoint_.candidate().role(), endpoint_.self(), outputs, after);
}

void CandidateApplication::process_data(const wire::ProcessDataMessage& message) {
  roles_->on_process_data(*endpoint_.candidate().role(), endpoint_.self(), message.sender, message.run);
}

}  // namespace takt::scenario
