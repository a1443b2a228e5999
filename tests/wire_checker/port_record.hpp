// SPDX-License-Identifier: Apache-2.0
// A record of one port, made by hand: which frames came, and what the port did with them.
#pragma once

#include <map>
#include <memory>

#include "tests/wire_checker/port_checker.hpp"

namespace takt::wire_checker {

using models::PortConfig;
using models::TrafficClass;

inline constexpr Ps ns = 1'000;

/// Frames by name: 'a' to 'z'.
class Port {
 public:
  explicit Port(PortConfig config = {})
      : checker_("port", with_identity(std::move(config)), sim::DataRate{1'000'000'000}, *violations_) {}

  Port& frame(char name, TrafficClass q, std::uint16_t length = 100, Ps eligible = long_ago) {
    SeenFrame seen;
    seen.handle = models::FrameIndex{static_cast<std::uint32_t>(name)};
    seen.frame.stream = models::StreamIndex{0};
    seen.frame.sequence = static_cast<std::uint64_t>(name - 'a');
    seen.frame.length = length;
    seen.frame.msdu = static_cast<std::uint16_t>(length - 22);
    seen.frame.priority = q;
    seen.eligible = eligible;
    frames_[name] = seen;
    return *this;
  }
  Port& at(Ps time) {
    end();
    checker_.begin(time);
    checker_.advance_gates();
    open_ = true;
    return *this;
  }
  Port& gates(const models::GateConfig& config) {
    checker_.request_gates(list_config_of(config));
    checker_.advance_gates();
    return *this;
  }
  Port& stuck(TrafficClass q, std::optional<bool> open) {
    checker_.force_gate(q, open);
    return *this;
  }
  Port& up(bool up) {
    checker_.set_up(up);
    return *this;
  }
  Port& start(char name) {
    checker_.started(frames_[name], {frames_[name].frame.length, frames_[name].frame.priority});
    return *this;
  }
  /// The frame has come by its header only.
  Port& start_early(char name) {
    SeenFrame seen = frames_[name];
    seen.is_cut_through = true;
    checker_.started(seen, {seen.frame.length, seen.frame.priority});
    return *this;
  }
  /// At the end of the instant, of a frame that has not started.
  bool could_cut_through(char name) {
    end();
    return checker_.could_cut_through(frames_[name].frame, frames_[name].frame.priority);
  }
  Port& start_as(char name, TrafficClass q) {
    checker_.started(frames_[name], {frames_[name].frame.length, q});
    return *this;
  }
  Port& wait(char name) {
    checker_.enqueued(frames_[name], frames_[name].frame.priority);
    return *this;
  }
  Port& leave(char name) {
    checker_.dequeued(frames_[name], frames_[name].frame.priority);
    return *this;
  }
  Port& drop(char name, models::DropReason reason = models::DropReason::link_down) {
    checker_.dropped(frames_[name].handle, reason);
    return *this;
  }
  Port& refuse(char name, models::DropReason reason) {
    checker_.refused(frames_[name], reason);
    return *this;
  }
  Port& cut(char name, std::uint32_t octets) {
    checker_.cut(frames_[name], {octets, frames_[name].frame.priority});
    return *this;
  }
  Port& resume(char name, std::uint32_t octets) {
    checker_.resumed(frames_[name], {octets, frames_[name].frame.priority});
    return *this;
  }
  /// All that was found, up to that time.
  std::string until(Ps time) {
    end();
    checker_.finish(time);
    return violations_->all();
  }

 private:
  static PortConfig with_identity(PortConfig config) {
    config.traffic_class_of_priority = models::identity_traffic_classes;
    return config;
  }
  void end() {
    if (open_) checker_.end();
    open_ = false;
  }
  std::shared_ptr<Violations> violations_ = std::make_shared<Violations>();  // copies of a Port share it
  PortChecker checker_;
  std::map<char, SeenFrame> frames_;
  bool open_ = false;
};

}  // namespace takt::wire_checker
