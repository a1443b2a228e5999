#include "models/egress/egress_port.hpp"

#include <algorithm>
#include <utility>

namespace takt::models {
namespace {

/// Stable, in place and without allocation; the frames of one instant are few.
template <class Arrivals>
void sort_by_rank(Arrivals& arrivals) {
  for (std::size_t i = 1; i < arrivals.size(); ++i)
    for (std::size_t j = i; j > 0 && arrivals[j].rank < arrivals[j - 1].rank; --j) std::swap(arrivals[j], arrivals[j - 1]);
}

}  // namespace

void EgressPort::connect(sim::Simulation& simulation, sim::ComponentId node, Shared& shared, const PortConfig& config, const LocalClock& clock,
                         sim::Duration octet_time, LinkEnd far_end, Link& incoming) {
  TAKT_CHECK(shared_ == nullptr, "a port has one link");
  const sim::ComponentId id = simulation.add(*this);
  simulation.group(id, node);
  link_.connect(id, node, *shared.traffic, octet_time, far_end);
  shared_ = &shared;
  config_ = &config;
  clock_ = &clock;
  incoming_ = &incoming;
  ranked_ = static_cast<ClassSet>(~config.shaping.shared());
  if (!config.shaping.is_plain()) make_shaping();
  if (config.preemption || config.cut_through != 0 || config.untagged || ranked_ != every_class) make_extras();
  if (config.preemption) extras_->merge = std::make_unique<MacMerge>(*config.preemption, octet_time);
  if (config.cut_through != 0) link_.check_arrivals();
}

void EgressPort::find_path() {
  if (only_merges_ && queues_.empty() && !extras_->merge->rest())
    path_ = Path::merging;
  else
    path_ = !queues_.empty() || extras_ ? Path::general : !shaping_ ? Path::plain : only_gates_ != nullptr ? Path::gated : shaping_->limits_sdu() ? Path::general : Path::shaped;
}

/// To be called when the port gets other features.
void EgressPort::find_gates() {
  only_gates_ = shaping_ && !extras_ && shaping_->has_only_gates() ? &shaping_->gates() : nullptr;
  only_merges_ = extras_ && extras_->merge && !shaping_ && link_.is_plain() && !extras_->expects_headers;
  open_until_ = {};
  find_path();
}

PortShaping& EgressPort::make_shaping() {
  if (!shaping_) shaping_ = std::make_unique<PortShaping>(config_->shaping, *clock_, octet_time());
  find_gates();
  return *shaping_;
}

EgressPort::Extras& EgressPort::make_extras() {
  if (!extras_) extras_ = std::make_unique<Extras>();
  return *extras_;
}

void EgressPort::prepare() {
  if (!link_.is_plain()) make_extras();
  find_gates();
}

void EgressPort::handle(sim::Simulation& simulation, const sim::Event& event) {
  if (event.kind() == wake_up) [[likely]] {
    if (sole_sender_) [[unlikely]] simulation.uncount_event();   // there for the recorder only
    wake(simulation, event.time);
  } else if (event.kind() == sim::Simulation::decide_now) {
    simulation.uncount_event();
    simulation.decide_later(id(), sim::Decision::egress);
  } else {
    take_stored(simulation, event);
  }
}

inline void EgressPort::wake(sim::Simulation& simulation, sim::TrueTime time) {
  if (time != wake_at_) return;  // an earlier wake-up took its place
  wake_at_ = sim::TrueTime::never();
  if (simulation.is_last()) [[likely]]
    settle_many(simulation);
  else
    decide_later(simulation);
}

void EgressPort::offer(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank) {
  decide_later(simulation);
  if (!has_arrival_) {
    has_arrival_ = true;
    arrival_ = {frame, rank};
  } else {
    more_arrivals_.push_back({frame, rank});
  }
}

/// One frame has come to a port with gates or shapers where nothing waits.
void EgressPort::settle_one(sim::Simulation& simulation, FrameIndex frame) {
  has_arrival_ = false;
  if (!shaping_->limits_sdu() || passes_max_sdu(simulation, frame)) {
    if (simulation.now() >= link_.free_at()) {
      pass_shaping(simulation, frame, shared_->traffic->frame(frame));
    } else {
      shaping_->frame_waits(simulation.now(), class_of(frame));
      admit(simulation, frame);
      if (!queues_.empty()) wake_at(simulation, link_.free_at());
    }
  }
  find_path();
}

/// One frame has come to a busy medium at a port that has gates at most: whatever waits, it waits, too.
void EgressPort::wait_for_medium(sim::Simulation& simulation, FrameIndex frame) {
  has_arrival_ = false;
  promised_ = sim::TrueTime::never();
  path_ = Path::general;
  admit(simulation, frame);
  has_new_head_ = false;   // the heads are looked at when the medium is free
  if (!queues_.empty()) wake_at(simulation, link_.free_at());
}

/// One frame has come to a free medium at a port with gates and nothing else, where others wait: it waits behind them if they are of its class, and have been promised when they may start.
void EgressPort::wait_for_gate(sim::Simulation& simulation, FrameIndex frame) {
  const bool is_promised = simulation.now() < promised_ && promised_ != sim::TrueTime::never() && queues_.waiting() == only(class_of(frame));
  if (is_promised && simulation.trace() == nullptr) {
    has_arrival_ = false;
    admit(simulation, frame);
    if (!has_new_head_) [[likely]] return;
    has_new_head_ = false;
  }
  settle_all_classes(simulation);
}

/// The common case of a port that wakes up: frames of one class wait.
void EgressPort::settle_waiting(sim::Simulation& simulation) {
  const sim::TrueTime now = simulation.now();
  if (now < link_.free_at()) {
    wake_at(simulation, link_.free_at());
    return;
  }
  const TrafficClass q = highest_class(queues_.waiting());
  const FrameIndex frame = queues_.head(q, shared_->entries);
  const Frame& record = shared_->traffic->frame(frame);
  const bool is_ready = !shaping_ || promised_ == now || (only_gates_ != nullptr && is_in_known_window(now, q, record));
  const sim::TrueTime ready = is_ready ? now : shaping_->ready_time(now, q, {record.length, eligible_of(record)});
  if (ready != now) {
    if (simulation.trace() != nullptr) [[unlikely]] tell_refusal(simulation, q, frame, ready);
    wake_at(simulation, ready);
    return;
  }
  pop(simulation, q);
  if (shaping_) {
    shaping_->started(now, q, record.length, queues_.empty());
    sending_ = q;
  }
  start(simulation, frame, record);
  if (queues_.empty())
    find_path();
  else
    wake_at(simulation, link_.free_at());
}

/// Which way is that of what has come and waits. Like those for a frame that comes alone it ends with what it calls.
void EgressPort::settle_many(sim::Simulation& simulation) {
  if (extras_ || !more_arrivals_.empty()) [[unlikely]]
    only_merges_ && more_arrivals_.empty() ? settle_merging(simulation) : settle_all_classes(simulation);
  else if (!has_arrival_)
    is_one_class(queues_.waiting()) ? settle_waiting(simulation) : settle_all_classes(simulation);
  else if (simulation.now() < link_.free_at() && (!shaping_ || only_gates_ != nullptr))
    wait_for_medium(simulation, arrival_.frame);
  else if (shaping_ && queues_.empty())
    settle_one(simulation, arrival_.frame);
  else if (only_gates_ != nullptr)
    wait_for_gate(simulation, arrival_.frame);
  else
    settle_all_classes(simulation);
}

/// The general path: whatever has come at this instant and waits. One frame starts, if it may, and the others wait.
void EgressPort::settle_all_classes(sim::Simulation& simulation) {
  promised_ = sim::TrueTime::never();
  if (has_arrival_) more_arrivals_.insert(more_arrivals_.begin(), arrival_);
  has_arrival_ = false;
  if (!link_.is_up()) {
    for (const Arrival& arrival : more_arrivals_) give_up(simulation, arrival.frame, DropReason::link_down);
    more_arrivals_.clear();
    store_headers(simulation, Storing::link_down);
    return;
  }
  sort_by_rank(more_arrivals_);
  const sim::TrueTime now = simulation.now();
  if (!shaping_ && !extras_) {  // only the classes count: worth a path of its own, since such ports are most of all
    if (now >= link_.free_at()) start_highest(simulation);
    admit_arrivals(simulation);
    find_path();
    if (!queues_.empty()) wake_at(simulation, link_.free_at());
    return;
  }
  if (shaping_) {
    std::erase_if(more_arrivals_, [&](const Arrival& arrival) { return !passes_max_sdu(simulation, arrival.frame); });
    for (const Arrival& arrival : more_arrivals_) shaping_->frame_waits(now, class_of(arrival.frame));
  }
  MacMerge* const merge = extras_ ? extras_->merge.get() : nullptr;
  sim::TrueTime next = link_.free_at();
  if (now >= next) {
    if (simulation.trace() != nullptr) [[unlikely]] tell_refusals(simulation);
    const Selection selection = select_at_free_medium(now);
    next = selection.ask_again;
    if (selection.found) {
      if (selection.is_rest)
        resume(simulation);
      else
        start_first(simulation, selection);
    }
    if (selection.found || cut_through(simulation)) {
      // An express frame that waits for its gate or its credit may want to cut what has just started.
      next = merge == nullptr ? link_.free_at() : merge->under_way() ? look_while_busy(simulation) : when_to_look(now);
      store_headers(simulation, Storing::goes_first);
    }
    admit_arrivals(simulation);
  } else {
    // A frame that finds no room is no reason to cut another one.
    admit_arrivals(simulation);
    if (merge != nullptr) next = look_while_busy(simulation);
    store_headers(simulation, Storing::medium_busy);
  }
  if (has_new_head_) [[unlikely]] {
    // What was selected, or asked to come again, knew other heads: those of now may start although the ones before them might not.
    has_new_head_ = false;
    settle_all_classes(simulation);
    return;
  }
  find_path();
  if (!queues_.empty() || merge != nullptr) wake_at(simulation, next);
}

inline void EgressPort::start_highest(sim::Simulation& simulation) {
  int greatest = queues_.empty() ? -1 : highest_class(queues_.waiting());
  std::size_t first = more_arrivals_.size();  // none of this instant, but the head of a queue
  for (std::size_t i = 0; i < more_arrivals_.size(); ++i) {
    const int q = class_of(more_arrivals_[i].frame);
    if (q <= greatest) continue;
    greatest = q;
    first = i;
  }
  if (first < more_arrivals_.size()) {
    start(simulation, more_arrivals_[first].frame);
    more_arrivals_.erase(more_arrivals_.begin() + static_cast<std::ptrdiff_t>(first));
  } else if (greatest >= 0) {
    start(simulation, pop(simulation, static_cast<TrafficClass>(greatest)));
  }
}

inline void EgressPort::admit_arrivals(sim::Simulation& simulation) {
  for (const Arrival& arrival : more_arrivals_) admit(simulation, arrival.frame);
  more_arrivals_.clear();
}

/// The classes that have a frame, in their queue or among those of this instant.
ClassSet EgressPort::candidates() const {
  ClassSet candidates = queues_.waiting();
  for (const Arrival& arrival : more_arrivals_) candidates = with(candidates, class_of(arrival.frame));
  return candidates;
}

/// The first frame of a class: the head of its queue, or of those of this instant. In a timed class the one with the earliest time.
EgressPort::First EgressPort::first_of(TrafficClass q) const {
  First first;
  if (queues_.frames(q) > 0) first.frame = queues_.head(q, shared_->entries);
  const bool is_timed = shaping_ && shaping_->is_timed(q);
  for (std::uint32_t i = 0; i < more_arrivals_.size(); ++i) {
    const FrameIndex frame = more_arrivals_[i].frame;
    if (class_of(frame) != q || (!first.frame.is_none() && !(is_timed && eligible_of(frame) < eligible_of(first.frame)))) continue;
    first = {frame, i};
  }
  return first;
}

/// Of these classes the most urgent one that may start, now or `delay` later. No lower one is blocked by a higher one that may not (IEEE
/// 802.1Q 8.6.8). Classes that share bandwidth come behind all others.
EgressPort::Selection EgressPort::select(sim::TrueTime now, ClassSet classes, sim::Duration delay) {
  Selection selection;
  for (ClassSet left = candidates() & classes & ranked_; left != 0 && !selection.found; left = without(left, selection.traffic_class)) {
    selection.traffic_class = highest_class(left);
    selection.first = first_of(selection.traffic_class);
    const FrameIndex frame = selection.first.frame;
    const sim::TrueTime ready = shaping_ ? shaping_->ready_time(now, selection.traffic_class, {shared_->traffic->frame(frame).length, eligible_of(frame)}, delay) : now;
    selection.found = ready == now;
    if (!selection.found) selection.ask_again = std::min(selection.ask_again, ready);
  }
  if (!selection.found && ranked_ != every_class) select_by_share(now, candidates() & classes & static_cast<ClassSet>(~ranked_), delay, selection);
  return selection;
}

/// Express frames come first; then the rest of a frame that was cut, before any other preemptable one.
EgressPort::Selection EgressPort::select_at_free_medium(sim::TrueTime now) {
  if (!extras_ || !extras_->merge) return select(now, every_class);
  const MacMerge& merge = *extras_->merge;
  const Selection express = select(now, static_cast<ClassSet>(~merge.preemptable()));
  if (express.found) return express;
  Selection other;
  if (merge.rest() || (candidates() & merge.preemptable()) != 0) {
    if (const HoldRequest hold = hold_request(now); hold.hold)
      other.ask_again = hold.until == sim::LocalTime::never() ? sim::TrueTime::never() : clock_->true_at(hold.until);
    else if (merge.rest())
      other = select_rest(now, *merge.rest());
    else
      other = select(now, merge.preemptable());
  }
  if (!other.found) other.ask_again = std::min(other.ask_again, express.ask_again);
  return other;
}

/// When to look again after a frame has started: at its end, or at a port that preempts when the MAC will be asked to hold.
sim::TrueTime EgressPort::when_to_look(sim::TrueTime now) {
  if (!extras_ || !extras_->merge) return link_.free_at();
  const MacMerge& merge = *extras_->merge;
  sim::TrueTime next = queues_.empty() && more_arrivals_.empty() && !merge.rest() ? sim::TrueTime::never() : link_.free_at();
  if (merge.under_way() && now < link_.free_at()) {
    const HoldRequest hold = hold_request(now);
    if (!hold.hold && hold.until != sim::LocalTime::never())
      if (const sim::TrueTime begin = clock_->true_at(hold.until); begin < link_.free_at()) next = std::min(next, begin);
  }
  return next;
}

void EgressPort::start_first(sim::Simulation& simulation, const Selection& selection) {
  const TrafficClass q = selection.traffic_class;
  if (selection.first.is_in_queue())
    pop(simulation, q);
  else
    more_arrivals_.erase(more_arrivals_.begin() + selection.first.arrival);
  const bool is_last = shaping_ && !contains(candidates(), q);
  start_selected(simulation, selection.first.frame, q, is_last);
}

FrameIndex EgressPort::pop(sim::Simulation& simulation, TrafficClass q) {
  const FrameIndex frame = queues_.pop(q, shared_->entries);
  if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]]
    trace->record({simulation.now(), static_cast<std::uint32_t>(Occurrence::dequeued), id(), frame.value, q});
  return frame;
}

void EgressPort::start_selected(sim::Simulation& simulation, FrameIndex frame, TrafficClass q, bool queue_is_empty) {
  if (shaping_) {
    shaping_->started(simulation.now(), q, shared_->traffic->frame(frame).length, queue_is_empty);
    sending_ = q;
  }
  if (extras_)
    start_with_extras(simulation, frame, q);
  else
    start(simulation, frame);
}

bool EgressPort::passes_max_sdu(sim::Simulation& simulation, FrameIndex frame) {
  const Frame& record = shared_->traffic->frame(frame);
  const std::uint32_t msdu = record.msdu + (record.r_tagged ? r_tag.count : 0);
  if (shaping_->fits_max_sdu(config_->traffic_class_of_priority[record.queue_priority], msdu)) return true;
  give_up(simulation, frame, DropReason::queue_max_sdu);
  return false;
}

void EgressPort::admit(sim::Simulation& simulation, FrameIndex frame) {
  const Frame& record = shared_->traffic->frame(frame);
  const TrafficClass q = config_->traffic_class_of_priority[record.queue_priority];
  DropReason reason{};
  const bool has_room = queues_.has_room(q, record.length, config_->queue_limits[q], reason);
  if (!has_room || simulation.trace() != nullptr || (shaping_ && shaping_->is_timed(q))) [[unlikely]]
    admit_closely(simulation, frame, record, q);
  else
    queues_.push(q, frame, record.length, shared_->entries);
}

/// To a full queue, to one that is not in the order of coming, or where somebody wants to know.
void EgressPort::admit_closely(sim::Simulation& simulation, FrameIndex frame, const Frame& record, TrafficClass q) {
  DropReason reason{};
  if (!queues_.has_room(q, record.length, config_->queue_limits[q], reason)) {
    admit_to_full_queue(simulation, frame, q, reason);
    return;
  }
  if (shaping_ && shaping_->is_timed(q))
    queues_.push_in_order(q, frame, record.length, shared_->entries, [this](FrameIndex f) { return eligible_of(f); });
  else
    queues_.push(q, frame, record.length, shared_->entries);
  if (sim::TraceSink* const trace = simulation.trace())
    trace->record({simulation.now(), static_cast<std::uint32_t>(Occurrence::enqueued), id(), frame.value, q});
}

/// The frame is lost, or, if it is to be so and it fits at all, the oldest ones are until it fits.
void EgressPort::admit_to_full_queue(sim::Simulation& simulation, FrameIndex frame, TrafficClass q, DropReason reason) {
  const std::uint32_t length = shared_->traffic->frame(frame).length;
  const QueueLimit& limit = config_->queue_limits[q];
  if (!limit.drops_oldest || limit.frames == 0 || length > limit.octets) {
    give_up(simulation, frame, reason);
    if (shaping_ && queues_.frames(q) == 0) shaping_->none_waits(simulation.now(), q);
    return;
  }
  do give_up(simulation, pop(simulation, q), reason);
  while (!queues_.has_room(q, length, limit, reason));
  has_new_head_ = shaping_ != nullptr;   // without gates and shapers every head is ready
  admit(simulation, frame);
}

void EgressPort::give_up(sim::Simulation& simulation, FrameIndex frame, DropReason reason) {
  ++frames_dropped_;
  shared_->traffic->drop(frame, reason, id(), simulation);
}

/// Puts a frame on the free medium. Nothing that is called here comes back, so that the common case saves no registers.
void EgressPort::start(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
  if (record.link_local || simulation.trace() != nullptr) [[unlikely]]
    start_announced(simulation, frame, record);
  else if (link_.folds_latency()) [[unlikely]]   // at the edge of a network only
    link_.transmit_folded(simulation, frame, record);
  else
    link_.transmit(simulation, frame, record);
}

/// The same where somebody wants to know.
void EgressPort::start_announced(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
  if (record.link_local) shared_->link_local->transmission_starts(simulation, id(), frame);
  if (link_.folds_latency() && !record.link_local)
    link_.transmit_folded(simulation, frame, record);
  else
    link_.transmit(simulation, frame, record);
  if (sim::TraceSink* const trace = simulation.trace())
    trace->record({simulation.now(), static_cast<std::uint32_t>(Occurrence::started), id(), frame.value, TransmissionDetail{record.length, class_of(frame)}.pack()});
}

void EgressPort::wake_at(sim::Simulation& simulation, sim::TrueTime time) {
  if (time >= wake_at_) return;
  wake_at_ = time;
  link_.schedule_for_sender(simulation, time, wake_up, 0);
}

}  // namespace takt::models
