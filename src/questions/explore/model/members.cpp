// SPDX-License-Identifier: Apache-2.0
#include "explore/model/members.hpp"

#include <algorithm>

#include "explore/model/wiring.hpp"
#include "sim/check.hpp"

namespace takt::explore {

using handshake::Input;
using handshake::Outputs;
using handshake::PublishedState;
using handshake::StateChange;
using handshake::Variant;
using handshake::Word;

bool are_transitions(PublishedState from, std::span<const StateChange> changes) {
  for (const StateChange& change : changes) {
    if (change.from != from || !handshake::is_transition(change)) return false;
    from = change.to;
  }
  return true;
}

Members::Members(const Query& query, const Renamings& renamings) : query_(query), renamings_(&renamings) {
  words_.append(Letter{});  // no_word
  renamed_word_.assign(renamings.size(), no_word);
  word_orbit_.push_back(0);
  rank_.push_back(0);
  effects_.intern(Effect{});  // nothing
}

handshake::Config Members::config(std::size_t index, std::uint32_t incarnation) const {
  return {query_.variant,
          index == 0 ? handshake::Role::master : handshake::Role::slave,
          static_cast<std::uint8_t>(index),
          query_.slaves,
          incarnation,
          query_.subscription};
}

MemberId Members::fresh(std::size_t index, std::uint32_t incarnation) {
  return intern(Participant(config(index, incarnation)));
}

MemberId Members::down(std::size_t index, std::uint32_t incarnation) {
  while (down_.size() <= incarnation) {
    std::vector<MemberId> all;
    for (std::size_t i = 0; i <= query_.slaves; ++i) {
      all.push_back(values_.append(Participant(config(i, static_cast<std::uint32_t>(down_.size())))));
      add_traits(all.back());
      traits_.back().down = true;
      traits_.back().calls = 0;
    }
    for (const MemberId member : all) {
      std::vector<MemberId> images;
      for (std::size_t r = 0; r < renamings_->size(); ++r)
        images.push_back(all[(*renamings_)[r].to[traits_[member].index]]);
      add_images(images);
    }
    down_.push_back(all);
  }
  return down_[incarnation][index];
}

Stepped Members::step_anew(MemberId member, const Stimulus& stimulus) {
  const Stepped stepped = step_value(member, stimulus);
  steps_.insert(key_of(member, stimulus), pack(stepped));
  compare_under_other_names(member, stimulus, stepped);
  return stepped;
}

/// Of two intents that differ in their origin the greater wins, whatever the names were: that changes words but not
/// what anybody does, and is no effect.
void Members::compare_under_other_names(MemberId member, const Stimulus& stimulus, const Stepped& stepped) {
  const std::size_t participant = traits_[member].index;
  for (std::size_t r = 1; r < renamings_->size(); ++r) {
    const MemberId other = renamed(member, r);
    const Stimulus there = renamed_stimulus(stimulus, participant, r);
    if (steps_.find(key_of(other, there)) != Memo::absent) continue;
    const Stepped same = step_value(other, there);
    steps_.insert(key_of(other, there), pack(same));
    if (same.effect != stepped.effect || same.data_counts != stepped.data_counts) symmetric_ = false;
  }
}

Stepped Members::step_value(MemberId member, const Stimulus& stimulus) {
  const Participant before = values_[member];
  Participant after = before;
  const Input input =
      input_of(stimulus.kind, stimulus.what, words_[stimulus.word], stimulus.overtaken, before.intent().run);
  const Outputs outputs = after.step(input);
  after.forget_last_transition();
  Effect effect = effect_of(before.word(), after.word(), outputs);
  effect.properties.bits |= judged(input, outputs, before.state(), after).bits;
  effect.raised = outputs.raised && query_.variant == Variant::paper;  // `robust` says it in the words
  if (effect.raised) effect.kind = outputs.raised_kind;
  Stepped stepped;
  stepped.member = intern(after);
  stepped.data_counts = data_counts(input, outputs, after);
  const std::uint32_t id = effects_.intern(effect);
  TAKT_CHECK(id <= 0xFFFF, "a step has few effects");
  stepped.effect = static_cast<std::uint16_t>(id);
  return stepped;
}

Input input_of(Input::Kind kind, std::size_t what, const Letter& letter, bool overtaken, std::uint32_t run) {
  switch (kind) {
    case Input::Kind::command:
      return Input::command(program::methods[what].method);
    case Input::Kind::received:
      return Input::received(what, letter.word,
                             letter.ahead ? sequence_ahead
                             : overtaken  ? overtaken_sequence
                                          : usual_sequence);
    case Input::Kind::initialised:
      return Input::initialised(run);
    case Input::Kind::finished:
      return Input::finished();
    case Input::Kind::peer_silent:
      return Input::peer_silent(what);
    case Input::Kind::released:
    case Input::Kind::peer_replaced:
    case Input::Kind::peer_left:
      break;  // of the node itself, and of changing members
  }
  return Input::finished();
}

Stimulus Members::renamed_stimulus(const Stimulus& stimulus, std::size_t participant, std::size_t renaming) const {
  Stimulus result = stimulus;
  const std::array<std::uint8_t, most_participants>& to = (*renamings_)[renaming].to;
  const bool has_peer = stimulus.kind == Input::Kind::received || stimulus.kind == Input::Kind::peer_silent;
  if (has_peer) {
    const std::uint8_t other = to[peer_participant(participant, stimulus.what)];
    result.what = static_cast<std::uint8_t>(other < to[participant] ? other : other - 1);
  }
  result.word = renamed_word(stimulus.word, renaming);
  return result;
}

Effect effect_of(const Word& before, const Word& after, const Outputs& outputs) {
  Effect effect;
  effect.change_count = outputs.change_count;
  for (std::size_t i = 0; i < outputs.change_count; ++i) {
    effect.change[i] = outputs.change[i];
    if (outputs.change[i].transition != 0) effect.properties.insert(transition_property(outputs.change[i].transition));
  }
  effect.joins =
      before.state == PublishedState::Ready && after.state == PublishedState::Ready && before.run != after.run;
  if (effect.change_count != 0 || effect.joins) effect.run = after.run;
  if (!are_transitions(before.state, outputs.changes())) effect.properties.insert(Property::S5);
  return effect;
}

PropertySet judged(const Input& input, const Outputs& outputs, PublishedState before, const Participant& after) {
  PropertySet seen;
  if (input.kind == Input::Kind::peer_silent) {
    if (before != PublishedState::Halted) seen.insert(Property::silence);
    if (after.state() != PublishedState::Halted) seen.insert(Property::F1);
  }
  const bool robust = after.config().variant == Variant::robust;
  if (robust && data_counts(input, outputs, after) && input.word.run != after.run()) seen.insert(Property::S3);
  return seen;
}

bool data_counts(const Input& input, const Outputs& outputs, const Participant& after) {
  return input.kind == Input::Kind::received && !outputs.ignored && input.word.state == PublishedState::Running &&
         after.process_data_counts(input.peer);
}

MemberId Members::intern(const Participant& value) {
  const MemberId member = values_.intern(value);
  if (member < traits_.size()) return member;
  std::vector<MemberId> images;
  for (std::size_t r = 0; r < renamings_->size(); ++r) {
    images.push_back(values_.intern(value.renamed((*renamings_)[r].to)));
    if (images.back() == traits_.size()) add_traits(images.back());
  }
  add_images(images);
  return member;
}

/// What it accepts is tried once, so that the search asks for nothing in vain.
void Members::add_traits(MemberId member) {
  const Participant value = values_[member];
  Traits traits;
  traits.word = intern_word({value.word(), false});
  traits.state = value.state();
  traits.index = value.config().index;
  for (const program::MethodInfo& method : program::methods) {
    // The paper lets everybody be started; the adversary calls Start at the master only, as `robust` allows.
    if (method.method == program::Method::Start && traits.index != 0) continue;
    Participant tried = value;
    if (program::is_good(tried.step(Input::command(method.method)).status))
      traits.calls = static_cast<std::uint8_t>(traits.calls | 1U << program::index_of(method.method));
  }
  for (std::size_t peer = 0; peer < value.peer_count(); ++peer)
    if (value.has_heard_beyond(peer, usual_sequence)) traits.deaf = static_cast<std::uint8_t>(traits.deaf | 1U << peer);
  traits_.push_back(traits);
}

const std::vector<WordId>& Members::forged(MemberId member) {
  if (forged_.size() <= member) forged_.resize(values_.size());
  if (forged_[member].empty())
    for (const Letter& letter : forgeries(values_[member].word(), query_.slaves))
      forged_[member].push_back(intern_word(letter));
  return forged_[member];
}

/// images[r] is what the first of them is under renaming r.
void Members::add_images(const std::vector<MemberId>& images) {
  const std::size_t count = renamings_->size();
  renamed_.resize(traits_.size() * count);
  for (std::size_t r = 0; r < count; ++r) {
    traits_[images[r]].orbit = *std::min_element(images.begin(), images.end());
    for (std::size_t s = 0; s < count; ++s) renamed_[images[r] * count + s] = images[renamings_->then(r, s)];
  }
}

WordId Members::intern_word(const Letter& letter) {
  const std::uint32_t id = words_.intern(letter);
  if (id < word_orbit_.size()) return static_cast<WordId>(id);
  const std::size_t count = renamings_->size();
  std::vector<std::uint32_t> images;
  for (std::size_t r = 0; r < count; ++r)
    images.push_back(words_.intern({explore::renamed(letter.word, (*renamings_)[r]), letter.ahead}));
  TAKT_CHECK(words_.size() <= 0x10000, "an exploration has at most 65535 different words: allow fewer calls or faults");
  renamed_word_.resize(words_.size() * count, no_word);
  word_orbit_.resize(words_.size(), 0);
  for (std::size_t i = rank_.size(); i < words_.size(); ++i) {
    const handshake::Intent& intent = words_[i].word.intent;
    rank_.push_back(intent.origin == 0
                        ? 0
                        : std::uint64_t{intent.number} << 16 | handshake::index_of(intent.kind) << 8 | intent.origin);
  }
  const std::uint32_t orbit = *std::min_element(images.begin(), images.end());
  for (std::size_t r = 0; r < count; ++r) {
    word_orbit_[images[r]] = orbit;
    for (std::size_t s = 0; s < count; ++s)
      renamed_word_[images[r] * count + s] = static_cast<WordId>(images[renamings_->then(r, s)]);
  }
  return static_cast<WordId>(id);
}

std::size_t HashOfWord::operator()(const Word& word) const {
  std::uint64_t digest = mixed(std::uint64_t{word.incarnation} << 32 | word.run);
  digest = mixed(digest ^ (std::uint64_t{word.intent.number} << 32 | word.intent.run));
  return mixed(digest ^ (handshake::index_of(word.state) | handshake::index_of(word.intent.kind) << 8 |
                         std::uint64_t{word.intent.origin} << 16));
}

std::size_t HashOfEffect::operator()(const Effect& effect) const {
  std::uint64_t digest = mixed(std::uint64_t{effect.run} << 32 | effect.properties.bits);
  for (const StateChange& change : effect.change)
    digest = mixed(digest ^
                   (change.transition | handshake::index_of(change.from) << 8 | handshake::index_of(change.to) << 16));
  digest = mixed(digest ^ (std::uint64_t{effect.started_run} << 32 | effect.outer_run));
  return mixed(digest ^ (effect.change_count | std::uint64_t{effect.joins} << 8 | std::uint64_t{effect.raised} << 9 |
                         handshake::index_of(effect.kind) << 16));
}

}  // namespace takt::explore
