// What a node does, as JSON lines: one object an event, written at once.
#pragma once

#include <cstdio>
#include <string_view>

#include "handshake/io.hpp"
#include "wire/program_endpoint.hpp"

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

  struct Wakening {
    std::uint64_t count = 0;
    std::int64_t greatest_ns = 0;  ///< how late
    std::int64_t sum_ns = 0;
  };
  void ended(std::int64_t time, const wire::ProgramEndpoint& endpoint, const Wakening& wakening, std::uint64_t send_failures);

 private:
  std::FILE* file_;
};

}  // namespace takt::node
