// SPDX-License-Identifier: Apache-2.0
// All participants that occur in an exploration, as numbers. A participant and what happens to it give another number
// and an effect; each such step is taken once by the very handshake code and then remembered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "explore/model/forgery.hpp"
#include "explore/model/hash_index.hpp"
#include "explore/model/query.hpp"
#include "explore/model/renaming.hpp"
#include "explore/properties/small_observer.hpp"
#include "handshake/participant.hpp"

namespace takt::explore {

using Participant = handshake::Participant<most_slaves>;
using MemberId = std::uint32_t;
using WordId = std::uint16_t;  ///< 0: no word
inline constexpr WordId no_word = 0;

/// What happens to a participant.
struct Stimulus {
  handshake::Input::Kind kind = handshake::Input::Kind::finished;
  std::uint8_t what = 0;  ///< method or peer
  WordId word = no_word;
  bool overtaken = false;  ///< the word is older than the last one that was accepted
};

struct Stepped {
  MemberId member = 0;
  std::uint16_t effect = 0;  ///< 0: nothing to see
  bool data_counts = false;  ///< process data in the message reaches the application
};

struct HashOfWord {
  std::size_t operator()(const handshake::Word& word) const;
};
struct HashOfLetter {
  std::size_t operator()(const Letter& letter) const { return HashOfWord{}(letter.word) + (letter.ahead ? 1 : 0); }
};
struct HashOfEffect {
  std::size_t operator()(const Effect& effect) const;
};

/// S5 as the observer judges it: the changes of a step follow each other and stand in the table.
bool are_transitions(handshake::PublishedState from, std::span<const handshake::StateChange> changes);

/// What a step means, but for what depends on the input. `before` and `after` are the participant's words.
Effect effect_of(const handshake::Word& before, const handshake::Word& after, const handshake::Outputs& outputs);
/// What the input and its outcome say of `silence`, F1 and S3 of `robust`. `before`: the state of the participant.
PropertySet judged(const handshake::Input& input, const handshake::Outputs& outputs, handshake::PublishedState before,
                   const Participant& after);
/// Process data in the message reaches the application.
bool data_counts(const handshake::Input& input, const handshake::Outputs& outputs, const Participant& after);
/// `run`: of the intent that it follows.
handshake::Input input_of(handshake::Input::Kind kind, std::size_t what, const Letter& letter, bool overtaken,
                          std::uint32_t run);

class Members {
 public:
  /// What the search asks most about a member.
  struct Traits {
    WordId word = no_word;  ///< what it publishes
    handshake::PublishedState state = handshake::PublishedState::Halted;
    std::uint8_t index = 0;
    bool down = false;
    std::uint8_t calls = 0;   ///< methods that it accepts, by index
    std::uint8_t deaf = 0;    ///< peers whose words it takes for old ones, bit i for peer i
    std::uint32_t orbit = 0;  ///< the same number for whoever differs in names only
  };

  Members(const Query& query, const Renamings& renamings);

  MemberId fresh(std::size_t index, std::uint32_t incarnation);
  /// One that is down; it remembers only how often it was up.
  MemberId down(std::size_t index, std::uint32_t incarnation);
  const Traits& operator[](MemberId member) const { return traits_[member]; }
  const Participant& value(MemberId member) const { return values_[member]; }
  std::uint32_t incarnation(MemberId member) const { return values_[member].config().incarnation; }
  std::size_t size() const { return traits_.size(); }

  Stepped step(MemberId member, const Stimulus& stimulus) {
    const std::uint64_t found = steps_.find(key_of(member, stimulus));
    return found != Memo::absent ? unpack(found) : step_anew(member, stimulus);
  }

  const handshake::Word& word(WordId word) const { return words_[word].word; }
  std::size_t word_count() const { return words_.size(); }
  std::uint32_t word_orbit(WordId word) const { return word_orbit_[word]; }
  /// Number, kind and (last octet) origin of its intent; 0 if the master is the origin. Of two that differ in the last
  /// octet only the greater depends on names.
  std::uint64_t rank(WordId word) const { return rank_[word]; }
  const Effect& effect(std::uint16_t effect) const { return effects_[effect]; }

  MemberId renamed(MemberId member, std::size_t renaming) const {
    return renamed_[member * renamings_->size() + renaming];
  }
  WordId renamed_word(WordId word, std::size_t renaming) const {
    return renamed_word_[word * renamings_->size() + renaming];
  }
  /// Calls seen(from, stimulus, to) for each step that is remembered.
  template <class Seen>
  void each_step(Seen&& seen) const {
    steps_.each([&](std::uint64_t key, std::uint64_t value) {
      seen(static_cast<MemberId>(key >> 32), stimulus_of(key), unpack(value).member);
    });
  }

  /// What a stranger may say as this one.
  const std::vector<WordId>& forged(MemberId member);

  /// False once a step did something else to slaves with other names: then they are not equal.
  bool symmetric() const { return symmetric_; }

 private:
  struct HashOfValue {
    std::size_t operator()(const Participant& value) const { return mixed(value.hash()); }
  };
  static std::uint64_t key_of(MemberId member, const Stimulus& stimulus) {
    return std::uint64_t{member} << 32 | static_cast<std::uint64_t>(stimulus.kind) << 28 |
           std::uint64_t{stimulus.what} << 20 | std::uint64_t{stimulus.word} << 1 | std::uint64_t{stimulus.overtaken};
  }
  static Stimulus stimulus_of(std::uint64_t key) {
    return {static_cast<handshake::Input::Kind>((key >> 28) & 0xFU), static_cast<std::uint8_t>(key >> 20),
            static_cast<WordId>(key >> 1), (key & 1U) != 0};
  }
  static std::uint64_t pack(const Stepped& stepped) {
    return std::uint64_t{stepped.member} | std::uint64_t{stepped.effect} << 32 |
           std::uint64_t{stepped.data_counts} << 48;
  }
  static Stepped unpack(std::uint64_t packed) {
    return {static_cast<MemberId>(packed), static_cast<std::uint16_t>(packed >> 32), ((packed >> 48) & 1U) != 0};
  }

  handshake::Config config(std::size_t index, std::uint32_t incarnation) const;
  Stimulus renamed_stimulus(const Stimulus& stimulus, std::size_t participant, std::size_t renaming) const;
  Stepped step_anew(MemberId member, const Stimulus& stimulus);
  Stepped step_value(MemberId member, const Stimulus& stimulus);
  void compare_under_other_names(MemberId member, const Stimulus& stimulus, const Stepped& stepped);
  MemberId intern(const Participant& value);
  void add_traits(MemberId member);
  void add_images(const std::vector<MemberId>& images);
  WordId intern_word(const Letter& letter);

  Query query_;
  const Renamings* renamings_;
  Interner<Participant, HashOfValue> values_;
  std::vector<Traits> traits_;
  std::vector<MemberId> renamed_;  ///< by member and renaming
  Interner<Letter, HashOfLetter> words_;
  std::vector<WordId> renamed_word_;
  std::vector<std::uint32_t> word_orbit_;
  std::vector<std::uint64_t> rank_;
  Interner<Effect, HashOfEffect> effects_;
  Memo steps_;
  std::vector<std::vector<MemberId>> down_;  ///< by incarnation and index
  std::vector<std::vector<WordId>> forged_;  ///< by member; empty: not asked yet
  bool symmetric_ = true;
};

}  // namespace takt::explore
