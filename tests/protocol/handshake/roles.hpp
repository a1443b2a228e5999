// SPDX-License-Identifier: Apache-2.0
// A group whose roles are bound to nodes that announce themselves, without a network: the test says what is delivered
// when.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "handshake/binder.hpp"
#include "handshake/observer.hpp"
#include "handshake/participant.hpp"
#include "handshake/role_observer.hpp"

namespace takt::handshake {

/// An announcement, a table or a word under way. Candidate c is station c + 1, the master station 0.
struct RoleMessage {
  enum class Kind : std::uint8_t { Announcement, Table, Word };
  Kind kind = Kind::Word;
  std::size_t from = 0;
  std::size_t to = 0;
  Announcement announcement;
  std::vector<Binding> table;
  std::uint32_t used_life = 0;
  Word word;
  std::uint8_t sender = 0;  ///< participant that the word is of
  std::uint16_t sequence = 0;
  std::uint32_t sent_in = 0;
};

class RoleGroup {
 public:
  using Member = Participant<4>;

  RoleGroup(std::vector<SkillId> roles, std::vector<std::vector<SkillId>> offers, bool restarts = false)
      : observer(Variant::robust, roles.size() + 1),
        roles_(std::move(roles)),
        offers_(std::move(offers)),
        restarts_(restarts),
        master_(config(0, 1)),
        binder_(roles_, offers_.size(), restarts),
        members_(offers_.size()),
        role_observers_(roles_.size()),
        sequence_(offers_.size() + 1),
        heard_announcement_(offers_.size()),
        announced_(offers_.size()),
        heard_table_(offers_.size()),
        pending_(offers_.size() + 1) {
    for (std::uint8_t c = 0; c < offers_.size(); ++c) candidates_.emplace_back(c, 1, offers_[c]);
  }

  std::size_t stations() const { return offers_.size() + 1; }
  std::size_t roles() const { return roles_.size(); }
  const Member& master() const { return master_; }
  const Binder& binder() const { return binder_; }
  const Candidate& candidate(std::size_t c) const { return candidates_[c]; }
  /// Everything that what comes next depends on, but for sequence numbers.
  std::uint64_t hash() const;

  /// The participant on a candidate, if it has a role.
  const std::optional<Member>& member(std::size_t c) const { return members_[c]; }

  void join(std::size_t c) { candidates_[c].join(); }
  void leave(std::size_t c) { candidates_[c].leave(); }
  program::StatusCode call(std::size_t station, program::Method method) {
    if (station != 0)
      return members_[station - 1] ? step_member(station - 1, Input::command(method)).status
                                   : program::StatusCode::BadInvalidState;
    binder_.called();
    if (method == program::Method::Start && !binder_.complete()) return program::StatusCode::BadInvalidState;
    const auto status = step_master(Input::command(method)).status;
    settle();
    return status;
  }
  void finish(std::size_t station) {
    if (station == 0)
      step_master(Input::finished()), settle();
    else if (members_[station - 1])
      step_member(station - 1, Input::finished());
  }
  /// The MessageReceiveTimeout of a participant's peer expires.
  void silent(std::size_t station, std::size_t peer) {
    if (station != 0) {
      if (members_[station - 1]) step_member(station - 1, Input::peer_silent(0));
      return;
    }
    if (const Binding& lost = binder_.binding(peer % roles()); lost.bound()) announced_[lost.candidate].reset();
    binder_.role_silent(peer % roles());
    step_master(Input::peer_silent(peer % roles()));
    settle();
  }
  void announcement_missed(std::size_t c) {
    announced_[c].reset(), binder_.silent(static_cast<std::uint8_t>(c)), settle();
  }

  void restart(std::size_t station) {
    pending_[station] = {};
    sequence_[station] = 0;
    if (station == 0) {
      master_ = Member(config(0, ++incarnation_));
      binder_ = Binder(roles_, offers_.size(), restarts_);
      heard_announcement_.assign(offers_.size(), {});
      announced_.assign(offers_.size(), std::nullopt);
      observer.on_restart(0);
      return;
    }
    const std::size_t c = station - 1;
    drop_member(c);
    const bool joined = candidates_[c].announces();
    candidates_[c] = Candidate(static_cast<std::uint8_t>(c), candidates_[c].announcement().life + 1, offers_[c]);
    if (joined) candidates_[c].join();
    heard_table_[c] = {};
  }

  std::vector<RoleMessage> messages(std::size_t station) {
    std::vector<RoleMessage> made;
    RoleMessage message;
    message.from = station;
    message.sequence = ++sequence_[station];
    if (station != 0) {
      const std::size_t c = station - 1;
      message.kind = RoleMessage::Kind::Announcement;
      message.announcement = candidates_[c].announcement();
      if (candidates_[c].announces()) made.push_back(message);
      if (!members_[c]) return made;
      message.kind = RoleMessage::Kind::Word;
      message.word = members_[c]->word();
      message.sender = members_[c]->config().index;
      message.sent_in = is_seen(c) ? observer.sending_run(message.sender) : 0;
      made.push_back(message);
      return made;
    }
    for (message.to = 1; message.to < stations(); ++message.to) {
      message.kind = RoleMessage::Kind::Table;
      message.table.assign(binder_.bindings().begin(), binder_.bindings().end());
      message.used_life = binder_.used_life(static_cast<std::uint8_t>(message.to - 1));
      message.word = master_.word();  // of a table: its incarnation
      made.push_back(message);
      message.kind = RoleMessage::Kind::Word;
      message.sent_in = observer.sending_run(0);
      made.push_back(message);
      message.table.clear();
    }
    return made;
  }

  void deliver(const RoleMessage& message) {
    if (message.to == 0)
      deliver_to_master(message);
    else
      deliver_to_candidate(message, message.to - 1);
  }

  void initialised(std::size_t station) {
    if (!pending_[station]) return;
    const std::uint32_t run = *pending_[station];
    pending_[station].reset();
    if (station == 0)
      step_master(Input::initialised(run)), settle();
    else if (members_[station - 1])
      step_member(station - 1, Input::initialised(run));
  }
  void round(std::size_t silent_station = ~std::size_t{0}) {
    for (std::size_t station = 0; station < stations(); ++station) {
      if (station == silent_station) continue;
      initialised(station);
      for (const RoleMessage& message : messages(station))
        if (message.to != silent_station) deliver(message);
    }
  }
  void rounds(int count, std::size_t silent_station = ~std::size_t{0}) {
    for (int i = 0; i < count; ++i) round(silent_station);
  }

  /// The master and all that have a role, which all roles have.
  bool all_in(PublishedState state) const {
    if (!binder_.complete() || master_.state() != state) return false;
    for (const Binding& binding : binder_.bindings()) {
      const auto& member = members_[binding.candidate];
      if (!member || candidates_[binding.candidate].announcement().life != binding.life || member->state() != state)
        return false;
    }
    return true;
  }

  std::string describe() const {
    std::string text = "  master " + std::string(name_of(master_.state())) + " intent " +
                       std::to_string(master_.intent().number) + "/" + std::string(name_of(master_.intent().kind)) +
                       (binder_.complete() ? "" : ", not complete") + "\n";
    for (std::size_t role = 0; role < roles(); ++role) {
      const Binding& binding = binder_.binding(role);
      text +=
          "  role " + std::to_string(role) + ": " +
          (binding.bound() ? "candidate " + std::to_string(binding.candidate) + " life " + std::to_string(binding.life)
                           : "nobody") +
          "\n";
    }
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      text += "  candidate " + std::to_string(c) + " life " + std::to_string(candidates_[c].announcement().life) +
              (candidates_[c].announces() ? "" : ", away") +
              (candidates_[c].role() ? ", role " + std::to_string(*candidates_[c].role()) : "");
      if (members_[c])
        text += " " + std::string(name_of(members_[c]->state())) + " intent " +
                std::to_string(members_[c]->intent().number) + "/" + std::string(name_of(members_[c]->intent().kind));
      text += "\n";
    }
    for (const Violation& violation : observer.violations())
      text += "  " + std::string(name_of(violation.invariant)) + ": " + std::to_string(violation.participant) + " " +
              std::string(text_of(violation.finding)) + "\n";
    return text;
  }

  Observer observer;

 private:
  struct Heard {
    bool ever = false;
    std::uint32_t life = 0;
    std::uint16_t sequence = 0;
    /// False if the message was overtaken by one of the same life.
    bool take(std::uint32_t of, std::uint16_t number) {
      if (ever && life == of && static_cast<std::int16_t>(number - sequence) < 0) return false;
      ever = true, life = of, sequence = number;
      return true;
    }
  };

  Config config(std::size_t index, std::uint32_t incarnation) const {
    return {Variant::robust,
            index == 0 ? Role::master : Role::slave,
            static_cast<std::uint8_t>(index),
            static_cast<std::uint8_t>(roles_.size()),
            incarnation,
            Subscription::star,
            false};
  }

  void deliver_to_master(const RoleMessage& message) {
    const std::size_t c = message.from - 1;
    if (message.kind == RoleMessage::Kind::Announcement) {
      if (heard_announcement_[c].take(message.announcement.life, message.sequence)) {
        announced_[c] = message.announcement;
        binder_.announced(static_cast<std::uint8_t>(c), message.announcement);
      }
      settle();
      return;
    }
    const std::size_t role = message.sender - std::size_t{1};
    const Binding& binding = binder_.binding(role);
    if (!binding.bound() || incarnation_of(binding.candidate, binding.life) != message.word.incarnation) return;
    const bool ignored = step_master(Input::received(role, message.word, message.sequence)).ignored;
    if (message.sent_in != 0 && !ignored && master_.process_data_counts(role))
      observer.on_process_data(message.sender, 0, message.sent_in);
    settle();
  }

  void deliver_to_candidate(const RoleMessage& message, std::size_t c) {
    if (message.kind == RoleMessage::Kind::Table) {
      if (!heard_table_[c].take(message.word.incarnation, message.sequence)) return;
      const Candidate::Change change = candidates_[c].table(message.table, message.used_life);
      if (change == Candidate::Change::released) drop_member(c);
      if (change == Candidate::Change::bound) {
        members_[c].emplace(config(*candidates_[c].role() + std::size_t{1}, candidates_[c].incarnation()));
        pending_[c + 1].reset();
      }
      return;
    }
    if (!members_[c]) return;
    const bool ignored = step_member(c, Input::received(0, message.word, message.sequence)).ignored;
    if (message.sent_in != 0 && !ignored && members_[c]->process_data_counts(0) && is_seen(c))
      observer.on_process_data(0, members_[c]->config().index, message.sent_in);
  }

  Outputs step_master(const Input& input) {
    const Outputs outputs = master_.step(input);
    observer.on_step(0, outputs, master_.word());
    if (outputs.begin_initialisation) pending_[0] = outputs.initialisation_run;
    return outputs;
  }
  /// Who has been let go and does not know yet is nobody's participant: the observer does not look at it.
  Outputs step_member(std::size_t c, const Input& input) {
    const Outputs outputs = members_[c]->step(input);
    if (role_observer(c).on_step(binding_of(c), members_[c]->state()))
      observer.on_step(members_[c]->config().index, outputs, members_[c]->word());
    if (outputs.begin_initialisation) pending_[c + 1] = outputs.initialisation_run;
    return outputs;
  }
  void drop_member(std::size_t c) {
    if (members_[c] && role_observer(c).on_dropped(binding_of(c))) observer.on_restart(members_[c]->config().index);
    members_[c].reset();
    pending_[c + 1].reset();
  }
  Binding binding_of(std::size_t c) const { return {static_cast<std::uint8_t>(c), candidates_[c].announcement().life}; }
  RoleObserver& role_observer(std::size_t c) { return role_observers_[members_[c]->config().index - std::size_t{1}]; }
  bool is_seen(std::size_t c) { return members_[c] && role_observer(c).counts(binding_of(c)); }
  void settle() {
    while (const auto input = binder_.next(master_view_of(master_))) {
      step_master(*input);
      if (input->kind != Input::Kind::peer_replaced) continue;
      const Binding& bound = binder_.binding(input->peer);
      const PublishedState before =
          bound.bound() && members_[bound.candidate] ? members_[bound.candidate]->state() : PublishedState::Halted;
      if (role_observers_[input->peer].on_bound(bound, before).is_new)
        observer.on_restart(input->peer + std::size_t{1});
    }
  }

  /// Whether the binder means to start the group again: it would, if everybody were there and Halted.
  bool wants_restart() const {
    Binder binder = binder_;
    static_cast<void>(binder.next({}));
    for (std::uint8_t c = 0; c < offers_.size(); ++c) {
      Announcement announcement = candidates_[c].announcement();
      announcement.life = next_life(std::max(announcement.life, binder.used_life(c)));
      announcement.leaving = false;
      binder.announced(c, announcement);
    }
    for (int step = 0; step < 16; ++step) {
      const auto input = binder.next({PublishedState::Halted, false, ~PeerSet{0}});
      if (!input) return false;
      if (input->kind == Input::Kind::command) return true;
    }
    return false;
  }

  std::vector<SkillId> roles_;
  std::vector<std::vector<SkillId>> offers_;
  bool restarts_;
  std::uint32_t incarnation_ = 1;
  Member master_;
  Binder binder_;
  std::vector<Candidate> candidates_;
  std::vector<std::optional<Member>> members_;  // by candidate
  std::vector<RoleObserver> role_observers_;
  std::vector<std::uint16_t> sequence_;                 // by station
  std::vector<Heard> heard_announcement_;               // at the master, by candidate
  std::vector<std::optional<Announcement>> announced_;  // at the master, by candidate: what the binder goes by
  std::vector<Heard> heard_table_;                      // by candidate
  std::vector<std::optional<std::uint32_t>> pending_;   // by station: the run that is being initialised
};

inline std::uint64_t RoleGroup::hash() const {
  std::uint64_t digest = observer.hash();
  const auto mix = [&digest](std::uint64_t value) {
    digest = (digest ^ value) * 0x9E3779B97F4A7C15ULL;
    digest ^= digest >> 31;
  };
  const auto mix_announcement = [&](const Announcement& announcement) {
    mix(std::uint64_t{announcement.life} << 1 | (announcement.leaving ? 1 : 0));
  };
  const auto mix_binding = [&](const Binding& binding) { mix(std::uint64_t{binding.candidate} << 32 | binding.life); };
  const auto mix_heard = [&](const Heard& heard) { mix(std::uint64_t{heard.life} << 1 | (heard.ever ? 1 : 0)); };
  mix(master_.hash());
  mix(incarnation_);
  mix(wants_restart() ? 1 : 0);
  for (std::size_t role = 0; role < roles(); ++role) {
    mix_binding(binder_.binding(role));
    mix_binding(role_observers_[role].binding());
    mix(role_observers_[role].is_awaited() ? 1 : 0);
  }
  for (std::uint8_t c = 0; c < offers_.size(); ++c) {
    mix_announcement(candidates_[c].announcement());
    mix((candidates_[c].announces() ? 1U : 0U) | (candidates_[c].role() ? 2U + *candidates_[c].role() * 4U : 0U));
    mix(members_[c] ? members_[c]->hash() : 0);
    mix(binder_.used_life(c));
    mix(announced_[c] ? 1 : 0);
    if (announced_[c]) mix_announcement(*announced_[c]);
    mix_heard(heard_announcement_[c]);
    mix_heard(heard_table_[c]);
  }
  for (const std::optional<std::uint32_t>& run : pending_) mix(run ? std::uint64_t{*run} + 1 : 0);
  return digest;
}

}  // namespace takt::handshake
