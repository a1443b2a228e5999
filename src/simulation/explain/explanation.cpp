// SPDX-License-Identifier: Apache-2.0
#include "explain/explanation.hpp"

#include <array>

#include "json/record.hpp"
#include "sim/check.hpp"

namespace takt::explain {
namespace {

ExplainedPart explained_part(const models::Network& network, const Part& part) {
  ExplainedPart made{name_of(part.cause), std::string(words_of(part.cause)), part.begin, part.length, {}, {}, {}, {}};
  if (part.who) {
    made.stream = network.traffic().stream(part.who->stream).name;
    made.sequence = part.who->sequence;
  }
  if (part.amount != Part::no_amount) (part.cause == Cause::credit ? made.missing_bits : made.gate_entry) = part.amount;
  return made;
}

std::vector<ExplainedPart> explained_parts(const models::Network& network, const std::vector<Part>& parts) {
  std::vector<ExplainedPart> made;
  for (const Part& part : parts) made.push_back(explained_part(network, part));
  return made;
}

constexpr std::array<std::string_view, static_cast<std::size_t>(models::Storing::count)> reasons_to_store = {
    "the port does not cut its class through",
    "it comes from a link of another rate",
    "the link is down",
    "on the medium is ",
    "first comes ",
    "frames of its class wait, which came before it",
    "its SDU is longer than the port's limit",
    "",  // a refusal
};

std::string refused_with(const models::BlockedRecord& refusal) {
  const bool has_entry = refusal.amount != models::BlockedRecord::no_entry;
  switch (refusal.hindrance) {
    case models::BlockReason::gate_closed:
      return "its gate is closed" + (has_entry ? ", entry " + std::to_string(refusal.amount) : std::string());
    case models::BlockReason::guard:
      return "it would not end before its gate closes" +
             (has_entry ? ", entry " + std::to_string(refusal.amount) : std::string());
    case models::BlockReason::credit:
      return "the credit of its class is negative, " + std::to_string(refusal.amount) + " bits are missing";
    case models::BlockReason::not_eligible:
      return "its time has not come";
    case models::BlockReason::hold:
      return "the MAC holds";
    case models::BlockReason::count:
      break;
  }
  TAKT_CHECK(false, "a hindrance that the models know");
  return {};
}

std::string words_of(const models::Network& network, const Stored& stored) {
  switch (stored.because) {
    case Stored::Because::preemptable:
      return "it comes from a port that may preempt it";
    case Stored::Because::short_frame:
      return "it is not longer than the header that must have come";
    case Stored::Because::timed:
      return "another port of the node sends its priority by eligibility times, which count from the last bit";
    case Stored::Because::doubled:
      return "the link has doubled it";
    case Stored::Because::port:
      break;
  }
  if (stored.detail.reason == models::Storing::refused) return refused_with(stored.detail.refusal);
  std::string words(reasons_to_store[static_cast<std::size_t>(stored.detail.reason)]);
  if (stored.detail.reason == models::Storing::medium_busy || stored.detail.reason == models::Storing::goes_first)
    words += stored.who
                 ? network.traffic().stream(stored.who->stream).name + " frame " + std::to_string(stored.who->sequence)
                 : "another frame";
  return words;
}

constexpr const char* ends[] = {"delivered", "dropped", "under way"};

}  // namespace

Duration ExplainedHop::takes() const {
  Duration sum;
  for (const ExplainedPart& part : parts) sum += part.takes;
  return sum;
}

ExplainedFrame explained(const models::Network& network, const Way& way) {
  const std::vector<models::NodePlan>& nodes = network.plan().nodes;
  ExplainedFrame frame;
  frame.stream = network.traffic().stream(way.frame.stream).name;
  frame.sequence = way.frame.sequence;
  frame.talker = nodes[way.talker.value].name;
  frame.end = ends[static_cast<std::size_t>(way.end)];
  frame.node = nodes[way.node.value].name;
  frame.port = way.port;
  if (way.end == Way::End::dropped) frame.reason = models::name_of(way.reason);
  frame.produced = way.produced;
  frame.ended = way.ended;
  frame.takes = way.latency();
  if (!way.before.empty())
    frame.hops.push_back({frame.talker, {}, {}, {}, way.produced, {}, 0, {}, explained_parts(network, way.before)});
  for (const Hop& hop : way.hops) {
    ExplainedHop made{
        nodes[hop.port.node.value].name,    hop.port.port, {}, hop.traffic_class, hop.came, {}, hop.cuts, {},
        explained_parts(network, hop.parts)};
    if (hop.stored) made.stored = words_of(network, *hop.stored);
    if (!hop.peer.is_none()) made.to = nodes[hop.peer.value].name;
    if (hop.started != TrueTime::never()) made.started = hop.started;
    frame.hops.push_back(std::move(made));
  }
  return frame;
}

const json::Record& describe(json::Type<ExplainedPart>) {
  static constexpr json::Output outputs[] = {
      json::output<&ExplainedPart::cause>(
          "cause",
          "Why: `os_transmit`, `processor`, `launch_time`, `ats`, `higher_class`, `precedence`, `own_class`, "
          "`lower_class`, `gate_closed`, `guard`, `credit`, `hold`, `preemption`, `transmission`, `cable`, "
          "`forwarding`, `jitter` or `os_receive`; docs/explain.md says what each is."),
      json::output<&ExplainedPart::words>("words", "The same in words."),
      json::output<&ExplainedPart::at>("at_ps", "When it begins, in true time."),
      json::output<&ExplainedPart::takes>("takes_ps", "How long it takes."),
      json::output_if_any<&ExplainedPart::stream>("stream", "Of the frame that is on the medium meanwhile.",
                                                  "where it waits for a frame"),
      json::output_if_any<&ExplainedPart::sequence>("sequence", "The number of that frame in its stream, from 0.",
                                                    "where it waits for a frame"),
      json::output_if_any<&ExplainedPart::gate_entry>(
          "gate_entry", "The entry of the gate list, from 0, that was in force when the port refused the frame.",
          "where a gate list is to blame"),
      json::output_if_any<&ExplainedPart::missing_bits>(
          "missing_bits", "What the credit lacked when the port refused the frame.", "where credit is to blame"),
  };
  static constexpr json::Record record{"part", "A part of a latency.", outputs};
  return record;
}

const json::Record& describe(json::Type<ExplainedHop>) {
  static constexpr json::Output outputs[] = {
      json::output<&ExplainedHop::node>("node", "Whose port it is."),
      json::output_if_any<&ExplainedHop::port>("port", "The egress port.", "unless within the talker's host"),
      json::output_if_any<&ExplainedHop::to>("to", "The node at the other end of its link.",
                                             "unless within the talker's host"),
      json::output_if_any<&ExplainedHop::traffic_class>("traffic_class", "Of the frame there.",
                                                        "unless within the talker's host"),
      json::output<&ExplainedHop::came>("came_ps",
                                        "When the frame came to the port; to the host: when it was produced."),
      json::output_if_any<&ExplainedHop::started>("started_ps", "When the first bit of its preamble left.",
                                                  "if it did"),
      json::output<&ExplainedHop::cuts>("cuts", "How often it was preempted there."),
      json::output_if_any<&ExplainedHop::stored>("stored", "Why it was not cut through.",
                                                 "where a frame of a class that the port cuts through was stored"),
      json::output<&ExplainedHop::parts>("parts",
                                         "From then on, without gaps, until it comes to the next port or ends."),
  };
  static constexpr json::Record record{"hop", "The talker's host, or one egress port with what follows up to the next.",
                                       outputs};
  return record;
}

const json::Record& describe(json::Type<ExplainedFrame>) {
  static constexpr json::Output outputs[] = {
      json::output<&ExplainedFrame::stream>("stream", "Its stream."),
      json::output<&ExplainedFrame::sequence>("sequence", "Its number in the stream, from 0."),
      json::output<&ExplainedFrame::talker>("talker", "The node that produced it."),
      json::output<&ExplainedFrame::end>("end", "`delivered`, `dropped`, or `under way` when the run ended."),
      json::output<&ExplainedFrame::node>("node", "Where it ended."),
      json::output_if_any<&ExplainedFrame::port>("port", "At which port, or on the wire behind it.",
                                                 "if it was lost at a port"),
      json::output_if_any<&ExplainedFrame::reason>("reason", "Why it was dropped.", "if it was"),
      json::output<&ExplainedFrame::produced>("produced_ps", "When the application handed it over."),
      json::output<&ExplainedFrame::ended>("ended_ps", "When it was delivered, dropped, or the run ended."),
      json::output<&ExplainedFrame::takes>("takes_ps", "From one to the other: its latency. All parts add up to it."),
      json::output<&ExplainedFrame::hops>("hops", "From the talker on."),
  };
  static constexpr json::Record record{"frame", "The way of a frame to one of its ends.", outputs};
  return record;
}

const json::Record& describe(json::Type<ExplainedStep>) {
  static constexpr json::Output outputs[] = {
      json::output<&ExplainedStep::what>(
          "what",
          "`noticing the cause`, `wait for the next publication` (a cycle and the wake-up), `message`, `opening the "
          "message` (of secured ones), or `initialisation or own timer`."),
      json::output<&ExplainedStep::who>("who", "The participant; of a message: from whom to whom."),
      json::output<&ExplainedStep::at>("at_ps", "When it begins."),
      json::output<&ExplainedStep::takes>("takes_ps", "How long it takes."),
      json::output_if_any<&ExplainedStep::message>("message", "The way of the message.", "of a message"),
  };
  static constexpr json::Record record{"step", "A link of the chain that made a reaction last.", outputs};
  return record;
}

const json::Record& describe(json::Type<ExplainedReaction>) {
  static constexpr json::Output outputs[] = {
      json::output<&ExplainedReaction::program>("program", "Whose."),
      json::output<&ExplainedReaction::kind>("kind", "`start`, `halt`, `suspend`, `resume` or `reset`."),
      json::output<&ExplainedReaction::cause>("cause", "`command`, or what else began it."),
      json::output<&ExplainedReaction::began>("began_ps", "The instant of the cause."),
      json::output<&ExplainedReaction::takes>("takes_ps",
                                              "Until the last participant was there. The steps add up to it."),
      json::output<&ExplainedReaction::steps>("steps", "The critical path, from the cause on."),
  };
  static constexpr json::Record record{"reaction", "Why a reaction took so long.", outputs};
  return record;
}

const json::Record& describe(json::Type<ExplainedShare>) {
  static constexpr json::Output outputs[] = {
      json::output<&ExplainedShare::where>("where", "A port, or a message's way."),
      json::output<&ExplainedShare::what>("what", "What the bound reckons with there."),
      json::output<&ExplainedShare::bound>("bound_ps", "What the bound takes for it."),
      json::output<&ExplainedShare::run>("run_ps", "What it took in the run; null: no run was looked at."),
  };
  static constexpr json::Record record{"share", "A part of a bound beside that of the worst run that was found.",
                                       outputs};
  return record;
}

const json::Record& describe(json::Type<Explanation>) {
  static constexpr json::Output outputs[] = {
      json::output<&Explanation::scenario>("scenario", "Its name."),
      json::output<&Explanation::question>("question", "What is explained."),
      json::output_if_any<&Explanation::reaction>("reaction", "Its critical path.", "if a reaction was asked about"),
      json::output<&Explanation::frames>(
          "frames", "The frame that was asked about, once for each of its ends; empty if none was."),
      json::output_if_any<&Explanation::bound>("bound_ps", "What no run exceeds.", "with --bound"),
      json::output<&Explanation::shares>(
          "shares", "The bound part by part, beside the worst run that was found; empty without --bound."),
  };
  static constexpr json::Record record{"explanation", "Why something took as long as it did.", outputs};
  return record;
}

}  // namespace takt::explain
