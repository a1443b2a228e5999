// SPDX-License-Identifier: Apache-2.0
// Records which messages of a Program go from whom to whom, and when: what a message-sequence chart shows.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "scenario/run/run.hpp"
#include "sim/trace.hpp"

namespace takt::report {

struct LoggedMessage {
  sim::TrueTime sent;
  sim::TrueTime received;
  std::size_t from = 0;  ///< participant
  std::size_t to = 0;
  bool is_state = false;
};

/// From then until then, both included.
struct Span {
  sim::TrueTime from;
  sim::TrueTime until;
  bool holds(sim::TrueTime time) const { return from <= time && time <= until; }
};

class MessageLog final : public sim::TraceSink {
 public:
  /// Of program `program` of the run, which has no roles: what is received within one of `spans`; none: all.
  MessageLog(const scenario::Run& run, std::size_t program, std::vector<Span> spans = {});

  void record(const sim::TraceRecord& record) override;
  /// In the order of reception.
  const std::vector<LoggedMessage>& messages() const { return messages_; }

 private:
  struct Source {
    std::size_t from = 0;
    bool is_state = false;
  };
  const models::Traffic* traffic_;
  std::vector<Span> spans_;
  std::map<std::uint64_t, Source> streams_;
  std::map<std::uint32_t, std::size_t> participants_;  // by node
  std::vector<LoggedMessage> messages_;
};

}  // namespace takt::report
