// SPDX-License-Identifier: Apache-2.0
#include "explain/reaction_chain.hpp"

#include <algorithm>

namespace takt::explain {
namespace {

using sim::Duration;
using sim::TrueTime;

class Chain {
 public:
  Chain(const scenario::Run& run, std::span<const Arrival> arrivals, const handshake::Reaction& reaction)
      : run_(run), resolved_(run.resolved()), arrivals_(arrivals), reaction_(reaction) {}

  /// From the last participant back to the cause.
  std::vector<ChainLink> make(const std::vector<std::size_t>& programs) {
    std::optional<Participant> at = last_of(programs);
    TrueTime time = reaction_.completed;
    while (at && time > reaction_.began) {
      if (const std::optional<Word> word = word_that_moved(*at, time)) {
        if (word->came < time) links_.push_back({ChainLink::Kind::opening, *at, {}, {}, word->came, time});
        links_.push_back({ChainLink::Kind::message, word->from, *at, word->stream, word->published, word->came});
        links_.push_back({ChainLink::Kind::publication, word->from, {}, word->stream, word->changed, word->published});
        time = word->changed;
        at = word->from;
        continue;
      }
      const std::optional<TrueTime> before = last_change(*at, time, false);
      links_.push_back({before ? ChainLink::Kind::initialisation : ChainLink::Kind::beginning,
                        *at,
                        {},
                        {},
                        before.value_or(reaction_.began),
                        time});
      time = links_.back().begin;
    }
    if (time > reaction_.began)
      links_.push_back(
          {ChainLink::Kind::beginning, at.value_or(Participant{programs.front(), 0}), {}, {}, reaction_.began, time});
    std::reverse(links_.begin(), links_.end());
    return std::move(links_);
  }

 private:
  struct Word {
    Participant from;
    models::StreamIndex stream;
    TrueTime changed;  // of the word, at its participant
    TrueTime published;
    TrueTime came;  // to the host of whom it moved; heard when it was opened
  };

  models::NodeIndex node_of(const Participant& who) const {
    return resolved_.programs[who.program].members[who.number].node;
  }

  std::optional<Participant> last_of(const std::vector<std::size_t>& programs) const {
    for (const std::size_t p : programs)
      for (const scenario::StateRecord& record : run_.monitor(p).history())
        if (record.time == reaction_.completed) return Participant{p, record.participant};
    return std::nullopt;
  }

  /// The last change of the participant before an instant (or at it), within the reaction.
  std::optional<TrueTime> last_change(const Participant& who, TrueTime time, bool may_be_then) const {
    std::optional<TrueTime> last;
    for (const scenario::StateRecord& record : run_.monitor(who.program).history())
      if (record.participant == who.number && record.time >= reaction_.began &&
          (record.time < time || (may_be_then && record.time == time)))
        last = record.time;
    return last;
  }

  std::span<const Arrival>::iterator first_at(TrueTime time) const {
    return std::lower_bound(arrivals_.begin(), arrivals_.end(), time,
                            [](const Arrival& each, TrueTime t) { return each.at < t; });
  }

  /// What it takes the node to open a message of that program; nobody of whom is there hears it at once.
  Duration opening(std::size_t program, models::NodeIndex node) const {
    const auto& members = resolved_.programs[program].members;
    const auto member = std::ranges::find(members, node, &scenario::ResolvedMember::node);
    return member == members.end() ? Duration() : member->open;
  }

  /// Of the words that the node heard at that instant, in any of its groups, the one that followed from the latest
  /// change.
  std::optional<Word> word_that_moved(const Participant& who, TrueTime time) const {
    std::optional<Word> latest;
    for (std::size_t p = 0; p < resolved_.programs.size(); ++p) {
      if (resolved_.programs[p].has_roles()) continue;
      const std::vector<scenario::ResolvedMember>& members = resolved_.programs[p].members;
      const TrueTime came = time + -opening(p, node_of(who));
      for (auto arrival = first_at(came); arrival != arrivals_.end() && arrival->at == came; ++arrival) {
        if (arrival->listener != node_of(who)) continue;
        const auto member = std::ranges::find(members, arrival->stream, &scenario::ResolvedMember::state);
        if (member == members.end()) continue;
        const Participant from{p, static_cast<std::size_t>(member - members.begin())};
        const std::optional<TrueTime> changed = last_change(from, arrival->produced, true);
        if (changed && is_news(*arrival, *changed) && (!latest || *changed > latest->changed))
          latest = Word{from, arrival->stream, *changed, arrival->produced, came};
      }
    }
    return latest;
  }

  /// What has been heard before moves nobody: then it was the participant's own timer, or another word.
  bool is_news(const Arrival& word, TrueTime changed) const {
    for (auto each = first_at(changed); each != arrivals_.end() && each->at < word.at; ++each)
      if (each->stream == word.stream && each->listener == word.listener && each->produced >= changed) return false;
    return true;
  }

  const scenario::Run& run_;
  const scenario::Resolved& resolved_;
  std::span<const Arrival> arrivals_;
  const handshake::Reaction& reaction_;
  std::vector<ChainLink> links_;
};

}  // namespace

FoundReaction find_reaction(const scenario::Run& run, const scenario::AskedReaction& asked, TrueTime from,
                            std::optional<Duration> took) {
  FoundReaction found;
  const auto look = [&](std::span<const handshake::Reaction> reactions, const std::vector<std::size_t>& programs) {
    for (const handshake::Reaction& each : reactions) {
      if (each.outcome != handshake::ReactionOutcome::completed ||
          handshake::name_of(each.kind) != scenario::spelling(asked.kind) || each.began < from ||
          (asked.cause && each.cause != *asked.cause))
        continue;
      const Duration lasted = each.completed - each.began;
      const bool is_better =
          found.reaction == nullptr || (!took && lasted > found.reaction->completed - found.reaction->began);
      if (is_better && (!took || lasted == *took)) found = {&each, programs};
    }
  };
  const auto is_meant = [&](std::size_t program) {
    return !asked.program || run.resolved().programs[program].name == *asked.program;
  };
  if (asked.of_tree) {
    for (const auto& tree : run.trees())
      if (is_meant(tree->programs().front()))
        look(tree->reactions(), {tree->programs().begin(), tree->programs().end()});
    return found;
  }
  for (std::size_t p = 0; p < run.resolved().programs.size(); ++p)
    if (is_meant(p) && !run.resolved().programs[p].has_roles()) look(run.monitor(p).reactions(), {p});
  return found;
}

std::vector<ChainLink> chain_of(const scenario::Run& run, std::span<const Arrival> arrivals,
                                const FoundReaction& found) {
  return Chain(run, arrivals, *found.reaction).make(found.programs);
}

const std::string& name_of(const scenario::Resolved& resolved, const Participant& who) {
  return resolved.programs[who.program].participant_names[who.number];
}

std::vector<bool> streams_of_words(const scenario::Resolved& resolved) {
  std::vector<bool> words(resolved.plan.streams.size());
  for (const scenario::ResolvedProgram& program : resolved.programs)
    for (const scenario::ResolvedMember& each : program.participants()) words[each.state.value] = true;
  return words;
}

}  // namespace takt::explain
