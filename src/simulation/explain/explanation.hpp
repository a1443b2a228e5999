// SPDX-License-Identifier: Apache-2.0
// What `takt explain --format json` holds: ways with the scenario's names, for people and for whoever draws them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "explain/way.hpp"
#include "json/type.hpp"
#include "models/network.hpp"

namespace takt::explain {

struct ExplainedPart {
  std::string cause;  ///< name_of(Cause)
  std::string words;  ///< "behind a higher class"
  TrueTime at;
  Duration takes;
  std::optional<std::string> stream;  ///< of the frame on the medium
  std::optional<std::uint64_t> sequence;
  std::optional<std::uint32_t> gate_entry;
  std::optional<std::uint32_t> missing_bits;
};

/// At the talker's host, or from one egress port to the next one or the listener.
struct ExplainedHop {
  std::string node;
  std::optional<std::uint16_t> port;  ///< none: within the talker's host
  std::optional<std::string> to;
  std::optional<std::uint8_t> traffic_class;
  TrueTime came;
  std::optional<TrueTime> started;
  std::uint32_t cuts = 0;
  std::optional<std::string> stored;  ///< why, if its class is cut through there
  std::vector<ExplainedPart> parts;
  Duration takes() const;
};

struct ExplainedFrame {
  std::string stream;
  std::uint64_t sequence = 0;
  std::string talker;
  std::string end;                    ///< "delivered", "dropped", "under way"
  std::string node;                   ///< where
  std::optional<std::uint16_t> port;  ///< at which, or behind which, it was lost
  std::optional<std::string> reason;  ///< why
  TrueTime produced;
  TrueTime ended;
  Duration takes;
  std::vector<ExplainedHop> hops;
};

/// One link of the chain from the cause of a reaction to its last transition.
struct ExplainedStep {
  std::string what;  ///< "noticing the cause", "wait for the next publication", "message", "INIT"
  std::string who;   ///< participant, or "generator to robot"
  TrueTime at;
  Duration takes;
  std::optional<ExplainedFrame> message;
};

struct ExplainedReaction {
  std::string program;
  std::string kind;
  std::string cause;
  TrueTime began;
  Duration takes;
  std::vector<ExplainedStep> steps;
};

/// A part of a bound beside the same part of a run.
struct ExplainedShare {
  std::string where;
  std::string what;
  std::optional<Duration> bound;
  std::optional<Duration> run;
};

struct Explanation {
  std::string scenario;
  std::string question;  ///< "stream camera: its slowest frame"
  std::string replay;    ///< a scenario that was found, if it is not the one that was asked about
  std::optional<ExplainedReaction> reaction;
  std::vector<ExplainedFrame> frames;  ///< the one that was asked for; of one that ended several times each end
  std::optional<Duration> bound;
  std::vector<ExplainedShare> shares;  ///< of the bound and the run, in the order of the way
};

ExplainedFrame explained(const models::Network& network, const Way& way);

const json::Record& describe(json::Type<ExplainedPart>);
const json::Record& describe(json::Type<ExplainedHop>);
const json::Record& describe(json::Type<ExplainedFrame>);
const json::Record& describe(json::Type<ExplainedStep>);
const json::Record& describe(json::Type<ExplainedReaction>);
const json::Record& describe(json::Type<ExplainedShare>);
const json::Record& describe(json::Type<Explanation>);

/// Where a part passes: "sw1:0 to robot", or the node itself; what a node does to a frame that has come belongs to that
/// node.
std::string place_of(const ExplainedHop& hop, const ExplainedPart& part);

/// The same as a page for people.
std::string text_of(const Explanation& explanation);

}  // namespace takt::explain
