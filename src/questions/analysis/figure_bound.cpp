// SPDX-License-Identifier: Apache-2.0
#include "analysis/figure_bound.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "analysis/flow_graph.hpp"
#include "analysis/thread_bound.hpp"
#include "scenario/figures/graph_figures.hpp"

namespace takt::analysis {
namespace {

using scenario::Figure;
using scenario::Take;
using sim::Duration;

/// What takt has no bound for, by the first step of the pointer.
std::string unbounded_text(const Figure& figure) {
  constexpr std::pair<std::string_view, const char*> texts[] = {
      {"applications", "what applications do, and when"},
      {"clocks", "clocks: synchronisation is simulated"},
      {"clock_differences", "clocks: synchronisation is simulated"},
      {"cpus", "this figure of processors"},
      {"events", "how many events a run has"},
      {"ingress", "what filters, gates and meters of the ingress count"},
      {"ports", "this figure of ports"},
      {"programs", "this figure of Programs"},
      {"queues", "this figure of queues"},
      {"redundancy", "what splits and recoveries of redundant streams count"},
      {"requirements", "what requirements come to"},
      {"signals", "how regular the pulses of a signal are"},
      {"streams", "this figure of streams"}};
  for (const auto& [step, text] : texts)
    if (!figure.steps.empty() && figure.steps.front() == step) return std::string("takt has no bound for ") + text;
  return "takt has no bound for this figure";
}

bool has_steps(const Figure& figure, std::initializer_list<std::string_view> steps) {
  return figure.steps.size() == steps.size() &&
         std::equal(steps.begin(), steps.end(), figure.steps.begin(),
                    [](std::string_view step, const std::string& has) { return step == "?" || step == has; });
}

/// What each of the values can be that the figure is taken of, in the numbers of the result.
class Values {
 public:
  void add(std::optional<double> least, std::optional<double> greatest, const std::string& reason) {
    ranges_.push_back({least, greatest});
    if ((!least || !greatest) && reason_.empty()) reason_ = reason;
  }
  void rest_on(const Assumptions& assumptions) { assumptions_.add(assumptions); }

  RequirementBound taken(const Figure& figure) const {
    RequirementBound bound;
    bound.figure.emplace();
    if (ranges_.empty() || figure.take == Take::count) {
      bound.reason = unbounded_text(figure);
      return bound;
    }
    bound.assumptions = assumptions_;
    bound.figure->least = of_all(&FigureRange::least, figure.take, std::min<double>);
    bound.figure->greatest = of_all(&FigureRange::greatest, figure.take, std::max<double>);
    // The least of several is no greater than any of them, and so on.
    for (const FigureRange& range : ranges_) {
      if (figure.take == Take::min && range.greatest)
        bound.figure->greatest = std::min(bound.figure->greatest.value_or(*range.greatest), *range.greatest);
      if (figure.take == Take::max && range.least)
        bound.figure->least = std::max(bound.figure->least.value_or(*range.least), *range.least);
    }
    for (std::optional<double>* const end : {&bound.figure->least, &bound.figure->greatest})
      if (*end) **end /= figure.divisor;
    if (!bound.figure->least || !bound.figure->greatest)
      bound.reason = reason_.empty() ? unbounded_text(figure) : reason_;
    return bound;
  }

 private:
  std::optional<double> of_all(std::optional<double> FigureRange::*end, Take take,
                               const double& (*further)(const double&, const double&)) const {
    std::optional<double> all;
    for (const FigureRange& range : ranges_) {
      const std::optional<double>& one = range.*end;
      if (!one) return std::nullopt;
      all = !all ? one : take == Take::sum ? *all + *one : further(*all, *one);
    }
    return all;
  }

  std::vector<FigureRange> ranges_;
  std::string reason_;
  Assumptions assumptions_;
};

double number(Duration duration) { return static_cast<double>(duration.ps()); }
std::optional<double> number(const std::optional<Duration>& duration) {
  return duration ? std::optional(number(*duration)) : std::nullopt;
}
std::optional<double> number(const std::optional<std::uint64_t>& count) {
  return count ? std::optional(static_cast<double>(*count)) : std::nullopt;
}

class FigureBounder {
 public:
  FigureBounder(const scenario::Resolved& resolved, const Bounds& bounds, const Figure& figure, Duration from)
      : r_(resolved), bounds_(bounds), figure_(figure), from_(from) {}

  RequirementBound make() {
    if (!figure_.steps.empty() && figure_.steps.front() == "streams") add_streams();
    if (figure_.steps.size() >= 5 && figure_.steps[0] == "applications" && figure_.steps[2] == "threads" &&
        figure_.only.empty())
      add_threads();
    if (figure_.steps.size() >= 5 && figure_.steps[0] == "cpus" && figure_.steps[2] == "threads" &&
        figure_.only.empty())
      add_cpu_threads();
    if (has_steps(figure_, {"dropped", "?"})) add_all_drops();
    if (has_steps(figure_, {"ports", "?", "queue_peak"})) add_queues();
    if (has_steps(figure_, {"queues", "?", "frames"}) || has_steps(figure_, {"queues", "?", "octets"}))
      add_queues_of_classes();
    if (!figure_.steps.empty() && figure_.steps.front() == "topology") return topology();
    return values_.taken(figure_);
  }

 private:
  void add_streams() {
    for (const StreamBound& stream : bounds_.streams) {
      if (figure_.steps.size() < 3 || (figure_.steps[1] != "*" && figure_.steps[1] != stream.name)) continue;
      if (has_steps(figure_, {"streams", "?", "latency_ps", "?"}))
        add_latency(stream);
      else if (has_steps(figure_, {"streams", "?", "lost"}))
        add_losses(stream, stream.reaches_all);
      else if (has_steps(figure_, {"streams", "?", "dropped", "?"}))
        add_losses(stream, stream.loses_nothing);
      else if (has_steps(figure_, {"streams", "?", "delivered"}))
        add_delivered(stream);
    }
  }

  void add_cpu_threads() {
    for (std::size_t n = 0; n < bounds_.hosts->nodes().size(); ++n) {
      const models::NodePlan& node = r_.plan.nodes[n];
      if (!node.cpu || (figure_.steps[1] != "*" && figure_.steps[1] != node.name)) continue;
      for (std::size_t t = 0; t < node.cpu->threads.size(); ++t)
        if (figure_.steps[3] == "*" || figure_.steps[3] == node.cpu->threads[t].name)
          add_cpu_thread(node, node.cpu->threads[t], bounds_.hosts->nodes()[n][t]);
    }
  }

  void add_cpu_thread(const models::NodePlan& node, const models::CpuThreadPlan& thread, const ThreadTime& time) {
    const std::optional<double> longest = number(duration_of(time.worst));
    const std::string reason = "thread " + node.name + "/" + thread.name + ": " + time.reason;
    values_.rest_on(bounds_.every);
    if (has_steps(figure_, {"cpus", "?", "threads", "?", "response_ps", "?"}) && figure_.steps.back() != "count")
      values_.add(figure_.steps.back() == "deviation" ? 0 : static_cast<double>(time.least), longest, reason);
    else if (has_steps(figure_, {"cpus", "?", "threads", "?", "response_p99_ps"}))
      values_.add(static_cast<double>(time.least), longest, reason);
    else if (has_steps(figure_, {"cpus", "?", "threads", "?", "refused"}))
      values_.add(0, longest ? std::optional(0.0) : std::nullopt, reason);
    else if (has_steps(figure_, {"cpus", "?", "threads", "?", "late"}))
      values_.add(
          0, longest && (!thread.deadline || time.worst <= thread.deadline->ps()) ? std::optional(0.0) : std::nullopt,
          longest ? reason + "a job may take " + json::to_text(*duration_of(time.worst)) : reason);
  }

  /// Means and percentiles lie between the fastest and the slowest; no deviation is greater than what lies between
  /// these.
  void add_latency(const StreamBound& stream) {
    values_.rest_on(stream.assumptions);
    if (figure_.steps.back() == "stddev")
      values_.add(0, stream.latency ? std::optional(number(*stream.latency - stream.least)) : std::nullopt,
                  stream.reason);
    else
      values_.add(number(stream.least), number(stream.latency), stream.reason);
  }

  void add_losses(const StreamBound& stream, bool is_without) {
    values_.rest_on(stream.assumptions);
    values_.add(0, is_without ? std::optional(0.0) : std::nullopt, stream.loss_reason);
  }

  void add_all_drops() {
    for (const StreamBound& stream : bounds_.streams) add_losses(stream, stream.loses_nothing);
    if (!r_.plan.gptp.empty()) values_.add(0, std::nullopt, "takt has no bound for what is dropped of gPTP");
  }

  void add_delivered(const StreamBound& stream) {
    values_.rest_on(stream.assumptions);
    const DeliveredFrames frames = frames_delivered(r_, stream, from_);
    values_.add(number(frames.least), number(frames.greatest), frames.reason);
  }

  /// Every queue is a part of what is in it or on the wire.
  void add_queues() {
    if (!figure_.only.empty() || figure_.steps[1] != "*") return;
    for (const QueueBound& queue : bounds_.queues)
      values_.add(
          0, number(queue.frames),
          "a queue of " + r_.plan.nodes[queue.node.value].name + ":" + std::to_string(queue.port) + " is unbounded");
    for (const StreamBound& stream : bounds_.streams) {
      values_.rest_on(stream.assumptions);
      if (stream.hops.empty()) values_.add(0, std::nullopt, stream.reason);  // in no queue that was looked at
    }
  }

  /// The same of those that "only" names. What is in a queue, or on the wire, has preambles and gaps besides its
  /// octets.
  void add_queues_of_classes() {
    if (figure_.steps[1] != "*") return;
    for (const QueueBound& queue : bounds_.queues) {
      if (!is_meant(queue)) continue;
      const std::optional<std::uint64_t> octets = queue.bits ? std::optional(*queue.bits / 8) : std::nullopt;
      values_.add(0, number(figure_.steps[2] == "frames" ? queue.frames : octets),
                  "the queue of class " + std::to_string(queue.traffic_class) + " at " +
                      r_.plan.nodes[queue.node.value].name + ":" + std::to_string(queue.port) + " is unbounded");
    }
    for (const StreamBound& stream : bounds_.streams) {
      values_.rest_on(stream.assumptions);
      if (stream.hops.empty()) values_.add(0, std::nullopt, stream.reason);
    }
  }

  /// What "only" asks of it; the other end of a port is the node to which it is linked.
  bool is_meant(const QueueBound& queue) const {
    json::Node row = json::Node::object();
    row.add("node", json::Node::of_string(r_.plan.nodes[queue.node.value].name));
    row.add("port", json::Node::of_integer(queue.port));
    row.add("class", json::Node::of_integer(queue.traffic_class));
    for (const scenario::Neighbour& neighbour : r_.topology.neighbours[queue.node.value])
      if (neighbour.port == queue.port) row.add("peer", json::Node::of_string(r_.plan.nodes[neighbour.node].name));
    return std::ranges::all_of(figure_.only, [&](const auto& only) {
      const json::Node* const member = row.find(only.first);
      return member != nullptr && json::equal(*member, only.second);
    });
  }

  void add_threads() {
    const auto is_meant = [](const std::string& step, const std::string& name) { return step == "*" || step == name; };
    for (std::size_t a = 0; a < r_.applications.size(); ++a)
      for (std::size_t t = 0; t < r_.applications[a].threads.size(); ++t)
        if (is_meant(figure_.steps[1], r_.applications[a].name) &&
            is_meant(figure_.steps[3], r_.applications[a].threads[t].name))
          add_thread(a, t);
  }

  /// A gateway takes what has come out of its own buffer, which has other figures.
  void add_thread(std::size_t a, std::size_t t) {
    const scenario::ResolvedThread& thread = r_.applications[a].threads[t];
    const ThreadBound bound = thread_bound(r_, bounds_, a, t, from_);
    const bool is_opc_ua = !r_.topics[thread.topic].shape.is_dds;
    const auto zero_if = [&](bool is_certain, const std::string& reason) {
      values_.add(0, is_certain ? std::optional(0.0) : std::nullopt, reason);
    };
    const std::string& last = figure_.steps.back();
    if (has_steps(figure_, {"applications", "?", "threads", "?", "calls", "percent"}))
      values_.add(bound.is_tested ? std::optional(100.0) : std::nullopt, 100.0, bound.reason);
    else if (has_steps(figure_, {"applications", "?", "threads", "?", "response_ps", "?"}) && last != "count")
      add_response(bound, last == "deviation");
    else if (figure_.steps.size() != 5)
      return;
    else if (last == "missed")
      zero_if(bound.is_always_done, bound.reason);
    else if (thread.publishes && is_opc_ua && (last == "refused" || last == "timed_out"))
      values_.add(0, 0, {});
    else if (!thread.publishes && last == "lost")
      zero_if(bound.loses_nothing, bound.values_reason);
    else if (!thread.publishes && last == "overwritten" && is_opc_ua)
      zero_if(bound.most_found && *bound.most_found <= thread.buffer,
              bound.most_found ? "a call may find " + std::to_string(*bound.most_found) + " values, and " +
                                     std::to_string(thread.buffer) + " are kept"
                               : bound.values_reason);
    else
      return;
    values_.rest_on(bound.assumptions);
  }

  /// A thread of which no call takes place has no response.
  void add_response(const ThreadBound& bound, bool is_deviation) {
    const double least = number(bound.least_response);
    const double greatest = number(bound.greatest_response);
    if (!bound.is_always_done)
      values_.add(std::nullopt, std::nullopt, bound.reason);
    else if (is_deviation)
      values_.add(0, greatest - least, {});
    else
      values_.add(least, greatest, {});
  }

  /// What the network's graph is like is known.
  RequirementBound topology() const {
    json::Node result = json::Node::object();
    result.add("topology", scenario::topology_node(r_));
    RequirementBound bound;
    bound.figure.emplace();
    const std::optional<double> value = scenario::value_of(figure_, result);
    bound.figure->least = bound.figure->greatest = value;
    if (!value) bound.reason = "the network has no such figure";
    return bound;
  }

  const scenario::Resolved& r_;
  const Bounds& bounds_;
  const Figure& figure_;
  Duration from_;
  Values values_;
};

}  // namespace

DeliveredFrames frames_delivered(const scenario::Resolved& resolved, const StreamBound& bound, Duration from) {
  const auto& streams = resolved.scenario.streams;
  const auto stream =
      std::find_if(streams.begin(), streams.end(), [&](const scenario::Stream& s) { return s.name == bound.name; });
  if (stream == streams.end() || !stream->every) return {{}, {}, "how many frames there are is not known beforehand"};
  DeliveredFrames frames;
  const models::StreamPlan& plan = resolved.plan.streams[bound.index.value];
  const std::uint64_t listeners = plan.listeners.size();
  const ClockQuality clock = clock_quality(resolved, plan.talker, {});
  const Duration shortest =
      Duration::from_ps(stream->every->ps() - scaled_up(stream->every->ps(), clock.rate_ppt, 1'000'000'000'000));
  const Duration longest =
      Duration::from_ps(scaled_up(stream->every->ps(), 1'000'000'000'000 + clock.rate_ppt, 1'000'000'000'000));
  const Duration unsure = Duration::from_ps(2 * clock.error);
  if (!bound.reaches_all || !bound.latency) {
    frames.least = 0;
    frames.reason = !bound.reason.empty() ? bound.reason : bound.loss_reason;
  } else {
    // Whatever has been produced so early that it must have come; one more than whole periods if the first frame comes
    // with the first instant. A clock that is ahead at the start has passed the instants before, and one that is behind
    // shows the first one later.
    const std::optional<models::NodeClockPlan>& own = resolved.plan.nodes[plan.talker.value].clock;
    const Duration first = stream->offset.value_or(Duration()) - (own ? own->initial_offset : Duration());
    const Duration wait =
        Duration::from_ps(scaled_up(std::max(first, Duration()).ps(), one_ppt + clock.rate_ppt, one_ppt));
    const Duration last = resolved.scenario.duration - *bound.latency - stream->jitter - wait - from - unsure;
    const std::int64_t begun = from == Duration() && first >= Duration() ? 1 : 0;
    frames.least = last < Duration() ? 0 : static_cast<std::uint64_t>(last.ps() / longest.ps() + begun) * listeners;
  }
  const bool may_be_more = !resolved.plan.impairments.empty() || !resolved.redundancies.empty() ||
                           !resolved.scenario.faults.empty() || shortest <= Duration();
  if (may_be_more)
    frames.reason = frames.reason.empty()
                        ? "faults and redundancy may bring a frame more than once, or more frames than the talker's"
                        : frames.reason;
  else
    frames.greatest = static_cast<std::uint64_t>(
                          (resolved.scenario.duration - from + stream->jitter + unsure).ps() / shortest.ps() + 1) *
                      listeners;
  return frames;
}

RequirementBound bound_of_figure(const scenario::Resolved& resolved, const Bounds& bounds, const Figure& figure,
                                 Duration from, const ReactionBoundOf& reaction) {
  if (const std::optional<scenario::AskedReaction> asked = scenario::reaction_of(figure)) {
    RequirementBound bound = reaction(*asked);
    bound.figure = FigureRange{0.0, {}};
    if (bound.duration) bound.figure->greatest = number(*bound.duration) / figure.divisor;
    return bound;
  }
  return FigureBounder(resolved, bounds, figure, from).make();
}

}  // namespace takt::analysis
