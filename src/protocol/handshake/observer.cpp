// SPDX-License-Identifier: Apache-2.0
#include "handshake/observer.hpp"

#include <utility>

#include "sim/check.hpp"

namespace takt::handshake {

Observer::Observer(Variant variant, GroupTree tree)
    : variant_(variant), tree_(std::move(tree)), history_(variant, tree_), seen_(tree_.participants()) {}

void Observer::on_step(std::size_t participant, const Outputs& outputs, const Word& after) {
  TAKT_CHECK(participant < seen_.size(), "a step is one of a participant");
  seen_[participant].asked_run = after.intent.run;
  if (tree_.is_inner_master(participant) && outputs.raised && outputs.raised_kind == IntentKind::Start)
    history_.on_started(tree_, participant, after.intent.run, seen_[tree_.outer_number(participant)].asked_run);
  for (const StateChange& change : outputs.changes()) on_transition(participant, change, after);
  if (outputs.publish) on_word(participant, after);
}

void Observer::on_transition(std::size_t participant, StateChange change, const Word& after) {
  TAKT_CHECK(participant < seen_.size(), "a transition is one of a participant");
  Seen& seen = seen_[participant];
  if (change.from != seen.state) report(Invariant::S5, Finding::state_jumped, participant);
  if (!is_transition(change)) report(Invariant::S5, Finding::no_such_transition, participant);
  seen.state = change.to;
  if (variant_ == Variant::robust)
    seen.run = after.run;
  else if (history_.begins_round(change))
    seen.run = ++rounds_;
  history_.on_transition(
      tree_, participant, change, after.run,
      [&](Invariant invariant, Finding finding, bool of_tree) { report(invariant, finding, participant, of_tree); });
}

void Observer::on_word(std::size_t participant, const Word& after) {
  TAKT_CHECK(participant < seen_.size(), "a word is one of a participant");
  if (variant_ == Variant::paper) return;
  seen_[participant].run = after.run;
  if (after.state != PublishedState::Ready) return;
  history_.on_ready(tree_, participant, after.run, [&](Invariant invariant, Finding finding, bool of_tree) {
    report(invariant, finding, participant, of_tree);
  });
}

void Observer::on_restart(std::size_t participant) {
  TAKT_CHECK(participant < seen_.size(), "only a participant restarts");
  seen_[participant] = Seen{};
  history_.on_restart(participant);
}

std::uint32_t Observer::sending_run(std::size_t participant) const {
  TAKT_CHECK(participant < seen_.size(), "only a participant sends");
  const Seen& seen = seen_[participant];
  if (seen.state != PublishedState::Running) return 0;
  return variant_ == Variant::robust ? seen.run : rounds_;
}

void Observer::on_process_data(std::size_t from, std::size_t to, std::uint32_t sent_in) {
  TAKT_CHECK(from < seen_.size() && to < seen_.size() && from != to, "process data goes from one to another");
  if (sent_in == 0) {
    report(Invariant::S3, Finding::data_of_one_not_running, to);
  } else if (seen_[to].state != PublishedState::Running) {
    report(Invariant::S3, Finding::data_to_one_not_running, to);
  } else if (variant_ == Variant::robust ? seen_[to].run != sent_in : seen_[to].run > sent_in) {
    report(Invariant::S3, Finding::data_of_another_run, to);
  }
}

void Observer::report(Invariant invariant, Finding finding, std::size_t participant, bool of_tree) {
  violations_.push_back({invariant, finding, static_cast<std::uint8_t>(tree_.index_of(participant)),
                         static_cast<std::uint16_t>(tree_.group_of(participant)), of_tree});
}

std::uint64_t Observer::hash() const {
  std::uint64_t digest = rounds_;
  const auto mix = [&digest](std::uint64_t value) {
    digest = (digest ^ value) * 0x9E3779B97F4A7C15ULL;
    digest ^= digest >> 29;
  };
  for (const Seen& seen : seen_) mix(index_of(seen.state) | std::uint64_t{seen.run} << 32);
  history_.hash_into(mix);
  mix(violations_.size());
  return digest;
}

}  // namespace takt::handshake
