// SPDX-License-Identifier: Apache-2.0
#include "node/program_reporter.hpp"

#include <time.h>

namespace takt::node {
namespace {

/// What would be accepted now: it is tried with copies, so it is the handshake's own answer, whatever its variant.
program::MethodSet executable_now(const wire::ProgramNode& part) {
  program::MethodSet set;
  if (part.endpoint() == nullptr) return set;
  for (const program::MethodInfo& each : program::methods) {
    handshake::Participant<64> copy = part.endpoint()->participant();
    if (program::is_good(copy.step(handshake::Input::command(each.method)).status))
      set.bits = static_cast<std::uint8_t>(set.bits | 1U << program::index_of(each.method));
  }
  return set;
}

}  // namespace

uadp::DateTime utc_now() {
  constexpr std::int64_t ticks_per_s = 10'000'000;
  constexpr std::int64_t seconds_1601_to_1970 = 11'644'473'600;
  timespec time = {};
  ::clock_gettime(CLOCK_REALTIME, &time);
  return {(time.tv_sec + seconds_1601_to_1970) * ticks_per_s + time.tv_nsec / 100};
}

wire::ProgramNews ProgramReporter::news(wire::ProgramNews::Kind kind) const {
  wire::ProgramNews made;
  made.program = program_;
  made.kind = kind;
  made.executable = executable_;
  made.time = utc_now();
  return made;
}

void ProgramReporter::stepped(const handshake::Outputs& outputs, const wire::ProgramNode& part) {
  if (hand_over_ == nullptr || (!outputs.raised && outputs.change_count == 0)) return;
  executable_ = executable_now(part);
  if (outputs.raised) {
    wire::ProgramNews intent = news(wire::ProgramNews::Kind::intent);
    intent.intent = outputs.raised_kind;
    intent.alarm = outputs.alarm;
    hand_over_->report({.news = intent});
  }
  for (const handshake::StateChange& change : outputs.changes()) {
    wire::ProgramNews transition = news(wire::ProgramNews::Kind::transition);
    transition.change = change;
    transition.alarm = outputs.alarm;
    transition.by_call = calling_.has_value();
    transition.method = calling_.value_or(program::Method::Halt);
    hand_over_->report({.news = transition});
  }
}

void ProgramReporter::heard(std::size_t peer, const handshake::Word& word, const wire::ProgramNode& part) {
  if (hand_over_ == nullptr || peer >= heard_.size()) return;
  Heard& last = heard_[peer];
  if (last.is_heard && last.state == word.state && last.run == word.run) return;
  const bool is_news = !last.is_heard || last.state != word.state;
  last = {true, word.state, word.run};
  executable_ = executable_now(part);
  wire::ProgramNews told = news(is_news ? wire::ProgramNews::Kind::peer : wire::ProgramNews::Kind::methods);
  told.peer = static_cast<std::uint16_t>(peer);
  told.peer_state = word.state;
  hand_over_->report({.news = told});
}

void ProgramReporter::methods(const wire::ProgramNode& part) {
  if (hand_over_ == nullptr) return;
  executable_ = executable_now(part);
  hand_over_->report({.news = news(wire::ProgramNews::Kind::methods)});
}

}  // namespace takt::node
