#include "verify/reaction_chain.hpp"

#include <algorithm>
#include <span>

namespace takt::verify {
namespace {

using sim::Duration;
using sim::TrueTime;

struct Participant {
  std::size_t program = 0;
  std::size_t number = 0;
};

class Chain {
 public:
  Chain(const scenario::Run& run, const FrameLog& log, const analysis::Bounds& bounds, const handshake::Reaction& reaction)
      : run_(run), resolved_(run.resolved()), log_(log), bounds_(bounds), reaction_(reaction) {}

  /// From the last participant back to the cause.
  std::vector<SlackPart> make(const std::vector<std::size_t>& programs) {
    std::optional<Participant> at = last_of(programs);
    TrueTime time = reaction_.completed;
    while (at && time > reaction_.began) {
      if (const std::optional<Word> word = word_that_moved(*at, time)) {
        add_word(*word, *at, time);
        time = word->changed;
        at = word->from;
        continue;
      }
      const std::optional<TrueTime> before = change_before(*at, time);
      const std::string& name = name_of(*at);
      if (before) {
        parts_.push_back({name, "INIT", bounds_.participants[at->program][at->number].initialise.value_or(Duration()), time - *before});
        time = *before;
      } else {
        add_beginning(name, time);
        time = reaction_.began;
      }
    }
    if (time > reaction_.began) add_beginning("the group", time);
    std::reverse(parts_.begin(), parts_.end());
    return std::move(parts_);
  }

 private:
  struct Word {
    Participant from;
    models::StreamIndex stream;
    TrueTime changed;      // of the word, at its participant
    TrueTime published;
  };

  const std::string& name_of(const Participant& who) const { return resolved_.programs[who.program].participant_names[who.number]; }
  models::NodeIndex node_of(const Participant& who) const { return resolved_.programs[who.program].members[who.number].node; }

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
      if (record.participant == who.number && record.time >= reaction_.began && (record.time < time || (may_be_then && record.time == time))) last = record.time;
    return last;
  }
  std::optional<TrueTime> change_before(const Participant& who, TrueTime time) const { return last_change(who, time, false); }

  /// Of the words that came to the node at that instant, in any of its groups, the one that followed from the latest change.
  std::optional<Word> word_that_moved(const Participant& who, TrueTime time) const {
    std::optional<Word> latest;
    const auto first = std::lower_bound(log_.arrivals().begin(), log_.arrivals().end(), time, [](const Arrival& each, TrueTime t) { return each.at < t; });
    for (auto arrival = first; arrival != log_.arrivals().end() && arrival->at == time; ++arrival) {
      if (arrival->listener != node_of(who)) continue;
      for (std::size_t p = 0; p < resolved_.programs.size(); ++p) {
        const std::vector<scenario::ResolvedMember>& members = resolved_.programs[p].members;
        const auto member = std::ranges::find(members, arrival->stream, &scenario::ResolvedMember::state);
        if (resolved_.programs[p].has_roles() || member == members.end()) continue;
        const Participant from{p, static_cast<std::size_t>(member - members.begin())};
        const std::optional<TrueTime> changed = last_change(from, arrival->produced, true);
        if (changed && is_news(*arrival, *changed) && (!latest || *changed > latest->changed)) latest = Word{from, arrival->stream, *changed, arrival->produced};
      }
    }
    return latest;
  }

  /// What has been heard before moves nobody: then it was the participant's own timer, or another word.
  bool is_news(const Arrival& word, TrueTime changed) const {
    auto each = std::lower_bound(log_.arrivals().begin(), log_.arrivals().end(), changed, [](const Arrival& arrival, TrueTime t) { return arrival.at < t; });
    for (; each != log_.arrivals().end() && each->at < word.at; ++each)
      if (each->stream == word.stream && each->listener == word.listener && each->produced >= changed) return false;
    return true;
  }

  void add_word(const Word& word, const Participant& to, TrueTime time) {
    const std::string& from = name_of(word.from);
    const std::vector<models::NodeIndex>& listeners = resolved_.plan.streams[word.stream.value].listeners;
    const auto listener = static_cast<std::size_t>(std::find(listeners.begin(), listeners.end(), node_of(to)) - listeners.begin());
    const std::optional<Duration>& latency = bounds_.streams[word.stream.value].by_listener[listener];
    parts_.push_back({from + " to " + name_of(to), "latency of the word", latency.value_or(Duration()), time - word.published});
    const std::optional<Duration>& wait = bounds_.participants[word.from.program][word.from.number].publish_wait;
    parts_.push_back({from, "wait for the next publication", wait.value_or(Duration()), word.published - word.changed});
  }

  /// From the cause to the first who noticed it; a call is noticed at once.
  void add_beginning(const std::string& name, TrueTime time) {
    Duration noticed;
    for (const analysis::ReactionBound& bound : bounds_.reactions)
      if (bound.cause == reaction_.cause && bound.cause != handshake::Cause::command && bound.bound && !bound.parts.empty()) noticed = std::max(noticed, bound.parts.front().duration);
    parts_.push_back({name, "noticing the cause", noticed, time - reaction_.began});
  }

  const scenario::Run& run_;
  const scenario::Resolved& resolved_;
  const FrameLog& log_;
  const analysis::Bounds& bounds_;
  const handshake::Reaction& reaction_;
  std::vector<SlackPart> parts_;
};

struct Found {
  const handshake::Reaction* reaction = nullptr;
  std::vector<std::size_t> programs;   // of whose participants the last one completed it
};

Found longest(const scenario::Run& run, const scenario::RequiredFigure& required, Duration measured) {
  Found found;
  const scenario::AskedReaction asked = *scenario::reaction_of(required.figure);
  const TrueTime from = TrueTime() + required.from;
  const auto look = [&](std::span<const handshake::Reaction> reactions, const std::vector<std::size_t>& programs) {
    for (const handshake::Reaction& each : reactions)
      if (found.reaction == nullptr && each.outcome == handshake::ReactionOutcome::completed && handshake::name_of(each.kind) == scenario::spelling(asked.kind) && each.began >= from &&
          (!asked.cause || each.cause == *asked.cause) && each.completed - each.began == measured)
        found = {&each, programs};
  };
  const auto is_meant = [&](std::size_t program) { return !asked.program || run.resolved().programs[program].name == *asked.program; };
  if (asked.of_tree) {
    for (const auto& tree : run.trees())
      if (is_meant(tree->programs().front())) look(tree->reactions(), {tree->programs().begin(), tree->programs().end()});
    return found;
  }
  for (std::size_t p = 0; p < run.resolved().programs.size(); ++p)
    if (is_meant(p) && !run.resolved().programs[p].has_roles()) look(run.monitor(p).reactions(), {p});
  return found;
}

}  // namespace

std::vector<SlackPart> reaction_parts(const scenario::Run& run, const FrameLog& log, const analysis::Bounds& bounds, const scenario::RequiredFigure& required, Duration measured, Duration bound) {
  const Found found = longest(run, required, measured);
  if (found.reaction == nullptr) return {};
  std::vector<SlackPart> parts = Chain(run, log, bounds, *found.reaction).make(found.programs);
  Duration chain;
  for (const SlackPart& part : parts) chain += part.bound;
  parts.push_back({"another chain", "the slowest that the bound reckons with", bound - chain, Duration()});
  return parts;
}

}  // namespace takt::verify
