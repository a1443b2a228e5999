// SPDX-License-Identifier: Apache-2.0
// The PubSubState of a component (OPC 10000-14, 6.2.1): publisher or subscriber > group > writer or reader.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "program/status.hpp"

namespace takt::pubsub {

using program::StatusCode;

/// The value is the one of the standard's enumeration.
enum class PubSubState : std::uint8_t { Disabled, Paused, Operational, Error, PreOperational };

inline constexpr std::array<std::string_view, 5> pubsub_state_names{"Disabled", "Paused", "Operational", "Error",
                                                                    "PreOperational"};
constexpr std::string_view name_of(PubSubState state) { return pubsub_state_names[static_cast<std::size_t>(state)]; }

/// The state of one component follows from four facts; the state of the parent is one of them.
class PubSubComponent {
 public:
  /// A component that needs no start-up (all but readers) is Operational as soon as it may be.
  explicit PubSubComponent(bool needs_start_up = false) : needs_start_up_(needs_start_up) {}

  PubSubState state() const {
    if (!enabled_) return PubSubState::Disabled;
    if (parent_ != PubSubState::Operational) return PubSubState::Paused;
    if (!program::is_good(failure_)) return PubSubState::Error;
    return needs_start_up_ && !started_ ? PubSubState::PreOperational : PubSubState::Operational;
  }
  bool operational() const { return state() == PubSubState::Operational; }
  /// Not Disabled, not Paused: it sends or listens.
  bool active() const { return enabled_ && parent_ == PubSubState::Operational; }

  /// OPC 10000-14, 9.1.10.2: only what is Disabled can be enabled.
  StatusCode enable() {
    if (enabled_) return StatusCode::BadInvalidState;
    enabled_ = true;
    return StatusCode::Good;
  }
  /// OPC 10000-14, 9.1.10.3: what is Disabled cannot be disabled.
  StatusCode disable() {
    if (!enabled_) return StatusCode::BadInvalidState;
    enabled_ = false;
    forget();
    return StatusCode::Good;
  }
  /// The parent is in this state now. A component without a parent has one that is Operational.
  void set_parent(PubSubState parent) {
    if (parent != PubSubState::Operational) forget();
    parent_ = parent;
  }

  /// Start-up is done: for a reader, the first key frame or event is here.
  void start() { started_ = true; }
  void fail(StatusCode why) { failure_ = why; }
  /// The cause of the failure is gone.
  void recover() { failure_ = StatusCode::Good; }
  /// Why it is in Error; Good if it is not.
  StatusCode failure() const { return failure_; }

 private:
  void forget() {
    started_ = false;
    failure_ = StatusCode::Good;
  }

  bool needs_start_up_;
  bool enabled_ = true;
  bool started_ = false;
  PubSubState parent_ = PubSubState::Operational;
  StatusCode failure_ = StatusCode::Good;
};

}  // namespace takt::pubsub
