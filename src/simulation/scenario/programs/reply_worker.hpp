// SPDX-License-Identifier: Apache-2.0
// The application of a participant that answers process data: it works at one message after the other, then publishes
// the reply.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "scenario/resolved/resolved.hpp"
#include "sim/random.hpp"

namespace takt::scenario {

class ReplyWorker {
 public:
  /// What is worked at: a message of this data set with this number.
  struct Request {
    std::uint8_t data_set = 0;
    std::uint16_t sequence = 0;
  };

  /// Of participant `participant` of the program, which outlives the worker; `path` names it in the random streams.
  ReplyWorker(const ResolvedProgram& program, std::uint8_t participant, std::uint64_t seed, std::string_view path);

  /// Whether this participant answers messages of the data set.
  bool answers(std::uint8_t data_set) const { return values_[data_set].has_value(); }
  /// Those of the program, in its order.
  std::span<const ResolvedReply> replies() const { return program_->replies; }
  /// Whether this participant gives it.
  bool is_own(const ResolvedReply& reply) const { return program_->process_data[reply.with].from == participant_; }
  /// A message has come. How long the work takes that begins now; nothing if it waits behind other work, or is lost
  /// because too much waits already.
  std::optional<sim::Duration> take(const Request& request);
  /// The work is done: at what, and how long the next one takes that begins now.
  struct Done {
    Request request;
    std::optional<sim::Duration> next;
  };
  Done done();
  /// All work is forgotten.
  void forget() { waiting_ = 0; }
  /// Messages that were lost.
  std::uint64_t lost() const { return lost_; }

 private:
  static constexpr std::size_t most_waiting = 256;
  sim::Duration work(const Request& request);

  const ResolvedProgram* program_;
  std::uint8_t participant_;
  std::vector<std::optional<std::int64_t>> values_;  // by data set: in a message of it, if it is answered here
  sim::Distribution per_message_;
  sim::Distribution per_field_;
  sim::RandomStream message_chance_;
  sim::RandomStream field_chance_;
  std::vector<Request> ring_;
  std::size_t first_ = 0;
  std::size_t waiting_ = 0;  // the first of them is being worked at
  std::uint64_t lost_ = 0;
};

}  // namespace takt::scenario
