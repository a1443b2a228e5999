// A participant of a Program on a simulated host: adapts the sans-IO handshake to the application interface of a host.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "handshake/participant.hpp"
#include "models/host/application.hpp"
#include "scenario/program_monitor.hpp"
#include "wire/program_message.hpp"

namespace takt::scenario {

class ProgramApplication final : public models::Application {
 public:
  /// A data set that this participant publishes.
  struct DataSet {
    std::uint8_t number = 0;            ///< index in the Program
    std::uint32_t field_octets = 0;
    models::StreamIndex stream;
    std::uint16_t sequence = 0;
  };
  struct Settings {
    handshake::Config handshake;
    sim::Duration cycle;
    sim::Duration offset;
    sim::Duration receive_timeout;
    sim::Duration initialisation;
    bool publish_on_change = false;
    models::StreamIndex state_stream;
    std::vector<DataSet> data_sets;
  };

  ProgramApplication(Settings settings, ProgramMonitor& monitor);

  /// A method call by a client or the user of this node.
  void call(models::HostServices& host, program::Method method);
  handshake::PublishedState state() const { return participant_.state(); }

  models::AlarmId alarm_count() const override { return static_cast<models::AlarmId>(first_peer_alarm + participant_.peer_count()); }
  void start(models::HostServices& host) override;
  void receive(models::HostServices& host, models::StreamIndex stream, std::span<const std::byte> payload) override;
  void wake(models::HostServices& host, models::AlarmId alarm) override;

 private:
  static constexpr models::AlarmId cycle_alarm = 0;
  static constexpr models::AlarmId initialised_alarm = 1;
  static constexpr models::AlarmId first_peer_alarm = 2;  // one for each peer: its MessageReceiveTimeout

  handshake::Outputs step(models::HostServices& host, const handshake::Input& input);
  void publish_state(models::HostServices& host);
  void publish_process_data(models::HostServices& host);
  void cycle(models::HostServices& host);

  Settings settings_;
  ProgramMonitor* monitor_;
  handshake::Participant<64> participant_;
  std::uint16_t state_sequence_ = 0;
  std::uint32_t initialisation_run_ = 0;
  std::int64_t cycles_ = 0;
  std::array<std::byte, 1500> buffer_;
};

}  // namespace takt::scenario
