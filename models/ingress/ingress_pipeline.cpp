// SPDX-License-Identifier: Apache-2.0
#include "models/ingress/ingress_pipeline.hpp"

#include <algorithm>
#include <utility>

#include "models/ethernet/sizes.hpp"

namespace takt::models {

IngressPipeline::IngressPipeline(Traffic& traffic, const IngressConfig& config, const LocalClock& clock,
                                 sim::ComponentId where, std::uint32_t first_group, sim::Duration forwarding_delay)
    : traffic_(&traffic),
      config_(&config),
      clock_(&clock),
      where_(where),
      forwarding_delay_(forwarding_delay),
      streams_(config.stream_identity_table, first_group) {
  for (const StreamFilterConfig& filter : config.stream_filters) filters_.add(filter);
  gates_.reserve(config.stream_gates.size());
  for (const StreamGateConfig& gate : config.stream_gates) gates_.emplace_back(gate);
  for (const NamedFlowMeterConfig& meter : config.flow_meters)
    meters_.push_back({meter, FlowMeter(meter.meter), {}, 0});
  for (const AtsSchedulerConfig& scheduler : config.ats_schedulers)
    schedulers_.push_back(
        {scheduler,
         AtsScheduler(scheduler.committed_information_rate, std::uint64_t{8} * scheduler.committed_burst_size.count),
         0,
         0,
         {}});
  for (const AtsGroupConfig& group : config.ats_groups) groups_.push_back({group.maximum_residence_time, {}, 0});
  for (const IngressSplit& split : config.splits) splits_.push_back({split.stream, StreamSplit(split.split, where)});
  for (const IngressRecovery& recovery : config.recoveries)
    recoveries_.push_back({recovery.stream, StreamRecovery(recovery.recovery, where)});
  for (std::uint32_t i = 0; i < config.stream_filters.size(); ++i) {
    const StreamFilterConfig& filter = config.stream_filters[i];
    Instances of{Instances::Kind::other, &filters_[StreamFilterIndex{i}],
                 filter.stream_gate.is_none() ? nullptr : &gates_[filter.stream_gate.value],
                 filter.flow_meter.is_none() ? nullptr : &meters_[filter.flow_meter.value],
                 filter.ats_scheduler.is_none() ? nullptr : &schedulers_[filter.ats_scheduler.value]};
    if (of.gate == nullptr && of.scheduler == nullptr && of.meter != nullptr) of.kind = Instances::Kind::meter;
    if (of.gate == nullptr && of.meter == nullptr && of.scheduler != nullptr) of.kind = Instances::Kind::scheduler;
    instances_.push_back(of);
  }
  lay_out_functions();
}

void IngressPipeline::lay_out_functions() {
  functions_.resize(config_->streams.size() + 1);
  for (std::size_t i = 0; i < functions_.size(); ++i) {
    const StreamHandle handle =
        i < config_->streams.size() ? StreamHandle{static_cast<std::uint32_t>(i)} : StreamHandle{};
    for (Priority priority = 0; priority < 8; ++priority) {
      std::uint32_t filter = 0;
      while (filter < filters_.size() && !filters_[StreamFilterIndex{filter}].matches(handle, priority)) ++filter;
      functions_[i].filter_of_priority[priority] = filter < filters_.size() ? filter : none;
    }
  }
  const auto functions_of = [&](StreamHandle stream) -> Functions& {
    TAKT_CHECK(stream.value < config_->streams.size(), "a function belongs to a stream of the bridge");
    return functions_[stream.value];
  };
  for (std::uint32_t i = 0; i < splits_.size(); ++i) functions_of(splits_[i].stream).split = i;
  for (std::uint32_t i = 0; i < recoveries_.size(); ++i) functions_of(recoveries_[i].stream).recovery = i;
  for (const StreamIdentityEntry& entry : config_->stream_identity_table) functions_of(entry.stream);
  alone_.resize(config_->streams.size());
  for (std::size_t i = 0; i < alone_.size(); ++i) {
    if (functions_[i].recovery != none || functions_[i].split != none) continue;
    for (Priority priority = 0; priority < 8; ++priority) {
      const std::uint32_t filter = functions_[i].filter_of_priority[priority];
      if (filter != none && instances_[filter].kind != Instances::Kind::other)
        alone_[i][priority] = &instances_[filter];
    }
  }
}

inline AtsGroup* IngressPipeline::known_group_of(const Scheduler& scheduler, const Frame& frame, std::uint16_t port) {
  if (!scheduler.config.group.is_none()) return &groups_[scheduler.config.group.value];
  if (port >= ports_with_groups_) [[unlikely]]
    return nullptr;
  return &port_groups_[port * std::size_t{traffic_class_count} + config_->traffic_class_of_priority[frame.priority]];
}

AtsGroup& IngressPipeline::group_of(const Scheduler& scheduler, const Frame& frame, std::uint16_t port) {
  if (scheduler.config.group.is_none() && port >= ports_with_groups_) make_groups_of(port);
  return *known_group_of(scheduler, frame, port);
}

void IngressPipeline::make_groups_of(std::uint16_t port) {
  ports_with_groups_ = port + 1u;
  port_groups_.resize(ports_with_groups_ * std::size_t{traffic_class_count}, {config_->maximum_residence_time, {}, 0});
}

inline Octets IngressPipeline::length_for(const Scheduler& scheduler, const Frame& frame) {
  return scheduler.config.media_overhead ? wire_length(Octets{frame.length}) : Octets{frame.length};
}

/// An R-TAG is part of what the VLAN tag carries.
inline Octets IngressPipeline::msdu_of(const Frame& frame) {
  return Octets{frame.msdu} + (frame.r_tagged ? r_tag : Octets{0});
}

inline void IngressPipeline::mark_eligible(Frame& frame, sim::LocalTime arrival) {
  frame.eligible = arrival;
  frame.queue_priority = frame.priority;
  frame.marked = true;
}

/// A frame of a filter with a meter or a scheduler alone, most of which find a full bucket. It calls nothing but what
/// it ends with, so that this saves no registers.
bool IngressPipeline::passes_as_it_is(Frame& frame, std::uint16_t port, sim::TrueTime on_wire) {
  const StreamTable::Found* const found = streams_.find_by_address(frame);
  if (found == nullptr || !clock_->is_ideal()) return false;
  const Instances* const instances = alone_[found->stream.value][frame.priority];
  if (instances == nullptr || !instances->filter->accepts_fast(msdu_of(frame))) return false;
  AtsGroup* group = nullptr;
  if (instances->kind == Instances::Kind::meter) {
    const sim::LocalTime arrival = clock_->local_at(on_wire);
    if (!instances->meter->meter.finds_full(Octets{frame.length}, arrival)) [[unlikely]]
      return finds_enough(*instances, frame, arrival, group);
    ++instances->meter->frames[static_cast<std::size_t>(FrameColor::green)];
  } else {
    const sim::LocalTime arrival = clock_->local_at(on_wire + forwarding_delay_);
    Scheduler& scheduler = *instances->scheduler;
    group = known_group_of(scheduler, frame, port);
    if (frame.references != 1 || group == nullptr) return false;
    if (!scheduler.scheduler.passes_full(length_for(scheduler, frame), arrival, *group)) [[unlikely]]
      return finds_enough(*instances, frame, arrival, group);
    ++scheduler.passed;
    mark_eligible(frame, arrival);
  }
  instances->filter->count_passed();
  return true;
}

/// The same of one that finds a bucket which may not be full.
bool IngressPipeline::finds_enough(const Instances& instances, Frame& frame, sim::LocalTime arrival, AtsGroup* group) {
  if (instances.kind == Instances::Kind::meter) {
    if (!instances.meter->meter.finds_enough(Octets{frame.length}, arrival)) return false;
    ++instances.meter->frames[static_cast<std::size_t>(FrameColor::green)];
  } else {
    Scheduler& scheduler = *instances.scheduler;
    if (!scheduler.scheduler.passes_at_once(length_for(scheduler, frame), arrival, *group)) return false;
    ++scheduler.passed;
    mark_eligible(frame, arrival);
  }
  instances.filter->count_passed();
  return true;
}

std::span<const FrameIndex> IngressPipeline::pass(sim::Simulation& simulation, Ingress ingress) {
  if (!passes_as_it_is(traffic_->frame(ingress.frame), ingress.port, ingress.on_wire))
    return pass_slow(simulation, ingress);
  out_ = ingress.frame;
  return {&out_, 1};
}

std::span<const FrameIndex> IngressPipeline::pass_slow(sim::Simulation& simulation, Ingress ingress) {
  FrameIndex frame = ingress.frame;
  const StreamTable::Found found = streams_.identify(traffic_->frame(frame));
  if (found.stream.is_none()) ++unidentified_frames_;
  const Functions& functions = functions_of(found.stream);
  const bool is_member = found.member != StreamTable::no_member;

  if (functions.recovery != none && (is_member || traffic_->frame(frame).r_tagged)) {
    const std::size_t member = is_member ? found.member : StreamRecovery::no_member;
    const std::optional<FrameIndex> passed = recoveries_[functions.recovery].recovery.receive(
        *traffic_, frame, member, ingress.port, clock_->unstepped_at(ingress.on_wire));
    if (!passed) {
      traffic_->drop(frame, DropReason::duplicate, where_, simulation);
      return {};
    }
    frame = *passed;
  }
  if (!police(simulation, frame, ingress, functions)) return {};
  // Members that are not recovered here pass; what has been made one again is copied anew, but not back to where it
  // came from.
  if (functions.split != none && (!is_member || functions.recovery != none))
    return splits_[functions.split].split.split(*traffic_, frame, is_member ? ingress.port : StreamSplit::any_port);
  out_ = frame;
  return {&out_, 1};
}

/// Per-stream filtering, policing and shaping. False: the frame was discarded. `index` is the record that goes on
/// otherwise.
bool IngressPipeline::police(sim::Simulation& simulation, FrameIndex& index, const Ingress& ingress,
                             const Functions& functions) {
  const Frame& frame = traffic_->frame(index);
  const std::uint32_t number = functions.filter_of_priority[frame.priority];
  if (number == none) return true;
  const Instances& instances = instances_[number];
  StreamFilter& filter = *instances.filter;
  const Octets msdu = msdu_of(frame);
  if (!filter.accept(msdu)) return discard(simulation, index, DropReason::stream_max_sdu);

  const sim::LocalTime arrival = clock_->local_at(ingress.on_wire);
  std::optional<Priority> ipv;
  if (instances.gate != nullptr) {
    const StreamGate::Verdict verdict = instances.gate->admit(msdu, arrival);
    if (verdict.outcome != StreamGate::Outcome::passed) {
      filter.count_gate(false);
      return discard(simulation, index, DropReason::stream_gate);
    }
    ipv = verdict.ipv;
  }
  filter.count_gate(true);

  bool drop_eligible = frame.drop_eligible;
  if (instances.meter != nullptr) {
    Meter& meter = *instances.meter;
    const FlowMeter::Verdict verdict =
        meter.meter.meter(Octets{frame.length}, drop_eligible, clock_->unstepped_at(ingress.on_wire));
    ++meter.frames[static_cast<std::size_t>(verdict.color)];
    if (!verdict.pass) {
      ++meter.discarded;
      filter.count_red();
      return discard(simulation, index, DropReason::flow_meter);
    }
    drop_eligible = verdict.drop_eligible;
  }

  std::optional<sim::LocalTime> eligible;
  const sim::LocalTime through = clock_->local_at(ingress.on_wire + forwarding_delay_);
  if (instances.scheduler != nullptr) {
    eligible = shape(*instances.scheduler, frame, ingress.port, through);
    if (!eligible) return discard(simulation, index, DropReason::residence_time);
  }

  if (!ipv && !eligible && drop_eligible == frame.drop_eligible) return true;
  index = traffic_->own(index, where_);
  Frame& own = traffic_->frame(index);
  own.drop_eligible = drop_eligible;
  if (ipv || eligible) {
    own.queue_priority = ipv.value_or(own.priority);
    own.eligible = eligible.value_or(through);
    own.marked = true;
  }
  return true;
}

bool IngressPipeline::discard(sim::Simulation& simulation, FrameIndex frame, DropReason reason) {
  traffic_->drop(frame, reason, where_, simulation);
  return false;
}

std::optional<sim::LocalTime> IngressPipeline::shape(Scheduler& scheduler, const Frame& frame, std::uint16_t port,
                                                     sim::LocalTime arrival) {
  const std::optional<sim::LocalTime> eligible =
      scheduler.scheduler.process(length_for(scheduler, frame), arrival, group_of(scheduler, frame, port));
  ++(eligible ? scheduler.passed : scheduler.discarded);
  if (eligible) scheduler.longest_hold = std::max(scheduler.longest_hold, *eligible - arrival);
  return eligible;
}

const std::vector<IngressPipeline::Recovery>& IngressPipeline::recoveries(sim::TrueTime now) {
  for (Recovery& recovery : recoveries_) recovery.recovery.catch_up(clock_->unstepped_at(now));
  return recoveries_;
}

}  // namespace takt::models
