// SPDX-License-Identifier: Apache-2.0
// What a node is in a Program, on a simulated host: a wire::ProgramNode behind the application interface of a host.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "models/host/application.hpp"
#include "scenario/programs/reply_worker.hpp"
#include "scenario/programs/role_monitor.hpp"
#include "scenario/programs/sealed_messages.hpp"
#include "wire/nesting.hpp"
#include "wire/program_node.hpp"

namespace takt::scenario {

class ProgramApplication final : public models::Application {
 public:
  struct Settings {
    wire::NodeSettings node;
    models::StreamIndex state_stream;
    std::optional<models::StreamIndex> role_stream =
        {};  ///< with roles: of announcements; of the master: the table of bindings
    std::vector<std::optional<models::StreamIndex>> data_streams = {};  ///< by data set of the Program, of the own ones
    std::unique_ptr<SealedMessages> sealed = {};                        ///< if its messages are secured
    std::optional<ReplyWorker> replies = {};                            ///< if there are replies
  };

  /// `roles`: null without them. `host`: the node.
  ProgramApplication(Settings settings, ProgramMonitor& monitor, RoleMonitor* roles, models::NodeIndex host);

  /// Joins two Programs on one host; both outlive what is returned, which outlives their use.
  static std::unique_ptr<wire::Nesting> nest(ProgramApplication& outer, models::HostServices& outer_host,
                                             ProgramApplication& inner, models::HostServices& inner_host);

  /// A method call by a client or the user of this node.
  void call(models::HostServices& host, program::Method method);
  /// A candidate for roles.
  void join(models::HostServices& host) { carry_out(host, node_.join(host.now())); }
  void leave(models::HostServices& host) { carry_out(host, node_.leave(host.now())); }
  /// The host has crashed: what was here is gone, with its memory. It comes back with `restart`, in another life.
  void crash();
  models::NodeIndex host() const { return host_; }
  const wire::ProgramNode& node() const { return node_; }
  /// Of a candidate's participant of this life, if it has one now.
  std::optional<handshake::PublishedState> state_of(std::uint32_t life) const;

  models::AlarmId alarm_count() const override {
    return static_cast<models::AlarmId>(work_alarm() + (replies_ ? 1 : 0));
  }
  void start(models::HostServices& host) override { carry_out(host, node_.start(host.now())); }
  void restart(models::HostServices& host) override;
  void receive(models::HostServices& host, models::StreamIndex, std::span<const std::byte> payload) override;
  void wake(models::HostServices& host, models::AlarmId alarm) override;

 private:
  void carry_out(models::HostServices& host, wire::NodeOutputs& outputs);
  void act(models::HostServices& host, const wire::SetAlarm& alarm) {
    host.set_alarm(static_cast<models::AlarmId>(alarm.alarm), alarm.time);
  }
  void act(models::HostServices& host, const wire::Publish& message);
  void act(models::HostServices& host, const wire::ProcessDataMessage& message);
  void act(models::HostServices&, const wire::Heard& heard) { heard_[heard.peer] = monitor_->now(); }
  void act(models::HostServices&, const wire::Stepped& step);
  void act(models::HostServices&, const wire::RoleBound& bound) { roles_->on_bound(bound.role, bound.binding); }
  void act(models::HostServices&, const wire::RoleTaken&) {}  // the master says who is bound
  void act(models::HostServices&, const wire::RoleDropped& dropped) {
    roles_->on_dropped(dropped.role, dropped.self, false);
  }

  void send(models::HostServices& host, models::StreamIndex stream, std::span<const std::byte> octets) {
    host.send(stream, sealed_ ? sealed_->seal(octets) : octets);
  }
  void begin_work(models::HostServices& host, const std::optional<sim::Duration>& work);
  void end_work(models::HostServices& host);
  std::size_t work_alarm() const { return node_.alarm_count(); }
  bool is_candidate() const { return node_.candidate() != nullptr; }

  models::StreamIndex state_stream_;
  std::optional<models::StreamIndex> role_stream_;
  std::vector<std::optional<models::StreamIndex>> data_streams_;
  std::unique_ptr<SealedMessages> sealed_;
  std::optional<ReplyWorker> replies_;
  ProgramMonitor* monitor_;
  RoleMonitor* roles_;
  models::NodeIndex host_;
  wire::ProgramNode node_;
  std::vector<sim::TrueTime> heard_;  ///< by peer; the beginning for one that was never heard
  bool has_crashed_ = false;
  handshake::Side side_ = handshake::Side::outer;
  ProgramApplication* other_ = nullptr;  ///< nested with this one
  models::HostServices* host_of_other_ = nullptr;
};

}  // namespace takt::scenario
