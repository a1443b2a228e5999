// SPDX-License-Identifier: Apache-2.0
#include "handshake/coupling.hpp"

#include <array>

namespace takt::handshake {
namespace {

using program::Method;

constexpr auto halted = PublishedState::Halted;
constexpr auto ready = PublishedState::Ready;
constexpr auto running = PublishedState::Running;
constexpr auto suspended = PublishedState::Suspended;
constexpr auto init = PublishedState::HaltedInit;

/// Rows: the outer state, columns: the inner one.
constexpr std::array<std::array<bool, published_state_count>, published_state_count> steps_match{{
    //  Halted Ready  Running Suspended INIT
    {true, false, false, false, false},  // Halted
    {false, true, false, false, true},   // Ready
    {false, false, true, true, false},   // Running
    {false, false, false, true, false},  // Suspended
    {false, false, false, false, true},  // INIT
}};

/// What takes one that is in `from` to where the other side is; nothing if only a halt remains.
std::optional<Input> input_towards(PublishedState from, PublishedState to) {
  if (to == halted && from != halted) return Input::command(Method::Halt);
  if (from == running && to == suspended) return Input::command(Method::Suspend);
  if (from == suspended && to == running) return Input::command(Method::Resume);
  if (from == running && to == ready) return Input::finished();
  if (from == suspended && to == ready) return Input::command(Method::Reset);
  return std::nullopt;
}

}  // namespace

bool in_step(PublishedState outer, PublishedState inner) { return steps_match[index_of(outer)][index_of(inner)]; }

auto Coupling::next(const GroupView& outer, const GroupView& inner) -> std::optional<Step> {
  if (inner.state != inner_state_) leader_ = Side::inner;
  if (outer.state != outer_state_) leader_ = Side::outer;
  outer_state_ = outer.state;
  inner_state_ = inner.state;

  std::optional<Step> step;
  // A reset of the former inner run can overrule the inner start; then it is started again.
  const bool overruled = outer.run != outer.intent.run && inner.state == ready && inner.may_start;
  const bool starts = outer.intent.kind == IntentKind::Start && (outer.intent.run != started_for_ || overruled);
  if (starts && (outer.state == init || outer.state == ready)) {
    // Where a role has nobody the inner barrier would never be over, and roles are bound in Halted only.
    const bool may_start = inner.may_start && inner.complete;
    if (may_start) started_for_ = outer.intent.run;
    if (!may_start && inner.state == halted)
      step = Step{Side::outer, Input::peer_left(0)};
    else
      step = Step{Side::inner, Input::command(may_start ? Method::Start : Method::Halt)};
  } else {
    step = pass_barriers(outer, inner);
    if (!step) step = follow(outer, inner);
  }
  const auto passes_on = [](Input::Kind kind) { return kind == Input::Kind::command || kind == Input::Kind::finished; };
  if (step && passes_on(step->input.kind)) step->input.coupled = true;
  return step;
}

/// Outer Ready waits for the inner slaves, the inner barrier for the outer master, outer Running for the inner master.
auto Coupling::pass_barriers(const GroupView& outer, const GroupView& inner) const -> std::optional<Step> {
  const bool outer_starts = outer.intent.kind == IntentKind::Start && (outer.state == init || outer.state == ready);
  const bool inner_starts = inner.intent.kind == IntentKind::Start && (inner.state == init || inner.state == ready);
  const bool outer_waits = outer.state == init || outer.run != outer.intent.run;
  const bool inner_waits = inner.state == init || inner.run != inner.intent.run;
  if (outer_starts && inner_starts) {
    const bool initialised = (outer.state == ready || outer_initialised_ == outer.intent.run) &&
                             (inner.state == ready || inner_initialised_ == inner.intent.run);
    if (outer_waits && initialised && inner.peers_ready) return Step{Side::outer, Input::initialised(outer.intent.run)};
    if (outer.may_run && inner_waits && !inner.initialised)
      return Step{Side::inner, Input::initialised(inner.intent.run)};
    return std::nullopt;
  }
  if (outer.may_run && inner.state == running) return Step{Side::outer, Input::released(outer.run)};
  // One group has finished while the other one was within its barrier.
  if (outer.may_run && inner.state == ready) return Step{Side::outer, Input::finished()};
  if (outer.state == ready && !outer_starts && inner_starts) {
    // A reset of the former run that has overruled the start finds inner participants that are in neither run: only a
    // halt remains.
    const bool can_follow = inner.run == inner.intent.run || inner.peers_ready;
    return Step{Side::inner, can_follow ? Input::finished() : Input::command(Method::Halt)};
  }
  return std::nullopt;
}

auto Coupling::follow(const GroupView& outer, const GroupView& inner) const -> std::optional<Step> {
  if (in_step(outer.state, inner.state) && (outer.state == inner.state || outer.state == ready)) return std::nullopt;
  if (outer.state == halted) return Step{Side::inner, Input::command(Method::Halt)};
  if (inner.state == halted) return Step{Side::outer, Input::command(Method::Halt)};
  // Ready is final for a run, so it leads wherever it is; between Running and Suspended the later change does.
  const Side leader = outer.state == ready ? Side::outer : inner.state == ready ? Side::inner : leader_;
  const GroupView& from = leader == Side::outer ? inner : outer;
  const GroupView& to = leader == Side::outer ? outer : inner;
  const Side follower = leader == Side::outer ? Side::inner : Side::outer;
  const std::optional<Input> input = input_towards(from.state, to.state);
  if (!input) return Step{Side::inner, Input::command(Method::Halt)};  // never seen: whatever it is, halted is safe
  const bool is_suspend = input->kind == Input::Kind::command && input->method == Method::Suspend;
  if (is_suspend && !from.may_suspend) return std::nullopt;  // not before the barrier is over
  return Step{follower, *input};
}

std::uint64_t Coupling::hash() const {
  std::uint64_t digest = 0xCBF29CE484222325ULL;
  const auto mix = [&digest](std::uint64_t value) {
    digest = (digest ^ value) * 0x9E3779B97F4A7C15ULL;
    digest ^= digest >> 29;
  };
  mix(started_for_ | std::uint64_t{outer_initialised_} << 32);
  mix(inner_initialised_ | static_cast<std::uint64_t>(leader_) << 32 | std::uint64_t{index_of(outer_state_)} << 40 |
      std::uint64_t{index_of(inner_state_)} << 48);
  return digest;
}

}  // namespace takt::handshake
