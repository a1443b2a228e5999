// SPDX-License-Identifier: Apache-2.0
// What a program on a host is to the network: the interface to which protocol code is adapted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "models/ethernet/frame.hpp"
#include "sim/time.hpp"

namespace takt::models {

/// Number of one of an application's alarms, from 0.
using AlarmId = std::uint16_t;

/// What an application may ask of its host. All times are those of the host's own clock.
class HostServices {
 public:
  virtual ~HostServices() = default;
  virtual sim::LocalTime now() const = 0;
  /// Wakes the application at `time` plus the operating system's wake-up latency; replaces the alarm's earlier setting.
  virtual void set_alarm(AlarmId alarm, sim::LocalTime time) = 0;
  /// The same without the operating system's latency: for an application that knows itself how late its threads
  /// respond.
  virtual void set_exact_alarm(AlarmId alarm, sim::LocalTime time) = 0;
  virtual void cancel_alarm(AlarmId alarm) = 0;
  /// Wakes the application by the alarm when it has worked for so long (of true time, without the operating system's
  /// wake-up latency).
  virtual void work(AlarmId alarm, sim::Duration duration) = 0;
  /// Has one of the application's threads do what it does on the host's processor, and wakes the application by the
  /// alarm when it is done. False if that takes no time of a processor: then it is done.
  virtual bool begin_job(std::uint32_t thread, AlarmId alarm) = 0;
  /// Sends the octets on a stream of which this host is the talker.
  virtual void send(StreamIndex stream, std::span<const std::byte> payload) = 0;
};

/// A program on a host. Calls come at instants that the host's operating system model decides.
class Application {
 public:
  virtual ~Application() = default;
  /// How many alarms it uses.
  virtual AlarmId alarm_count() const = 0;
  virtual void start(HostServices& host) = 0;
  /// The host has come back after a crash: the application begins anew, without its memory. Its alarms were cancelled.
  virtual void restart(HostServices& host) { start(host); }
  virtual void receive(HostServices& host, StreamIndex stream, std::span<const std::byte> payload) = 0;
  virtual void wake(HostServices& host, AlarmId alarm) = 0;
};

}  // namespace takt::models
