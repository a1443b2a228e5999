// SPDX-License-Identifier: Apache-2.0
#include "scenario/programs/reply_worker.hpp"

#include "sim/check.hpp"

namespace takt::scenario {

ReplyWorker::ReplyWorker(const ResolvedProgram& program, std::uint8_t participant, std::uint64_t seed,
                         std::string_view path)
    : program_(&program),
      participant_(participant),
      values_(program.process_data.size()),
      per_message_(program.processing[participant].per_message),
      per_field_(program.processing[participant].per_field),
      message_chance_(seed, path, "processing of messages"),
      field_chance_(seed, path, "processing of fields"),
      ring_(most_waiting) {
  for (const ResolvedReply& reply : program.replies)
    if (is_own(reply)) values_[reply.to] = program.process_data[reply.to].values;
}

std::optional<sim::Duration> ReplyWorker::take(const Request& request) {
  if (waiting_ == most_waiting) {
    ++lost_;
    return std::nullopt;
  }
  ring_[(first_ + waiting_) % most_waiting] = request;
  if (++waiting_ > 1) return std::nullopt;
  return work(request);
}

ReplyWorker::Done ReplyWorker::done() {
  TAKT_CHECK(waiting_ > 0, "work that was begun");
  Done done{ring_[first_], {}};
  first_ = (first_ + 1) % most_waiting;
  if (--waiting_ > 0) done.next = work(ring_[first_]);
  return done;
}

sim::Duration ReplyWorker::work(const Request& request) {
  return per_message_.draw(message_chance_) + per_field_.draw(field_chance_) * *values_[request.data_set];
}

}  // namespace takt::scenario
