// SPDX-License-Identifier: Apache-2.0
// What real nodes have logged, as steps of participants.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "emulate/comparison.hpp"
#include "emulate/plan.hpp"
#include "handshake/binder.hpp"
#include "json/document.hpp"

namespace takt::emulate {

/// A line of a log.
struct LoggedStep {
  std::int64_t time = 0;      ///< nanoseconds on the clock that the nodes share
  std::uint32_t program = 0;  ///< in Resolved::programs
  std::uint8_t participant = 0;
  bool is_crash = false;                         ///< it is new from now on, or gone
  std::optional<handshake::IntentKind> raised;   ///< an intent
  std::optional<handshake::StateChange> change;  ///< of a crash: to Halted, if it was in another state
  std::uint32_t run = 0;                         ///< of the word after the step
  std::uint32_t intent_run = 0;
  std::optional<handshake::Binding> self{};  ///< of a candidate: who it is. Whether the step is the participant's is
                                             ///< still to be found out (role_steps.hpp)
  std::optional<handshake::Binding>
      bound{};  ///< at the master: the role of this participant has this node, and no more
};

/// Reads one node's log line by line.
class LogReader {
 public:
  LogReader(const scenario::Resolved& resolved, const PlannedNode& node);

  /// False if the line is none that a node writes. One that was cut by a kill is passed over.
  bool take(const std::string& line);
  /// All steps in the order of the log. A second start means a crash before it; a log without an end, one that was not
  /// followed by a start.
  std::vector<LoggedStep> finish();
  /// The line of the end; "" if there was none.
  const std::string& status() const { return status_; }

 private:
  struct Part {
    std::string program;
    PlannedNode::Part part;
    handshake::PublishedState state = handshake::PublishedState::Halted;
    std::optional<std::uint8_t> role{};  ///< that a candidate has
    std::uint32_t life = 0;              ///< for which it has it
  };
  void crash();
  void gone(Part& part);
  bool read_binding(const Part& part, const json::Node& event);
  bool read_role(Part& part, std::string_view kind, const json::Node& event);
  std::optional<handshake::Binding> self_of(const Part& part) const;

  const scenario::Resolved& resolved_;

  std::vector<Part> parts_;
  bool has_started_ = false;
  std::int64_t time_ = 0;
  std::string status_;
  std::vector<LoggedStep> steps_;
};

/// The state of this name; nothing if there is none.
std::optional<handshake::PublishedState> published_state_from(std::string_view name);
/// The changes of state by Program.
std::vector<History> histories_of(const std::vector<LoggedStep>& steps, std::size_t programs);

}  // namespace takt::emulate
