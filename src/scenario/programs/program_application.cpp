#include "scenario/programs/program_application.hpp"

#include <utility>

namespace takt::scenario {

ProgramApplication::ProgramApplication(Settings settings, ProgramMonitor& monitor, std::uint32_t node)
    : state_stream_(settings.state_stream),
      data_streams_(std::move(settings.data_streams)),
      replies_(std::move(settings.replies)),
      monitor_(&monitor),
      endpoint_(std::move(settings.endpoint)),
      node_(node),
      heard_(endpoint_.participant().peer_count()) {}

void ProgramApplication::start(models::HostServices& host) {
  host_ = &host;
  endpoint_.start(*this);
}

void ProgramApplication::crash() {
  if (has_crashed_) return;
  has_crashed_ = true;
  const handshake::PublishedState before = state();
  if (replies_) replies_->forget();
  endpoint_.forget(endpoint_.settings().handshake.incarnation + 1);
  monitor_->on_crash(index(), before);
}

void ProgramApplication::restart(models::HostServices& host) {
  crash();
  has_crashed_ = false;
  monitor_->on_back(index(), node_);
  start(host);
}

void ProgramApplication::call(models::HostServices& host, program::Method method) {
  host_ = &host;
  monitor_->before_call();
  monitor_->on_call(index(), method, endpoint_.call(*this, method));
}

void ProgramApplication::wake(models::HostServices& host, models::AlarmId alarm) {
  host_ = &host;
  if (alarm == endpoint_.alarm_count()) {
    end_work();
    return;
  }
  if (const auto peer = endpoint_.peer_of_alarm(alarm)) monitor_->on_silence(index(), endpoint_.participant().participant_of(*peer), heard_[*peer]);
  endpoint_.wake(*this, alarm);
}

void ProgramApplication::receive(models::HostServices& host, models::StreamIndex, std::span<const std::byte> payload) {
  host_ = &host;
  endpoint_.receive(*this, payload);
}

void ProgramApplication::publish(uadp::Octets network_message, const pubsub::Destination& destination) {
  const bool is_state = destination.writer_group_id == wire::state_writer_group;
  const std::size_t data_set = destination.writer_group_id - std::size_t{wire::first_data_writer_group};
  if (!is_state) monitor_->on_published(data_set, endpoint_.last_data_sequence(data_set));
  host_->send(is_state ? state_stream_ : data_streams_[data_set], network_message);
}

void ProgramApplication::stepped(const handshake::Outputs& outputs, const handshake::Word& after) { monitor_->on_step(index(), outputs, after); }

void ProgramApplication::process_data(const wire::ProcessDataMessage& message) {
  monitor_->on_process_data(message.sender, index(), message.run);
  monitor_->on_data_received(message.data_set, message.sequence, index());
  if (replies_ && replies_->answers(message.data_set)) begin_work(replies_->take({message.data_set, message.sequence}));
}

void ProgramApplication::begin_work(const std::optional<sim::Duration>& work) {
  if (work) host_->work(static_cast<models::AlarmId>(endpoint_.alarm_count()), *work);
}

/// What was asked is answered, unless this participant has stopped in the meantime.
void ProgramApplication::end_work() {
  const ReplyWorker::Done done = replies_->done();
  const std::span<const ResolvedReply> replies = replies_->replies();
  for (std::size_t i = 0; i < replies.size(); ++i) {
    const ResolvedReply& reply = replies[i];
    if (reply.to != done.request.data_set || !replies_->is_own(reply)) continue;
    if (endpoint_.publish_data(*this, reply.with)) monitor_->on_replied(i, endpoint_.last_data_sequence(reply.with), done.request.sequence);
  }
  begin_work(done.next);
}

}  // namespace takt::scenario
