// SPDX-License-Identifier: Apache-2.0
// One participant of a distributed Program: step(input) -> outputs. Reads no clock, opens no socket, allocates nothing.
//
// Two variants of the handshake: `paper` (Fig. 3 to 6 of the paper, state only) and `robust` (agreement on intents).
// Their rules are in README.md, their code in paper.cpp and robust.cpp. The value can be copied, compared and hashed,
// so the simulator, the explorer and a real node host the same type.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "handshake/io.hpp"
#include "handshake/word.hpp"
#include "program/machine.hpp"
#include "sim/check.hpp"

namespace takt::handshake {

enum class Role : std::uint8_t { master, slave };
/// Who hears whom: the master all slaves and a slave the master, or everybody all others.
enum class Subscription : std::uint8_t { star, all_to_all };

struct Config {
  Variant variant = Variant::robust;
  Role role = Role::master;
  std::uint8_t index = 0;                          ///< among the participants: 0 the master, 1..slaves
  std::uint8_t slaves = 1;                         ///< of the group, at least 1
  std::uint32_t incarnation = 0;                   ///< another one after each restart; `paper` does not publish it
  Subscription subscription = Subscription::star;  ///< the same for all of the group
  /// Joined to another group on this node, in which it has the other role (coupling.hpp). `robust` only.
  bool nested = false;
  constexpr bool operator==(const Config&) const = default;
};

/// MaxPeers bounds the peers, whose words it listens to: in a star all slaves for the master, the master for a slave;
/// else all others.
template <std::size_t MaxPeers>
class Participant {
  static_assert(MaxPeers >= 1 && MaxPeers <= 64, "a PeerSet has 64 bits");

 public:
  /// A participant that has just been switched on (or restarted): Halted, knows no intent, has heard nobody.
  explicit Participant(const Config& config);

  Outputs step(const Input& input);
  /// The same without the short cuts that most words take, for tests of these.
  Outputs step_at_length(const Input& input);

  const Config& config() const { return config_; }
  PublishedState state() const { return published_state(machine_); }
  const program::Machine& machine() const { return machine_; }
  /// The run in which it is or was Ready; 0 if none, and always 0 in `paper`.
  std::uint32_t run() const { return run_; }
  const Intent& intent() const { return intent_; }
  /// What it publishes now.
  Word word() const {
    return config_.variant == Variant::paper ? Word{0, state(), Intent{}, 0}
                                             : Word{config_.incarnation, state(), intent_, run_};
  }

  std::size_t peer_count() const {
    return is_master() || config_.subscription == Subscription::all_to_all ? config_.slaves : 1;
  }
  /// The participant that a peer index stands for, and back: they are in the same order. Peer 0 of a slave is the
  /// master.
  std::size_t participant_of(std::size_t peer) const { return peer < config_.index ? peer : peer + 1; }
  std::size_t peer_of(std::size_t participant) const {
    return participant < config_.index ? participant : participant - 1;
  }

  /// S3: process data of this peer may reach the application now, as far as is known here: both are Running, and in
  /// `robust` in the same run. Ask after the step with the word that came in the same message, and not if it was
  /// ignored.
  bool process_data_counts(std::size_t peer) const;
  /// The same for process data that carries the run of its sender by itself (a message without a word). Not for
  /// `paper`.
  bool process_data_counts(std::size_t peer, std::uint32_t sender_run) const;

  /// The same participant in a group whose participants have other indices: `to[i]` is the new index of participant i.
  /// A permutation of 0 to slaves, which leaves the master 0. Its own index, the origin of its intent and the order of
  /// its peers change, nothing else; a search uses it to see slaves that play the same part as equal.
  Participant renamed(std::span<const std::uint8_t> to) const;
  /// As if no transition had been taken yet: no later step depends on the last one, so a search need not tell such
  /// values apart.
  void forget_last_transition() { machine_.forget_last_transition(); }
  /// Master: all slaves are Ready in the run that is being started.
  bool peers_ready() const { return intent_.kind == IntentKind::Start && ready_ == all_peers(); }
  /// Slave: Ready in the run that is being started, and the master is so too.
  bool may_run() const;
  /// A Suspend would be accepted here now. Not for `paper`.
  bool may_suspend() const { return robust_may_suspend(); }
  /// Master: a Start would be accepted here now. Not for `paper`.
  bool may_start() const { return robust_may_start(); }
  /// Master: the initialisation for the run that is being started has ended, but not all slaves are Ready.
  bool waits_initialised() const { return initialised_; }
  /// The last word heard of a peer said so; false if it was never heard.
  bool peer_heard_in(std::size_t peer, PublishedState state) const {
    return peers_[peer].heard && peers_[peer].state == state;
  }

  /// What counts here of a peer: what its last accepted word said. One that was never heard counts as Halted; `paper`
  /// does not remember whether it was.
  struct Known {
    std::uint32_t incarnation = 0;
    std::uint32_t run = 0;
    PublishedState state = PublishedState::Halted;
    bool heard = false;
    constexpr bool operator==(const Known&) const = default;
  };
  Known known_of(std::size_t peer) const {
    return {peers_[peer].incarnation, peers_[peer].run, peers_[peer].state, peers_[peer].heard};
  }

  /// What is remembered of the last accepted word of a peer.
  struct Peer {
    std::uint32_t incarnation = 0;
    std::uint32_t run = 0;
    std::uint16_t sequence = 0;
    PublishedState state = PublishedState::Halted;
    bool heard = false;           ///< ever
    bool sequence_known = false;  ///< false after silence: then any sequence number is the first
    bool operator==(const Peer&) const = default;
  };
  /// All that a participant keeps of one peer.
  struct PeerPart {
    Peer peer;
    bool ready = false;    ///< it counts as Ready in the run of the intent here
    bool running = false;  ///< likewise
    bool operator==(const PeerPart&) const = default;
  };
  PeerPart part_of(std::size_t peer) const;
  /// The same participant in a group in which it has these peers and no others. A search for groups of any size keeps
  /// what the master knows of a slave with that slave's own state, and puts both together for a step.
  Participant with_parts(std::span<const PeerPart> parts) const;

  /// A word of the peer's incarnation with this sequence number would be ignored, because a later number was heard.
  bool has_heard_beyond(std::size_t peer, std::uint16_t sequence) const;

  bool operator==(const Participant&) const = default;
  /// Equal values have equal hashes; the same on every machine.
  std::uint64_t hash() const;

 private:
  enum class Freshness : std::uint8_t { stale, fresh, restarted };

  bool is_master() const { return config_.role == Role::master; }
  PeerSet all_peers() const { return ~PeerSet{0} >> (64 - peer_count()); }

  // participant.cpp: shared by both variants
  Outputs take(const Input& input);
  /// After a step. What was said before it was valid, and so is an intent that was adopted.
  void check_word(const Outputs& outputs) const {
    if (!outputs.publish || config_.variant == Variant::paper) return;
    TAKT_CHECK(may_hold(intent_, state(), run_), "a participant is what its intent says");
    TAKT_CHECK(!outputs.raised || is_valid(intent_, config_.slaves), "an intent that is raised can be");
  }
  void move_to(PublishedState target, Outputs& outputs);
  void enter_init(Outputs& outputs);
  void initialised(std::uint32_t run, Outputs& outputs);
  void finished(bool coupled, Outputs& outputs);
  void record(std::uint8_t transition, PublishedState from, Outputs& outputs);
  /// Keeps ready_ and running_ true for one peer whose word has changed.
  void sort_peer(std::size_t peer) {
    const PeerSet counts = peers_[peer].run == intent_.run ? 1 : 0;  // `paper`: both are always 0
    const PeerSet others = ~(PeerSet{1} << peer);
    ready_ = (ready_ & others) | (peers_[peer].state == PublishedState::Ready ? counts : 0) << peer;
    running_ = (running_ & others) | (peers_[peer].state == PublishedState::Running ? counts : 0) << peer;
  }
  void sort_all_peers();

  // robust.cpp
  void robust_command(program::Method method, Outputs& outputs);
  void robust_received(const Input& input, Outputs& outputs);
  bool robust_is_next(const Input& input) const;
  bool robust_says_nothing_new(const Input& input) const;
  Outputs robust_follow(const Input& input);
  Outputs robust_take_note(const Input& input);
  Outputs robust_hear(const Input& input);
  void robust_silent(std::size_t peer, Outputs& outputs);
  bool robust_may_start() const;
  bool robust_may_suspend() const;
  Freshness note_word(Peer& peer, const Word& word, std::uint16_t sequence);
  bool supersedes(const Intent& intent, std::size_t peer) const;
  void raise(IntentKind kind, std::uint32_t above, Outputs& outputs);
  void raise_alarm(Alarm alarm, std::uint32_t above, Outputs& outputs);
  void adopt(const Intent& intent, Outputs& outputs);
  bool counted_without_me(std::size_t peer, const Word& word) const;
  bool ran_without_me(const Word& word) const;
  void robust_barrier(Outputs& outputs);
  /// Anywhere else robust_barrier() does nothing: who is Running has it behind it.
  bool is_in_barrier() const {
    return intent_.kind == IntentKind::Start && machine_.state() != program::State::Running;
  }

  // paper.cpp
  void paper_command(program::Method method, Outputs& outputs);
  void paper_received(const Input& input, Outputs& outputs);
  void paper_barrier(Outputs& outputs);

  Config config_;
  program::Machine machine_;
  bool initialised_ = false;  ///< INIT: the local initialisation has ended, the barrier has not
  std::uint32_t run_ = 0;
  Intent intent_;
  PeerSet ready_ = 0;    ///< peers last heard Ready (`robust`: in the run of intent_)
  PeerSet running_ = 0;  ///< peers last heard Running (`robust`: in the run of intent_)
  std::array<Peer, MaxPeers> peers_{};
};

// Participant<4> (small groups, exploration) and Participant<64> are instantiated in the .cpp files.
static_assert(std::is_trivially_copyable_v<Participant<4>>);

}  // namespace takt::handshake
