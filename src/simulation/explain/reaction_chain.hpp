// SPDX-License-Identifier: Apache-2.0
// How a reaction of a run came about: the words that made the last participant follow, backwards to the cause.
#pragma once

#include <span>
#include <vector>

#include "scenario/figures/requirement.hpp"
#include "scenario/run/run.hpp"

namespace takt::explain {

/// A frame that has come to a listener.
struct Arrival {
  models::StreamIndex stream;
  models::NodeIndex listener;
  sim::TrueTime produced;
  sim::TrueTime at;
  sim::Duration latency() const { return at - produced; }
};

/// A participant of one of the scenario's Programs.
struct Participant {
  std::size_t program = 0;
  std::size_t number = 0;
};

/// A step of the chain; each begins where the one before ends.
struct ChainLink {
  enum class Kind : std::uint8_t {
    beginning,      ///< from the cause until the first who noticed it; a call is noticed at once
    publication,    ///< `who` has changed its word and waits to publish it
    message,        ///< the word is under way from `who` to `to`
    opening,        ///< `who` opens the secured message in which it came
    initialisation  ///< `who` is in INIT, or waits for a timer of its own
  };
  Kind kind{};
  Participant who;
  Participant to;
  models::StreamIndex stream;  ///< of a message
  sim::TrueTime begin;
  sim::TrueTime end;
};

/// A reaction of a run and the Programs whose participants complete it.
struct FoundReaction {
  const handshake::Reaction* reaction = nullptr;  ///< null: there is none
  std::vector<std::size_t> programs;
};

/// Of the completed reactions that are asked about and began at `from` or later the one that took so long, or the
/// longest of all. Programs with roles are left out: their nodes come and go.
FoundReaction find_reaction(const scenario::Run& run, const scenario::AskedReaction& asked, sim::TrueTime from,
                            std::optional<sim::Duration> took);

/// The chain, from the cause on; the links add up to the duration of the reaction. `arrivals` has all words between
/// participants, in the order of time.
std::vector<ChainLink> chain_of(const scenario::Run& run, std::span<const Arrival> arrivals,
                                const FoundReaction& found);

/// The name of a participant.
const std::string& name_of(const scenario::Resolved& resolved, const Participant& who);

/// Of each stream: whether it carries words of participants.
std::vector<bool> streams_of_words(const scenario::Resolved& resolved);

}  // namespace takt::explain
