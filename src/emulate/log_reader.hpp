// What real nodes have logged, as steps of participants.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emulate/comparison.hpp"
#include "emulate/plan.hpp"
#include "handshake/word.hpp"

namespace takt::emulate {

/// A line of a log.
struct LoggedStep {
  std::int64_t time = 0;                          ///< nanoseconds on the clock that the nodes share
  std::uint32_t program = 0;                      ///< in Resolved::programs
  std::uint8_t participant = 0;
  bool is_crash = false;                          ///< it is new from now on, or gone
  std::optional<handshake::IntentKind> raised;    ///< an intent
  std::optional<handshake::StateChange> change;   ///< of a crash: to Halted, if it was in another state
  std::uint32_t run = 0;                          ///< of the word after the step
  std::uint32_t intent_run = 0;
};

/// Reads one node's log line by line.
class LogReader {
 public:
  LogReader(const scenario::Resolved& resolved, const PlannedNode& node);

  /// False if the line is none that a node writes. One that was cut by a kill is passed over.
  bool take(const std::string& line);
  /// All steps in the order of the log. A second start means a crash before it; a log without an end, one that was not followed by a start.
  std::vector<LoggedStep> finish();
  /// The line of the end; "" if there was none.
  const std::string& status() const { return status_; }

 private:
  struct Part {
    std::string program;
    PlannedNode::Part part;
    handshake::PublishedState state = handshake::PublishedState::Halted;
  };
  void crash();

  std::vector<Part> parts_;
  bool has_started_ = false;
  std::int64_t time_ = 0;
  std::string status_;
  std::vector<LoggedStep> steps_;
};

/// The changes of state by Program.
std::vector<History> histories_of(const std::vector<LoggedStep>& steps, std::size_t programs);

}  // namespace takt::emulate
