// What a node does, as JSON lines: one object an event, written at once.
#pragma once

#include <cstdio>
#include <string_view>

#include "handshake/io.hpp"
#include "node/node_status.hpp"
#include "program/method.hpp"

namespace takt::node {

class TransitionLog {
 public:
  /// `file` outlives the log.
  explicit TransitionLog(std::FILE* file) : file_(file) {}

  /// Times are nanoseconds of the node's clock.
  void started(std::int64_t time, std::string_view node, std::uint32_t incarnation);
  void changed(std::int64_t time, const handshake::StateChange& change);
  void raised(std::int64_t time, handshake::IntentKind kind, handshake::Alarm alarm);
  void called(std::int64_t time, program::Method method, program::StatusCode status);

  void ended(const NodeStatus& status);

 private:
  std::FILE* file_;
};

}  // namespace takt::node
