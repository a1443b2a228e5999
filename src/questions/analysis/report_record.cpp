// SPDX-License-Identifier: Apache-2.0
#include "analysis/report_record.hpp"

#include "json/record.hpp"

namespace takt::analysis {

using sim::Duration;

namespace {

std::string standing_of(const AssessedAssumption& each) { return std::string(name_of(each.standing)); }
std::optional<std::string> why_of(const AssessedAssumption& each) {
  return each.why.empty() ? std::nullopt : std::optional(each.why);
}

std::string name_of_stream(const ReportedStream& stream) { return stream.bound->name; }
std::optional<Duration> latency_of_stream(const ReportedStream& stream) { return stream.bound->latency; }
std::optional<Duration> total_flow_of(const ReportedStream& stream) { return stream.bound->total_flow; }
std::optional<Duration> separated_flow_of(const ReportedStream& stream) { return stream.bound->separated_flow; }
std::string separated_flow_reason_of(const ReportedStream& stream) { return stream.bound->separated_flow_reason; }
Duration least_of(const ReportedStream& stream) { return stream.bound->least; }
std::string reason_of_stream(const ReportedStream& stream) { return stream.bound->reason; }
bool loses_nothing(const ReportedStream& stream) { return stream.bound->loses_nothing; }
bool reaches_all(const ReportedStream& stream) { return stream.bound->reaches_all; }
const std::vector<HopBound>& hops_of(const ReportedStream& stream) { return stream.bound->hops; }
std::vector<std::string> assumptions_of_stream(const ReportedStream& stream) {
  return names_of(stream.bound->assumptions);
}

std::uint16_t port_of(const ReportedQueue& queue) { return queue.bound->port; }
models::TrafficClass class_of(const ReportedQueue& queue) { return queue.bound->traffic_class; }
std::optional<std::uint64_t> bits_of(const ReportedQueue& queue) { return queue.bound->bits; }
std::optional<std::uint64_t> frames_of(const ReportedQueue& queue) { return queue.bound->frames; }

std::string kind_of(const ReportedReaction& reaction) { return std::string(scenario::spelling(reaction.bound->kind)); }
std::string cause_of(const ReportedReaction& reaction) {
  return std::string(scenario::spelling(reaction.bound->cause));
}
bool is_of_tree(const ReportedReaction& reaction) { return reaction.bound->of_tree; }
std::optional<Duration> bound_of_reaction(const ReportedReaction& reaction) { return reaction.bound->bound; }
std::string reason_of_reaction(const ReportedReaction& reaction) { return reaction.bound->reason; }
const std::vector<ReactionPart>& parts_of(const ReportedReaction& reaction) { return reaction.bound->parts; }
std::vector<std::string> assumptions_of_reaction(const ReportedReaction& reaction) {
  return names_of(reaction.bound->assumptions);
}

std::optional<Duration> duration_of_requirement(const ReportedRequirement& requirement) {
  return requirement.bound->duration;
}
std::optional<std::uint64_t> count_of(const ReportedRequirement& requirement) { return requirement.bound->count; }
std::optional<FigureRange> range_of(const ReportedRequirement& requirement) { return requirement.bound->figure; }
std::string reason_of_requirement(const ReportedRequirement& requirement) { return requirement.bound->reason; }
std::vector<std::string> assumptions_of_requirement(const ReportedRequirement& requirement) {
  return names_of(requirement.bound->assumptions);
}

std::optional<Duration> worst_of(const ReportedThread& thread) { return duration_of(thread.time->worst); }
Duration least_of_thread(const ReportedThread& thread) { return Duration::from_ps(thread.time->least); }
std::string reason_of_thread(const ReportedThread& thread) { return thread.time->reason; }
std::optional<Duration> one_way_of(const ReportedDelivery& delivery) { return delivery.bound->one_way; }
std::string reason_of_delivery(const ReportedDelivery& delivery) { return delivery.bound->reason; }
std::optional<Duration> repaired_of(const ReportedDelivery& delivery) { return delivery.bound->repaired; }
std::string repair_reason_of(const ReportedDelivery& delivery) { return delivery.bound->repair_reason; }
bool delivery_reaches_all(const ReportedDelivery& delivery) { return delivery.bound->reaches_all; }
std::string loss_reason_of(const ReportedDelivery& delivery) { return delivery.bound->loss_reason; }
std::vector<std::string> assumptions_of_delivery(const ReportedDelivery& delivery) {
  return names_of(delivery.bound->assumptions);
}
bool has_deliveries(const BoundReport& report) { return !report.deliveries.empty(); }
bool has_threads(const BoundReport& report) { return !report.threads.empty(); }

constexpr std::string_view reason_help = "Why there is no bound, or what is left to say of it.";
constexpr std::string_view assumptions_help = "Names of what the bound rests on.";

}  // namespace

std::vector<std::string> names_of(const Assumptions& assumptions) {
  std::vector<std::string> names;
  for (const Assumption assumption : assumptions.list()) names.emplace_back(name_of(assumption));
  return names;
}

const json::Record& describe(json::Type<AssessedAssumption>) {
  static constexpr json::Output outputs[] = {
      json::output<&AssessedAssumption::text>("text", "What is assumed, with the scenario's figures."),
      json::output<&standing_of>("standing",
                                 "`discharged`, `condition` (only the plant can keep it), `open` or `violated`."),
      json::output<&why_of>("why", "What discharges or violates it, or why it is open; null for conditions."),
      json::output<&AssessedAssumption::holds_from>("holds_from_ps", "What counts from earlier does not stand."),
  };
  static constexpr json::Record record{"assumption", "What becomes of an assumption in this scenario.", outputs};
  return record;
}

const json::Record& describe(json::Type<HopBound>) {
  static constexpr json::Output outputs[] = {
      json::output<&HopBound::name>("port", "The egress port and its peer."),
      json::output<&HopBound::delay>("delay_ps",
                                     "From arrival at the port to the last bit on the wire; null: unbounded."),
      json::output<&HopBound::backlog_bits>(
          "backlog_bits", "Of the stream's class, preambles and gaps included; null: unbounded.", {.unit = "bits"}),
  };
  static constexpr json::Record record{"hop", "An egress port on the way of a stream.", outputs};
  return record;
}

const json::Record& describe(json::Type<ReactionPart>) {
  static constexpr json::Output outputs[] = {
      json::output<&ReactionPart::what>("what", "What happens."),
      json::output<&ReactionPart::duration>("duration_ps", "How long that takes at most."),
  };
  static constexpr json::Record record{"part", "A part of a reaction's bound, in the order in which they happen.",
                                       outputs};
  return record;
}

const json::Record& describe(json::Type<FigureRange>) {
  static constexpr json::Output outputs[] = {
      json::output<&FigureRange::least>("least", "Null: not known."),
      json::output<&FigureRange::greatest>("greatest", "Null: not known."),
  };
  static constexpr json::Record record{"range", "What a figure can be, in its unit.", outputs};
  return record;
}

const json::Record& describe(json::Type<ReportedStream>) {
  static constexpr json::Output outputs[] = {
      json::output<&name_of_stream>("name", "Its name."),
      json::output<&latency_of_stream>(
          "bound_ps", "From production to delivery, at any listener: the lesser of the two analyses; null: unbounded."),
      json::output<&total_flow_of>("tfa_ps", "The same by total-flow analysis, the sum of the hops; null: unbounded."),
      json::output<&separated_flow_of>("sfa_ps", "And by separated-flow analysis; null where that does not apply."),
      json::output<&separated_flow_reason_of>("sfa_reason", "Why it does not."),
      json::output<&least_of>("least_ps", "No delivered frame is faster."),
      json::output<&ReportedStream::listener>("listener", "The listener that the bound is of."),
      json::output<&reason_of_stream>("reason", reason_help),
      json::output<&loses_nothing>("loses_nothing",
                                   "Queues have room for every backlog and nothing else drops its frames."),
      json::output<&reaches_all>("reaches_all",
                                 "Each frame comes to each listener: nothing is lost, or of a redundant stream a copy "
                                 "is left whatever fails."),
      json::output<&hops_of>("hops", "To that listener."),
      json::output<&assumptions_of_stream>("assumptions", assumptions_help),
  };
  static constexpr json::Record record{"stream", "How late a frame of a stream can come.", outputs};
  return record;
}

const json::Record& describe(json::Type<ReportedQueue>) {
  static constexpr json::Output outputs[] = {
      json::output<&ReportedQueue::node>("node", "Whose port it is."),
      json::output<&port_of>("port", "Its number, from 0."),
      json::output<&class_of>("class", "The traffic class."),
      json::output<&bits_of>("backlog_bits", "Preambles and gaps included; null: unbounded.", {.unit = "bits"}),
      json::output<&frames_of>("backlog_frames", "Null: unbounded.", {.unit = "frames"}),
  };
  static constexpr json::Record record{"queue", "A queue of an egress port, and what may be in it or on the wire.",
                                       outputs};
  return record;
}

const json::Record& describe(json::Type<ReportedReaction>) {
  static constexpr json::Output outputs[] = {
      json::output<&ReportedReaction::program>("program", "The Program."),
      json::output<&kind_of>("kind", "`start`, `halt`, `suspend`, `resume` or `reset`."),
      json::output<&cause_of>("cause", "What it follows."),
      json::output<&is_of_tree>("tree", "Of the Program and all that are nested in it."),
      json::output<&bound_of_reaction>(
          "bound_ps", "From the instant of the cause until all who live have reached the state; null: unbounded."),
      json::output<&reason_of_reaction>("reason", reason_help),
      json::output<&parts_of>("parts", "Of the slowest chain; they sum up to the bound."),
      json::output<&assumptions_of_reaction>("assumptions", assumptions_help),
  };
  static constexpr json::Record record{"reaction", "How long a reaction can take.", outputs};
  return record;
}

std::vector<ReportedThread> threads_of(const scenario::Resolved& resolved, const Bounds& bounds) {
  std::vector<ReportedThread> threads;
  for (std::size_t n = 0; n < bounds.hosts->nodes().size(); ++n)
    for (std::size_t t = 0; t < bounds.hosts->nodes()[n].size(); ++t)
      threads.push_back({resolved.plan.nodes[n].name + "/" + resolved.plan.nodes[n].cpu->threads[t].name,
                         &bounds.hosts->nodes()[n][t]});
  return threads;
}

const json::Record& describe(json::Type<ReportedThread>) {
  static constexpr json::Output outputs[] = {
      json::output<&ReportedThread::name>("thread", "The host and the thread."),
      json::output<&worst_of>("bound_ps", "From when a job is ready to its end; null: unbounded."),
      json::output<&least_of_thread>("least_ps", "No job is faster."),
      json::output<&reason_of_thread>("reason", reason_help),
  };
  static constexpr json::Record record{"thread", "How long the jobs of a thread of a host's processor can take.",
                                       outputs};
  return record;
}

std::vector<ReportedDelivery> deliveries_of(const scenario::Resolved& resolved, const Bounds& bounds) {
  const auto name = [&](std::size_t application, std::size_t thread) {
    return resolved.applications[application].name + "/" + resolved.applications[application].threads[thread].name;
  };
  std::vector<ReportedDelivery> all;
  for (const DeliveryBound& each : bounds.deliveries) {
    const std::uint32_t topic = resolved.applications[each.to_application].threads[each.to_thread].topic;
    all.push_back({&each, resolved.topics[topic].description->name, name(each.from_application, each.from_thread),
                   name(each.to_application, each.to_thread)});
  }
  return all;
}

const json::Record& describe(json::Type<ReportedDelivery>) {
  static constexpr json::Output outputs[] = {
      json::output<&ReportedDelivery::topic>("topic", "The topic."),
      json::output<&ReportedDelivery::from>("from", "The application and its thread that publishes."),
      json::output<&ReportedDelivery::to>("to", "The application and its thread that subscribes; the two are matched."),
      json::output<&one_way_of>("one_way_ps",
                                "From the call that writes a sample until the reader has it, of a sample whose "
                                "messages are not lost; null: unbounded."),
      json::output<&reason_of_delivery>("reason", "Why there is no such bound."),
      json::output<&repaired_of>(
          "repaired_ps",
          "The same over DDS of a sample whose messages are lost once, and of those that wait for it, if the "
          "HEARTBEAT, the ACKNACK and the repair come; null: unbounded, or no repair."),
      json::output<&repair_reason_of>("repair_reason", "Why there is no such bound."),
      json::output<&delivery_reaches_all>("reaches_all", "No message is lost on that way, so that the one way is all."),
      json::output<&loss_reason_of>("loss_reason", "What may be lost."),
      json::output<&assumptions_of_delivery>("assumptions", assumptions_help),
  };
  static constexpr json::Record record{"delivery", "How long a sample of a topic takes to a reader.", outputs};
  return record;
}

const json::Record& describe(json::Type<ReportedRequirement>) {
  static constexpr json::Output outputs[] = {
      json::output_if_any<&ReportedRequirement::name>("name", "The name that the scenario gives it.",
                                                      "where it gives one"),
      json::output<&ReportedRequirement::text>("text", "What is asked."),
      json::output<&duration_of_requirement>("bound_ps",
                                             "What it can be at most; null where it is no time, or not bounded."),
      json::output<&count_of>("bound_count", "The same of a number of frames; null where it is none."),
      json::output_if_any<&range_of>("range", "What the figure can be.", "of a limit on a figure"),
      json::output<&reason_of_requirement>("reason", reason_help),
      json::output<&ReportedRequirement::objection>("objection", "Why the bound does not stand; null: it does."),
      json::output<&assumptions_of_requirement>("assumptions", assumptions_help),
  };
  static constexpr json::Record record{"requirement", "One limit of a requirement, and what it can be at most.",
                                       outputs};
  return record;
}

const json::Record& describe(json::Type<BoundReport>) {
  static constexpr json::Output outputs[] = {
      json::output<&BoundReport::scenario>("scenario", "Its name."),
      json::output<&BoundReport::streams>("streams", "In the order of the scenario."),
      json::output<&BoundReport::queues>("queues", "Of classes that carry something."),
      json::output<&BoundReport::reactions>("reactions", "Of each Program."),
      json::only_if<&has_threads>(json::output<&BoundReport::threads>("threads", "Of hosts with processors."),
                                  "where there are some"),
      json::only_if<&has_deliveries>(
          json::output<&BoundReport::deliveries>("deliveries", "Of topics, by reader and what it hears."),
          "where there are topics"),
      json::output<&BoundReport::requirements>("requirements", "One for each limit, in the order of the scenario."),
      json::output<&BoundReport::assumptions>("assumptions", "What any of the bounds rests on.",
                                              {.keys = "assumption"}),
  };
  static constexpr json::Record record{"bounds", "The bounds of a scenario.", outputs};
  return record;
}

}  // namespace takt::analysis
