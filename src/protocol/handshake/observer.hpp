// SPDX-License-Identifier: Apache-2.0
// The observer of a group, or of a tree of groups: sees every participant from outside and checks S1 to S5
// (invariants.hpp). No protocol code asks it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "handshake/group_tree.hpp"
#include "handshake/invariants.hpp"
#include "handshake/run_history.hpp"
#include "handshake/word.hpp"

namespace takt::handshake {

/// Storage of a RunHistory that has room for everybody and everything.
struct AnyStorage {
  class Set {
   public:
    explicit Set(std::size_t participants) : bits_((participants + 63) / 64) {}
    void insert(std::size_t i) { bits_[i / 64] |= std::uint64_t{1} << i % 64; }
    void erase(std::size_t i) { bits_[i / 64] &= ~(std::uint64_t{1} << i % 64); }
    bool contains(std::size_t i) const { return ((bits_[i / 64] >> i % 64) & 1U) != 0; }
    void add(const Set& other) {
      for (std::size_t w = 0; w < bits_.size(); ++w) bits_[w] |= other.bits_[w];
    }
    bool operator==(const Set&) const = default;
    template <class Mix>
    void hash_into(Mix&& mix) const {
      for (const std::uint64_t each : bits_) mix(each);
    }

   private:
    std::vector<std::uint64_t> bits_;
  };
  template <class T>
  using List = std::vector<T>;
};

/// A value: copied, compared and hashed with the participants it watches. Participants are numbered as the tree does;
/// in a single group participant 0 is the master.
class Observer {
 public:
  Observer(Variant variant, std::size_t participants) : Observer(variant, GroupTree(participants)) {}
  Observer(Variant variant, GroupTree tree);

  /// All changes of one step and the word after it. Enough by itself, besides restarts and process data.
  void on_step(std::size_t participant, const Outputs& outputs, const Word& after);
  void on_transition(std::size_t participant, StateChange change, const Word& after);
  /// The word has changed without a transition: in `robust` one that is Ready may join a new run so.
  void on_word(std::size_t participant, const Word& after);
  /// It is new: Halted, and it knows nothing.
  void on_restart(std::size_t participant);

  /// The run (`paper`: the number of rounds begun so far by anybody) in which a participant that is Running sends now;
  /// 0 if it is not Running. Goes with each process-data message.
  std::uint32_t sending_run(std::size_t participant) const;
  /// An application has been given process data that was sent when the sender's sending_run was `sent_in`.
  void on_process_data(std::size_t from, std::size_t to, std::uint32_t sent_in);

  const GroupTree& tree() const { return tree_; }
  /// In the order of their discovery.
  std::span<const Violation> violations() const { return violations_; }

  bool operator==(const Observer&) const = default;
  std::uint64_t hash() const;

 private:
  struct Seen {
    PublishedState state = PublishedState::Halted;
    std::uint32_t run = 0;        ///< `paper`: the number of its round, counted over all participants
    std::uint32_t asked_run = 0;  ///< of the intent that it follows
    bool operator==(const Seen&) const = default;
  };
  void report(Invariant invariant, Finding finding, std::size_t participant, bool of_tree = false);

  Variant variant_;
  GroupTree tree_;
  RunHistory<AnyStorage> history_;
  std::uint32_t rounds_ = 0;  ///< `paper` only
  std::vector<Seen> seen_;
  std::vector<Violation> violations_;
};

}  // namespace takt::handshake
