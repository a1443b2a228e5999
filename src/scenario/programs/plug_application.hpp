// A group with roles on simulated hosts: its master, and the nodes that may have a role.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "models/host/application.hpp"
#include "scenario/programs/plug_monitor.hpp"
#include "wire/plug_endpoint.hpp"

namespace takt::scenario {

/// What both have in common: an endpoint's host within a call of the simulated one.
class PlugApplication : public models::Application, protected wire::PlugHost {
 public:
  struct Streams {
    models::StreamIndex state;
    models::StreamIndex announcements;  ///< of the master: the table of bindings
    std::vector<std::optional<models::StreamIndex>> data;  ///< by data set, of the own ones
  };

  virtual void call(models::HostServices& host, program::Method method) = 0;
  /// The host has crashed: what was here is gone, with its memory.
  void crash();
  void restart(models::HostServices& host) final;

 protected:
  PlugApplication(Streams streams, ProgramMonitor& monitor, PlugMonitor& roles) : monitor_(&monitor), roles_(&roles), streams_(std::move(streams)) {}

  /// Within the call of a host.
  PlugHost& at(models::HostServices& host) {
    host_ = &host;
    return *this;
  }
  virtual void forget() = 0;
  virtual void came_back() = 0;
  /// In true time; the beginning for one that was never heard.
  sim::TrueTime last_heard(std::size_t peer) const { return peer < heard_.size() ? heard_[peer] : sim::TrueTime(); }

  ProgramMonitor* monitor_;
  PlugMonitor* roles_;

 private:
  sim::LocalTime now() const override { return host_->now(); }
  void heard(std::size_t peer, const handshake::Word&) final {
    if (peer >= heard_.size()) heard_.resize(peer + 1);
    heard_[peer] = monitor_->now();
  }
  void set_alarm(std::size_t alarm, sim::LocalTime time) override { host_->set_alarm(static_cast<models::AlarmId>(alarm), time); }
  void publish(uadp::Octets network_message, const pubsub::Destination& destination) override;

  Streams streams_;
  std::vector<sim::TrueTime> heard_;   // by peer
  models::HostServices* host_ = nullptr;
  bool has_crashed_ = false;
};

class PlugMasterApplication final : public PlugApplication {
 public:
  PlugMasterApplication(wire::PlugSettings settings, bool restarts, Streams streams, ProgramMonitor& monitor, PlugMonitor& roles, std::uint32_t node)
      : PlugApplication(std::move(streams), monitor, roles), endpoint_(std::move(settings), restarts), node_(node) {}

  handshake::PublishedState state() const { return endpoint_.endpoint().participant().state(); }
  const handshake::Binder& binder() const { return endpoint_.binder(); }

  void call(models::HostServices& host, program::Method method) override;
  models::AlarmId alarm_count() const override { return static_cast<models::AlarmId>(endpoint_.alarm_count()); }
  void start(models::HostServices& host) override { endpoint_.start(at(host)); }
  void receive(models::HostServices& host, models::StreamIndex, std::span<const std::byte> payload) override { endpoint_.receive(at(host), payload); }
  void wake(models::HostServices& host, models::AlarmId alarm) override {
    if (const auto peer = endpoint_.endpoint().peer_of_alarm(alarm); peer && *peer < endpoint_.endpoint().participant().peer_count()) monitor_->on_silence(0, *peer + 1, last_heard(*peer));
    endpoint_.wake(at(host), alarm);
  }

 private:
  void forget() override;
  void came_back() override { monitor_->on_back(0, node_); }
  void stepped(const handshake::Outputs& outputs, const handshake::Word& after) override { monitor_->on_step(0, outputs, after); }
  void process_data(const wire::ProcessDataMessage& message) override { monitor_->on_process_data(message.sender, 0, message.run); }
  void role_bound(std::size_t role, const handshake::Binding& binding) override { roles_->on_bound(role, binding); }
  void role_taken(std::size_t, const handshake::Binding&) override {}
  void role_dropped(std::size_t, const handshake::Binding&) override {}

  wire::PlugMaster endpoint_;
  std::uint32_t node_;
  std::uint32_t incarnation_ = 1;
};

class CandidateApplication final : public PlugApplication {
 public:
  CandidateApplication(wire::PlugSettings settings, std::uint8_t number, std::vector<handshake::SkillId> skills, bool joins, Streams streams,
                       ProgramMonitor& monitor, PlugMonitor& roles)
      : PlugApplication(std::move(streams), monitor, roles), endpoint_(std::move(settings), number, 1, std::move(skills), joins) {}

  void join(models::HostServices& host) { endpoint_.join(at(host)); }
  void leave(models::HostServices& host) { endpoint_.leave(at(host)); }
  /// Of the participant of this life, if it has one now.
  std::optional<handshake::PublishedState> state_of(std::uint32_t life) const;

  void call(models::HostServices& host, program::Method method) override;
  models::AlarmId alarm_count() const override { return static_cast<models::AlarmId>(endpoint_.alarm_count()); }
  void start(models::HostServices& host) override { endpoint_.start(at(host)); }
  void receive(models::HostServices& host, models::StreamIndex, std::span<const std::byte> payload) override { endpoint_.receive(at(host), payload); }
  void wake(models::HostServices& host, models::AlarmId alarm) override;

 private:
  void forget() override;
  void came_back() override {}  // as a candidate; it is there when it is bound
  void stepped(const handshake::Outputs& outputs, const handshake::Word& after) override;
  void process_data(const wire::ProcessDataMessage& message) override;
  void role_bound(std::size_t, const handshake::Binding&) override {}
  void role_taken(std::size_t, const handshake::Binding&) override {}
  void role_dropped(std::size_t role, const handshake::Binding& self) override { roles_->on_dropped(role, self, false); }

  wire::CandidateEndpoint endpoint_;
};

}  // namespace takt::scenario
