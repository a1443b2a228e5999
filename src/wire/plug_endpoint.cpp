#include "wire/plug_endpoint.hpp"

#include <algorithm>
#include <utility>

namespace takt::wire {

using handshake::Binding;
using handshake::Candidate;
using handshake::Input;

PlugSettings plug_settings(EndpointSettings endpoint, std::shared_ptr<const PlugFormat> format, sim::Duration announce_cycle) {
  PlugSettings settings;
  settings.endpoint = std::move(endpoint);
  settings.format = std::move(format);
  settings.announce_cycle = announce_cycle;
  settings.announce_timeout = announce_cycle * announcements_missed + announce_cycle / 2;
  return settings;
}

PlugMaster::PlugMaster(PlugSettings settings, bool restarts)
    : settings_(std::move(settings)), restarts_(restarts), endpoint_(settings_.endpoint), binder_(new_binder()), announcements_(settings_.format->candidates()) {
  TAKT_CHECK(settings_.announce_cycle > sim::Duration(), "announcements are repeated");
  TAKT_CHECK(table_octets(settings_.format->roles(), settings_.format->candidates()) <= buffer_.size(), "a table fits into a frame");
  endpoint_.expect_nobody();
}

handshake::Binder PlugMaster::new_binder() const { return {settings_.format->shape().skills, settings_.format->candidates(), restarts_}; }

void PlugMaster::start(PlugHost& host) {
  endpoint_.start(host);
  host.set_alarm(table_alarm(), host.now());
}

void PlugMaster::forget(std::uint32_t incarnation) {
  endpoint_.forget(incarnation);
  endpoint_.expect_nobody();
  binder_ = new_binder();
  announcements_.assign(announcements_.size(), {});
  table_sequence_ = 0;
}

program::StatusCode PlugMaster::call(PlugHost& host, program::Method method) {
  binder_.called();
  const bool is_halted = endpoint_.participant().state() == handshake::PublishedState::Halted;
  if (method == program::Method::Start && is_halted && !binder_.complete()) return program::StatusCode::BadResourceUnavailable;
  const program::StatusCode status = endpoint_.call(host, method);
  settle(host);
  return status;
}

void PlugMaster::finished(PlugHost& host) {
  endpoint_.finished(host);
  settle(host);
}

void PlugMaster::receive(PlugHost& host, uadp::Octets network_message) {
  const auto message = settings_.format->decode(network_message);
  if (const auto* const announcement = message ? std::get_if<AnnouncementMessage>(&*message) : nullptr) {
    Arrivals& arrivals = announcements_[announcement->candidate];
    if (!arrivals.take(announcement->sequence, announcement->announcement.life, host.now(), settings_.announce_timeout)) return;
    if (binder_.announced(announcement->candidate, announcement->announcement))
      host.set_alarm(table_alarm() + 1 + announcement->candidate, host.now() + settings_.announce_timeout);
  } else if (!message) {  // or a table, which is its own
    endpoint_.receive(host, network_message);
  }
  settle(host);
}

void PlugMaster::wake(PlugHost& host, std::size_t alarm) {
  if (alarm > table_alarm()) {
    binder_.silent(static_cast<std::uint8_t>(alarm - table_alarm() - 1));
  } else if (alarm == table_alarm()) {
    publish_table(host);
    host.set_alarm(table_alarm(), host.now() + settings_.announce_cycle);
    return;
  } else {
    if (const auto peer = endpoint_.peer_of_alarm(alarm)) binder_.role_silent(*peer);
    endpoint_.wake(host, alarm);
  }
  settle(host);
}

/// Tells the participant what the binder finds; a new table is published at once.
void PlugMaster::settle(PlugHost& host) {
  bool changed = false;
  while (const auto input = binder_.next(master_view_of(endpoint_.participant()))) {
    if (input->kind == Input::Kind::PeerReplaced) {
      const Binding& binding = binder_.binding(input->peer);
      endpoint_.expect(input->peer, binding.bound() ? std::optional(handshake::incarnation_of(binding.candidate, binding.life)) : std::nullopt);
      host.role_bound(input->peer, binding);
      changed = true;
    }
    endpoint_.step(host, *input);
  }
  if (changed) publish_table(host);
}

void PlugMaster::publish_table(PlugHost& host) {
  TableMessage message;
  message.sequence = table_sequence_++;
  message.incarnation = endpoint_.participant().config().incarnation;
  std::copy(binder_.bindings().begin(), binder_.bindings().end(), message.bindings.begin());
  for (std::uint8_t c = 0; c < settings_.format->candidates(); ++c) message.used_lives[c] = binder_.used_life(c);
  host.publish(settings_.format->encode(message, buffer_), {table_writer_group, settings_.endpoint.priority});
}

CandidateEndpoint::CandidateEndpoint(PlugSettings settings, std::uint8_t number, std::uint32_t life, std::vector<handshake::SkillId> skills, bool joins_at_start)
    : settings_(std::move(settings)), number_(number), skills_(std::move(skills)), candidate_(number, life, skills_) {
  TAKT_CHECK(life != 0, "0 is no life");
  TAKT_CHECK(settings_.endpoint.handshake.subscription == handshake::Subscription::Star, "a role hears the master only");
  if (joins_at_start) candidate_.join();
}

void CandidateEndpoint::start(PlugHost& host) { host.set_alarm(announce_alarm, host.now()); }

void CandidateEndpoint::forget(std::uint32_t life) {
  const bool joined = candidate_.announces();
  endpoint_.reset();
  candidate_ = Candidate(number_, life, skills_);
  if (joined) candidate_.join();
  tables_ = {};
  announcement_sequence_ = 0;
}

void CandidateEndpoint::join(PlugHost& host) {
  candidate_.join();
  announce(host);
}

void CandidateEndpoint::leave(PlugHost& host) {
  candidate_.leave();
  announce(host);
}

program::StatusCode CandidateEndpoint::call(PlugHost& host, program::Method method) {
  return endpoint_ ? endpoint_->call(host, method) : program::StatusCode::BadInvalidState;
}

void CandidateEndpoint::finished(PlugHost& host) {
  if (endpoint_) endpoint_->finished(host);
}

void CandidateEndpoint::receive(PlugHost& host, uadp::Octets network_message) {
  const auto message = settings_.format->decode(network_message);
  const auto* const table = message ? std::get_if<TableMessage>(&*message) : nullptr;
  if (table == nullptr) {
    if (!message && endpoint_) endpoint_->receive(host, network_message);  // what others announce is for the master
    return;
  }
  if (!tables_.take(table->sequence, table->incarnation, host.now(), settings_.announce_timeout)) return;
  const Binding before = self();
  const auto role = candidate_.role();
  const Candidate::Change change = candidate_.table(std::span(table->bindings).first(settings_.format->roles()), table->used_lives[number_]);
  if (change == Candidate::Change::Released) {
    endpoint_.reset();
    host.role_dropped(*role, before);
  }
  if (change == Candidate::Change::Bound) {
    take_role();
    host.role_taken(*candidate_.role(), before);
    endpoint_->start(host);
  }
  if (self() != before) announce(host);
}

void CandidateEndpoint::take_role() {
  EndpointSettings settings = settings_.endpoint;
  settings.handshake.role = handshake::Role::Slave;
  settings.handshake.index = static_cast<std::uint8_t>(*candidate_.role() + 1);
  settings.handshake.incarnation = candidate_.incarnation();
  endpoint_.emplace(std::move(settings));
}

void CandidateEndpoint::wake(PlugHost& host, std::size_t alarm) {
  if (alarm == announce_alarm) {
    announce(host);
    host.set_alarm(announce_alarm, host.now() + settings_.announce_cycle);
  } else if (endpoint_) {  // else it is one of a role that it had
    endpoint_->wake(host, alarm);
  }
}

void CandidateEndpoint::announce(PlugHost& host) {
  if (!candidate_.announces()) return;
  const AnnouncementMessage message{number_, announcement_sequence_++, candidate_.announcement()};
  host.publish(settings_.format->encode(message, buffer_), {announcement_writer_group, settings_.endpoint.priority});
}

}  // namespace takt::wire
