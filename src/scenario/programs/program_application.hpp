// A participant of a Program on a simulated host: a wire::ProgramEndpoint behind the application interface of a host.
#pragma once

#include <optional>
#include <vector>

#include "models/host/application.hpp"
#include "scenario/programs/program_monitor.hpp"
#include "scenario/programs/reply_worker.hpp"
#include "wire/nesting.hpp"
#include "wire/program_endpoint.hpp"

namespace takt::scenario {

class ProgramApplication final : public models::Application, private wire::EndpointHost {
 public:
  struct Settings {
    wire::EndpointSettings endpoint;
    models::StreamIndex state_stream;
    std::vector<models::StreamIndex> data_streams;  ///< by data set of the Program
    std::optional<ReplyWorker> replies = {};        ///< if there are replies
  };

  ProgramApplication(Settings settings, ProgramMonitor& monitor, std::uint32_t node);

  /// Joins two participants on one host; both outlive what is returned, which outlives their use.
  static std::unique_ptr<wire::Nesting> nest(ProgramApplication& outer, ProgramApplication& inner) {
    wire::EndpointHost& outer_host = outer;
    wire::EndpointHost& inner_host = inner;
    return std::make_unique<wire::Nesting>(outer.endpoint_, outer_host, inner.endpoint_, inner_host);
  }

  /// A method call by a client or the user of this node.
  void call(models::HostServices& host, program::Method method);
  /// The host has crashed: the participant is gone, with its memory. It comes back with `restart`, as another incarnation.
  void crash();
  handshake::PublishedState state() const { return endpoint_.participant().state(); }
  const wire::ProgramEndpoint& endpoint() const { return endpoint_; }

  models::AlarmId alarm_count() const override { return static_cast<models::AlarmId>(endpoint_.alarm_count() + (replies_ ? 1 : 0)); }
  void start(models::HostServices& host) override;
  void restart(models::HostServices& host) override;
  void receive(models::HostServices& host, models::StreamIndex stream, std::span<const std::byte> payload) override;
  void wake(models::HostServices& host, models::AlarmId alarm) override;

 private:
  // As an endpoint's host, within a call of the simulated one.
  sim::LocalTime now() const override { return host_->now(); }
  void set_alarm(std::size_t alarm, sim::LocalTime time) override { host_->set_alarm(static_cast<models::AlarmId>(alarm), time); }
  void publish(uadp::Octets network_message, const pubsub::Destination& destination) override;
  void stepped(const handshake::Outputs& outputs, const handshake::Word& after) override;
  void process_data(const wire::ProcessDataMessage& message) override;
  void heard(std::size_t peer, const handshake::Word&) override { heard_[peer] = monitor_->now(); }
  std::uint32_t run_of_paper() const override { return monitor_->sending_run(index()); }

  void begin_work(const std::optional<sim::Duration>& work);
  void end_work();

  std::uint8_t index() const { return endpoint_.settings().handshake.index; }

  models::StreamIndex state_stream_;
  std::vector<models::StreamIndex> data_streams_;
  std::optional<ReplyWorker> replies_;
  ProgramMonitor* monitor_;
  wire::ProgramEndpoint endpoint_;
  std::uint32_t node_;
  std::vector<sim::TrueTime> heard_;              ///< by peer
  models::HostServices* host_ = nullptr;
  bool has_crashed_ = false;
};

}  // namespace takt::scenario
