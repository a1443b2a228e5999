#include "handshake/invariants.hpp"

#include "sim/check.hpp"

namespace takt::handshake {

GroupObserver::GroupObserver(Variant variant, std::size_t participants) : variant_(variant), seen_(participants) {
  TAKT_CHECK(participants >= 2 && participants <= max_participants, "a group has a master and 1 to 64 slaves");
  if (variant == Variant::Robust) return;
  for (std::size_t i = 0; i < participants; ++i) runs_.push_back(Run{static_cast<std::uint32_t>(i), {}, {}});
}

void GroupObserver::on_step(std::size_t participant, const Outputs& outputs, const Word& after) {
  for (const StateChange& change : outputs.changes()) on_transition(participant, change, after);
  if (outputs.publish) on_word(participant, after);
}

void GroupObserver::on_transition(std::size_t participant, StateChange change, const Word& after) {
  TAKT_CHECK(participant < seen_.size(), "a transition is one of a participant");
  check_is_transition(participant, change);
  Seen& seen = seen_[participant];
  seen.state = change.to;
  if (variant_ == Variant::Robust) seen.run = after.run;
  switch (change.to) {
    case PublishedState::Halted: seen.passed_init = false; break;
    case PublishedState::HaltedInit:
      seen.passed_init = true;
      begin_round(participant);
      break;
    case PublishedState::Ready:
      if (change.from != PublishedState::HaltedInit) begin_round(participant);
      became_ready(participant);
      break;
    case PublishedState::Running: became_running(participant); break;
    case PublishedState::Suspended: break;
  }
}

void GroupObserver::on_word(std::size_t participant, const Word& after) {
  TAKT_CHECK(participant < seen_.size(), "a word is one of a participant");
  if (variant_ == Variant::Paper) return;
  seen_[participant].run = after.run;
  if (after.state == PublishedState::Ready) became_ready(participant);
}

void GroupObserver::on_restart(std::size_t participant) {
  TAKT_CHECK(participant < seen_.size(), "only a participant restarts");
  seen_[participant] = Seen{};
}

std::uint32_t GroupObserver::sending_run(std::size_t participant) const {
  TAKT_CHECK(participant < seen_.size(), "only a participant sends");
  const Seen& seen = seen_[participant];
  if (seen.state != PublishedState::Running) return 0;
  return variant_ == Variant::Robust ? seen.run : rounds_;
}

void GroupObserver::on_process_data(std::size_t from, std::size_t to, std::uint32_t sent_in) {
  TAKT_CHECK(from < seen_.size() && to < seen_.size() && from != to, "process data goes from one to another");
  if (sent_in == 0) {
    report(Invariant::S3, Finding::DataOfOneNotRunning, to);
  } else if (seen_[to].state != PublishedState::Running) {
    report(Invariant::S3, Finding::DataToOneNotRunning, to);
  } else if (variant_ == Variant::Robust ? seen_[to].run != sent_in : seen_[to].run > sent_in) {
    report(Invariant::S3, Finding::DataOfAnotherRun, to);
  }
}

void GroupObserver::check_is_transition(std::size_t participant, StateChange change) {
  if (change.from != seen_[participant].state) report(Invariant::S5, Finding::StateJumped, participant);
  const bool substate = (change.from == PublishedState::Halted && change.to == PublishedState::HaltedInit) ||
                        (change.from == PublishedState::HaltedInit && change.to == PublishedState::Halted);
  const program::Transition* transition = program::transition_with_number(change.transition);
  const bool in_table = transition != nullptr && change.to != PublishedState::HaltedInit &&
                        transition->from == base_state(change.from) && transition->to == base_state(change.to);
  if (change.transition == 0 ? !substate : !in_table) report(Invariant::S5, Finding::NoSuchTransition, participant);
}

/// `paper`: see the head of invariants.hpp.
void GroupObserver::begin_round(std::size_t participant) {
  if (variant_ == Variant::Robust) return;
  seen_[participant].run = ++rounds_;
  Run& round = facts_for(participant);
  round = Run{round.id, {}, {}};
  for (std::size_t i = 0; i < seen_.size(); ++i)
    if (seen_[i].state == PublishedState::Ready) round.ready.insert(i);
}

void GroupObserver::became_ready(std::size_t participant) {
  if (variant_ == Variant::Robust) {
    facts_for(participant).ready.insert(participant);
  } else {
    for (Run& round : runs_) round.ready.insert(participant);
  }
}

void GroupObserver::became_running(std::size_t participant) {
  if (variant_ == Variant::Robust) {
    facts_for(participant).running.insert(participant);
  } else {
    for (Run& round : runs_) round.running.insert(participant);
  }
  const Run& run = facts_for(participant);
  if (!run.ready.master || run.ready.slaves != all_slaves())
    report(Invariant::S1, Finding::RunningBeforeAllReady, participant);
  if (participant == 0 && run.running.slaves != all_slaves())
    report(Invariant::S2, Finding::MasterBeforeSlaves, participant);
  if (!seen_[participant].passed_init) report(Invariant::S4, Finding::RunningWithoutInit, participant);
}

/// The newest runs are asked for most, so the search begins at the end.
auto GroupObserver::facts_for(std::size_t participant) -> Run& {
  if (variant_ == Variant::Paper) return runs_[participant];
  const std::uint32_t run = seen_[participant].run;
  for (std::size_t i = runs_.size(); i-- > 0;)
    if (runs_[i].id == run) return runs_[i];
  runs_.push_back(Run{run, {}, {}});
  return runs_.back();
}

std::uint64_t GroupObserver::all_slaves() const { return ~std::uint64_t{0} >> (max_participants - seen_.size()); }

void GroupObserver::report(Invariant invariant, Finding finding, std::size_t participant) {
  violations_.push_back({invariant, finding, static_cast<std::uint8_t>(participant)});
}

void GroupObserver::ParticipantSet::insert(std::size_t participant) {
  if (participant == 0) {
    master = true;
  } else {
    slaves |= std::uint64_t{1} << (participant - 1);
  }
}

std::uint64_t GroupObserver::hash() const {
  std::uint64_t digest = rounds_;
  const auto mix = [&digest](std::uint64_t value) {
    digest = (digest ^ value) * 0x9E3779B97F4A7C15ULL;
    digest ^= digest >> 29;
  };
  for (const Seen& seen : seen_)
    mix(index_of(seen.state) | static_cast<std::uint64_t>(seen.passed_init) << 8 | std::uint64_t{seen.run} << 32);
  for (const Run& run : runs_) {
    mix(run.id | std::uint64_t{run.ready.master} << 32 | std::uint64_t{run.running.master} << 33);
    mix(run.ready.slaves);
    mix(run.running.slaves);
  }
  mix(violations_.size());
  return digest;
}

}  // namespace takt::handshake
