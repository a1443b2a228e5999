// SPDX-License-Identifier: Apache-2.0
// Cyclic queuing and forwarding (IEEE 802.1Q Annex T): what a port receives in one cycle it sends in a later one, so a
// frame knows its cycle, and each cycle its frames.
#include <fmt/format.h>

#include <limits>
#include <map>
#include <numeric>

#include "analysis/port_analysis.hpp"
#include "json/quantity.hpp"

namespace takt::analysis {

using models::traffic_class_count;
using models::TrafficClass;

namespace {

Ps floor_to(Ps value, Ps unit) { return value - ((value % unit) + unit) % unit; }

std::string text_of(Ps length) { return json::to_text(sim::Duration::from_ps(length)); }

}  // namespace

/// How much later than what its cycle is decided by the last bit of a frame may come: the header, where frames are cut
/// through or preempted on the link.
Ps PortAnalysis::behind_its_header(const PortFlow& flow) const {
  return traffic_.links[flow.link].is_mixed ? octet_ * models::wire_length(flow.frame).count : 0;
}

/// What one cycle receives at most.
struct PortAnalysis::CycleOfCqf {
  std::vector<std::int64_t> frames;  // by flow of the port; 0 of those that CQF does not carry
  Ps work = 0;
  std::int64_t frames_in_all = 0;
};

/// Frames of the flow that come within a cycle of receiving, which lasts `length` at most. It is closed on one side:
/// what comes as it ends belongs to the next one.
std::int64_t PortAnalysis::frames_in_a_cycle(const PortFlow& flow, Ps length) const {
  const CqfPort& cqf = *model_.cqf;
  std::int64_t most =
      flow.arrivals.is_limited() ? flow.arrivals.count(length - 1) : std::numeric_limits<std::int64_t>::max();
  if (!flow.cyclic) return most;
  // The intervals of arrival that meet one cycle of receiving. Both repeat, so their distance takes all values that
  // differ by multiples of the greatest common divisor.
  const CyclicFrames& comes = *flow.cyclic;
  const Ps error = model_.clock.error;
  const Ps received_from = cqf.base + cqf.offset + cqf.forwarding_delay;
  const Ps width = comes.width + 2 * error;
  const Ps ends = comes.first + comes.width + error - received_from;
  const Ps step = std::gcd(comes.period, cqf.cycle);
  const Ps first = ends - floor_to(ends, step);
  const Ps reach = width + cqf.cycle - 1;
  const std::int64_t intervals = reach < first ? 0 : (reach - first) / comes.period + 1;
  const sim::int128 frames = static_cast<sim::int128>(intervals) * comes.frames;
  return frames < most ? static_cast<std::int64_t>(frames) : most;
}

PortAnalysis::CycleOfCqf PortAnalysis::count_cycle() const {
  struct Link {
    Ps work = 0;
    Ps longest = 0;
    std::int64_t frames = 0;
    Ps shortest = unbounded_ps;
  };
  CycleOfCqf all;
  all.frames.assign(traffic_.flows.size(), 0);
  std::map<std::size_t, Link> links;
  // By true time; a clock that is set right within the cycle may make it longer. A header may come before the cycle
  // ends, and the last bit after it.
  const Ps cycle = sum(stretched(model_.cqf->cycle), 2 * model_.clock.error);
  for (std::size_t f = 0; f < traffic_.flows.size(); ++f) {
    const PortFlow& flow = traffic_.flows[f];
    if (!is_in_cqf(flow.highest_class)) continue;
    const Ps work = octet_ * models::wire_length(flow.frame).count;
    const Ps least = octet_ * models::wire_length(flow.shortest.value_or(flow.frame)).count;
    const IncomingLink& incoming = traffic_.links[flow.link];
    std::int64_t frames = frames_in_a_cycle(flow, sum(cycle, behind_its_header(flow)));
    if (incoming.octet_time) {
      const Ps brought = sum((incoming.is_mixed ? 2 : 1) * work, scaled_up(cycle - 1, octet_, *incoming.octet_time));
      frames = std::min(frames, brought / least);
    }
    all.frames[f] = frames;
    Link& link = links[flow.link];
    link.work = sum(link.work, product(work, frames));
    link.longest = std::max(link.longest, work);
    link.shortest = std::min(link.shortest, least);
    link.frames = frames > unbounded_ps - link.frames ? unbounded_ps : link.frames + frames;
  }
  for (const auto& [number, link] : links) {
    const IncomingLink& incoming = traffic_.links[number];
    const Ps brought = incoming.octet_time ? sum((incoming.is_mixed ? 2 : 1) * link.longest,
                                                 scaled_up(cycle - 1, octet_, *incoming.octet_time))
                                           : unbounded_ps;
    all.work = sum(all.work, std::min(link.work, brought));
    all.frames_in_all =
        sum(all.frames_in_all, is_bounded(brought) ? std::min(link.frames, brought / link.shortest) : link.frames);
  }
  return all;
}

/// From when all frames of a buffer are there, or its gate opens, until the last bit of the last one. Classes that go
/// before may be busy by then: count from when they have begun to be, behind one frame of any class below them. Nothing
/// if that does not end.
std::optional<Ps> PortAnalysis::sent_in_a_cycle(TrafficClass q, Ps work) const {
  Ps block = std::max(blocking(q), gap_);
  for (TrafficClass h = 0; h < traffic_class_count; ++h)
    if (!is_in_cqf(h) && !demands_[h].is_empty() && goes_before(h, q))
      block = std::max(block, ClassDemand(traffic_, model_.cqf->classes, octet_).longest());
  Ps time = 0;
  for (int step = 0; step < most_steps; ++step) {
    const Ps next = sum(block, work, interference(q, time));
    if (next > longest_search_ps) return std::nullopt;
    if (next <= time) return time - gap_;
    time = next;
  }
  return std::nullopt;
}

/// Why the argument does not apply to the port, whatever comes; empty if it does.
std::string PortAnalysis::objection_to_cqf() const {
  const auto in_cqf = [&](const PortFlow& flow) {
    return is_in_cqf(flow.highest_class) || is_in_cqf(flow.lowest_class);
  };
  if (!std::all_of(traffic_.flows.begin(), traffic_.flows.end(),
                   [&](const PortFlow& flow) { return flow.uses_cqf || !in_cqf(flow); }))
    return "frames that do not pass the stream gate share the classes of cyclic queuing and forwarding";
  if (!model_.clock.is_synchronised) return "cyclic queuing and forwarding on clocks that drift apart";
  if (!model_.more_gates.empty())
    return "a gate list that the script sets in place of that of cyclic queuing and forwarding";
  if (config_.preemption) return "cyclic queuing and forwarding with preemption";
  const TrafficClass highest = models::highest_class(model_.cqf->classes);
  bool is_above_lowest = false;  // of the classes of CQF
  for (TrafficClass q = 0; q <= highest; ++q) {
    if (is_in_cqf(q) && (is_shaped(q) || is_shared(q) || config_.shaping.is_timed(q)))
      return "cyclic queuing and forwarding in classes with a shaper";
    if (!is_in_cqf(q) && is_above_lowest && !demands_[q].is_empty() && !is_work_conserving(q))
      return "a shaped class between those of cyclic queuing and forwarding";
    is_above_lowest = is_above_lowest || is_in_cqf(q);
  }
  return {};
}

SendingCycle PortAnalysis::sending_cycle(const PortFlow& flow, std::int64_t frames, Ps greatest_sent) const {
  const CqfPort& cqf = *model_.cqf;
  const Ps error = model_.clock.error;
  const Ps last_bit = octet_ * models::wire_length(flow.shortest.value_or(flow.frame)).count - gap_;
  const Ps until_sent = cqf.cycle * (cqf.buffers - 1) - cqf.offset -
                        cqf.forwarding_delay;  // from the start of the cycle in which a frame comes to the port
  const auto at_least = [&](Ps length) { return length >= 0 ? shrunk(length) : -stretched(-length); };
  const auto at_most = [&](Ps length) { return length >= 0 ? stretched(length) : -shrunk(-length); };
  SendingCycle made;
  made.least_wait = at_least(until_sent - cqf.cycle - behind_its_header(flow)) - 2 * error;
  made.greatest_wait = at_most(until_sent) + 2 * error;
  made.least_sent = std::max<Ps>(0, last_bit - error);
  made.greatest_sent = sum(greatest_sent, error);
  made.leaves = {cqf.base + shrunk(last_bit) - error, cqf.cycle,
                 stretched(greatest_sent) - shrunk(last_bit) + 2 * error, frames, cqf.base};
  if (!flow.cyclic || flow.cyclic->period != cqf.cycle) return made;
  const Ps received_from = cqf.base + cqf.offset + cqf.forwarding_delay;
  const auto cycle_of = [&](Ps arrival) { return received_from + floor_to(arrival - received_from, cqf.cycle); };
  made.follows = true;
  made.least_step = at_least(cycle_of(flow.cyclic->first - error) + until_sent - flow.cyclic->sent_from);
  made.greatest_step =
      at_most(cycle_of(flow.cyclic->first + flow.cyclic->width + error) + until_sent - flow.cyclic->sent_from);
  return made;
}

/// What comes in a cycle is sent in the next one but (buffers - 2), if it fits.
void PortAnalysis::bound_cqf() {
  const CqfPort& cqf = *model_.cqf;
  for (TrafficClass q = 0; q < traffic_class_count; ++q)
    if (is_in_cqf(q)) {
      bound_.classes[q].is_used = !demands_[q].is_empty();
      class_delay_[q] = unbounded_ps;
    }
  if (ClassDemand(traffic_, cqf.classes, octet_).is_empty()) return;
  const CycleOfCqf received = count_cycle();
  std::string reason = objection_to_cqf();
  Ps sent = 0;
  for (TrafficClass q = 0; q < traffic_class_count && reason.empty() && is_bounded(received.work); ++q)
    if (is_in_cqf(q)) sent = std::max(sent, sent_in_a_cycle(q, received.work).value_or(unbounded_ps));
  // Frames that come at the end of their cycle may find that of sending begun.
  Ps late = 0;
  for (const PortFlow& flow : traffic_.flows)
    if (is_in_cqf(flow.highest_class))
      late = std::max(late, cqf.offset + cqf.forwarding_delay + behind_its_header(flow) + 2 * model_.clock.error -
                                cqf.cycle * (cqf.buffers - 2));
  sent = sum(sent, late);
  const Ps window = shrunk(cqf.cycle - cqf.dead_time) - 2 * model_.clock.error;
  if (reason.empty() && !is_bounded(received.work))
    reason = "a stream without a least gap between its frames in cyclic queuing and forwarding";
  if (reason.empty() && !is_bounded(sent))
    reason = "the classes before those of cyclic queuing and forwarding leave no room for them";
  if (reason.empty() && sent > window)
    reason = fmt::format(
        "what comes in a cycle of cyclic queuing and forwarding does not fit into one: frames of {}, sent {} after it "
        "begins, of {}",
        text_of(received.work), text_of(sent), text_of(window));
  Ps longest = 0;
  for (std::size_t f = 0; f < traffic_.flows.size(); ++f) {
    const PortFlow& flow = traffic_.flows[f];
    if (!is_in_cqf(flow.highest_class)) continue;
    PortFlowBound& made = bound_.flows[f];
    const SendingCycle cycle = sending_cycle(flow, received.frames[f], sent);
    made.delay = reason.empty() ? sum(cycle.greatest_wait, cycle.greatest_sent) : unbounded_ps;
    made.least_delay = octet_ * models::wire_length(flow.shortest.value_or(flow.frame)).count - gap_ +
                       (reason.empty() ? std::max<Ps>(0, cycle.least_wait) : 0);
    if (reason.empty()) made.cycle = cycle;
    longest = std::max(longest, made.delay);
  }
  for (TrafficClass q = 0; q < traffic_class_count; ++q) {
    if (!is_in_cqf(q)) continue;
    bound_.classes[q].reason = reason;
    if (!reason.empty()) continue;
    class_delay_[q] = longest;
    bound_.classes[q].backlog = received.work;  // a buffer is empty before it is filled anew
    bound_.classes[q].backlog_frames = received.frames_in_all;
  }
}

}  // namespace takt::analysis
