// SPDX-License-Identifier: Apache-2.0
#include "tests/wire_checker/port_checker.hpp"

#include <algorithm>

#include "models/ethernet/sizes.hpp"

namespace takt::wire_checker {

using models::traffic_class_count;
using models::TrafficClass;

PortChecker::PortChecker(std::string name, const models::PortConfig& config, sim::DataRate rate, Violations& violations)
    : name_(std::move(name)),
      config_(config),
      violations_(violations),
      octet_(rate.octet_time().ps()),
      gates_(ListEntry{{}, config.shaping.admin_gate_states, 0, {}, {}}),
      has_gates_(config.shaping.admin_gate_states != models::all_gates_open),
      shares_(config.shaping) {
  for (TrafficClass q = 0; q < traffic_class_count; ++q)
    if (const models::CreditBased* const shaper = config.shaping.shaper_of(q))
      credits_[q].emplace(rate.bits_per_second, *shaper, q);
  // An express frame waits for at most 8 + 123 + 12 octets, and 64 more for each addFragSize.
  if (config.preemption)
    hold_advance_ = config.preemption->hold_advance ? config.preemption->hold_advance->ps()
                                                    : octet_ * (143 + 64 * config.preemption->add_frag_size.value());
  if (config.shaping.gates) {
    note_gates(list_config_of(*config.shaping.gates));
    gates_.start_with(list_config_of(*config.shaping.gates), config.shaping.gates->is_running);
  }
  advance_gates();
}

void PortChecker::request_gates(const ListConfig& gates) {
  gates_.request(now_, gates);
  note_gates(gates);
}

void PortChecker::note_gates(const ListConfig& gates) {
  has_gates_ = true;
  may_hold_ = may_hold_ || std::any_of(gates.list.begin(), gates.list.end(), [](const ListEntry& entry) {
                return entry.operation != models::GateOperation::set_gate_states;
              });
}

void PortChecker::force_gate(TrafficClass q, std::optional<bool> open) { forced_[q] = open; }

void PortChecker::begin(Ps now) {
  if (due_ < now) violations_.add(due_, name_, due_text_);
  due_ = never;
  while (now_ < now) {
    const Ps next = std::min(gates_.next_event(), now);
    for (TrafficClass q = 0; q < traffic_class_count; ++q)
      if (credits_[q]) credits_[q]->flow(next, gate_open(q, gates_));
    now_ = next;
    if (next < now) advance_gates();
  }
  started_class_.reset();
  turn_.reset();
  somebody_dropped_ = false;
  displaced_ = 0;
  started_is_cut_through_ = somebody_found_no_room_ = false;
  check_credits();
}

void PortChecker::advance_gates() {
  gates_.run_to(now_);
  for (std::optional<CreditAccount>& credit : credits_)
    if (credit) credit->follow_list(gates_.oper());
}

/// loCredit follows from one frame's transmission; hiCredit is known where nothing but lower classes interferes.
void PortChecker::check_credits() {
  for (TrafficClass q = 0; q < traffic_class_count; ++q) {
    if (!credits_[q]) continue;
    if (!credits_[q]->is_above_lo(longest_occupation_[q]))
      fail("class " + std::to_string(q) + " has a credit below loCredit");
    if (has_gates_ || config_.preemption || is_timed(q) || (classes_seen_ >> q >> 1) != 0) continue;
    Ps longest = 0;
    for (TrafficClass p = 0; p < q; ++p) longest = std::max(longest, longest_occupation_[p]);
    // A frame starts at the picosecond after its credit has reached 0.
    if (up_ && !credits_[q]->is_below_hi(longest + 1))
      fail("class " + std::to_string(q) + " has a credit above hiCredit");
  }
}

PortChecker::Item PortChecker::item_of(const SeenFrame& seen) const {
  return {seen.handle, seen.frame.stream, seen.frame.sequence, seen.frame.length, seen.eligible};
}

TrafficClass PortChecker::class_of(const models::Frame& frame) const {
  return config_.traffic_class_of_priority[frame.marked ? frame.queue_priority : frame.priority];
}

void PortChecker::report_credit(TrafficClass q) {
  if (credits_[q]) credits_[q]->set_waiting(!queues_[q].empty());
}

/// What every start of a frame, or of the rest of one, must obey.
void PortChecker::check_start(const Item& item, TrafficClass q, std::uint32_t octets) {
  if (now_ < free_at_)
    fail(item, "starts " + std::to_string(free_at_ - now_) +
                   " ps before the medium is free: frames overlap or the gap is too short");
  if (!up_) fail(item, "starts on a link that is down");
  if (fit(q, now_, duration_of(octets), gates_) != now_)
    fail(item, gate_open(q, gates_) ? "does not end before its gate closes" : "starts while its gate is closed");
  if (is_preemptable(q) && hold_at(now_, gates_).asked) fail(item, "is preemptable and starts while the MAC holds");
}

void PortChecker::check_nobody_is_passed_over(const Item& item, TrafficClass q) {
  for (TrafficClass p = 0; p < traffic_class_count; ++p) {
    if (p == q || !comes_before(p, q) || queues_[p].empty() || !is_ready(p, queues_[p].front())) continue;
    fail(item, "of class " + std::to_string(q) + " starts although " +
                   wire_checker::name_of(queues_[p].front().stream, queues_[p].front().sequence) + " of class " +
                   std::to_string(p) + " is ready");
  }
}

/// A frame is cut through only where no whole frame, and no rest of one, may start.
void PortChecker::check_nobody_else_may_start(const Item& item) {
  for (TrafficClass p = 0; p < traffic_class_count; ++p)
    if (!queues_[p].empty() && is_ready(p, queues_[p].front()))
      fail(item, "is cut through although " +
                     wire_checker::name_of(queues_[p].front().stream, queues_[p].front().sequence) + " may start");
  if (rest_ && fit(rest_->q, now_, duration_of(rest_->remaining), gates_) == now_ && !hold_at(now_, gates_).asked)
    fail(item, "is cut through although the rest of " +
                   wire_checker::name_of(rest_->item.stream, rest_->item.sequence) + " may go on");
}

bool PortChecker::could_cut_through(const models::Frame& frame, models::Priority priority) const {
  const TrafficClass q = config_.traffic_class_of_priority[priority];
  if (!models::contains(config_.cut_through, q) || config_.untagged || is_preemptable(q) || is_timed(q)) return false;
  if (!up_ || now_ < free_at_ || !queues_[q].empty() || somebody_dropped_ || somebody_found_no_room_) return false;
  const std::uint32_t msdu = frame.msdu + (frame.r_tagged ? models::r_tag.count : 0u);
  if (config_.shaping.queue_max_sdu[q].count != 0 && msdu > config_.shaping.queue_max_sdu[q].count) return false;
  return ready_time(q, now_, long_ago, duration_of(frame.length)) == now_;
}

/// What a class with a share met when it started. Frames of the instant are queued afterwards, see enqueued().
void PortChecker::note_turn(const Item& item, TrafficClass q) {
  if (!is_shared(q)) return;
  turn_.emplace();
  for (TrafficClass p = 0; p < traffic_class_count; ++p) {
    if (!is_shared(p) || is_preemptable(p) != is_preemptable(q)) continue;
    if (p == q)
      (*turn_)[p] = models::wire_length(models::Octets{item.length}).count;
    else if (!queues_[p].empty() && is_ready(p, queues_[p].front()))
      (*turn_)[p] = models::wire_length(models::Octets{queues_[p].front().length}).count;
  }
}

/// Whether it was the turn of the class that started; who has nothing left to send keeps nothing.
void PortChecker::check_turn() {
  if (turn_) {
    const TrafficClass due = shares_.next(*turn_);
    if (due != *started_class_)
      fail(started_item_, "of class " + std::to_string(*started_class_) + " starts although it is the turn of class " +
                              std::to_string(due));
    shares_.pay(*started_class_, (*turn_)[*started_class_]);
    turn_.reset();
  }
  for (TrafficClass q = 0; q < traffic_class_count; ++q)
    if (queues_[q].empty()) shares_.empty(q);
}

void PortChecker::transmit(const Fragment& fragment) {
  const TrafficClass q = fragment.q;
  under_way_.reset();
  if (is_preemptable(q)) under_way_ = fragment;
  last_bit_ = now_ + duration_of(fragment.remaining);
  free_at_ = last_bit_ + octet_ * models::inter_packet_gap.count;
  if (credits_[q]) credits_[q]->transmit(free_at_);
  longest_occupation_[q] = std::max(longest_occupation_[q], fragment.occupied + free_at_ - now_);
  classes_seen_ = static_cast<std::uint8_t>(classes_seen_ | 1u << q);
  started_class_ = q;
  started_is_rest_ = fragment.remaining != fragment.item.length;
  started_item_ = fragment.item;
}

void PortChecker::started(const SeenFrame& seen, models::TransmissionDetail detail) {
  Item item = item_of(seen);
  const TrafficClass q = detail.traffic_class;
  if (q != class_of(seen.frame))
    fail(item, "starts in class " + std::to_string(q) + " instead of " + std::to_string(class_of(seen.frame)));
  if (detail.octets != item.length)
    fail(item, "starts with " + std::to_string(detail.octets) + " octets instead of " + std::to_string(item.length));
  if (pending_ && pending_->item.handle == seen.handle) {
    item.eligible = pending_->item.eligible;
    pending_.reset();
  } else {
    drop_pending();
    const bool is_first = queues_[q].empty() || (is_timed(q) && item.eligible < queues_[q].front().eligible);
    if (!is_first) fail(item, "starts before frames of its class that came earlier");
  }
  check_start(item, q, item.length);
  if (credits_[q] && credits_[q]->is_negative())
    fail(item, "starts with a negative credit of " + std::to_string(credits_[q]->bits()) + " bit");
  if (is_timed(q) && item.eligible > now_)
    fail(item, "starts " + std::to_string(item.eligible - now_) + " ps before its eligibility time");
  const std::uint32_t msdu = seen.frame.msdu + (seen.frame.r_tagged ? models::r_tag.count : 0u);
  if (config_.shaping.queue_max_sdu[q].count != 0 && msdu > config_.shaping.queue_max_sdu[q].count)
    fail(item, "is longer than queueMaxSDU");
  if (is_preemptable(q) && rest_)
    fail(item, "is preemptable and starts before the rest of " +
                   wire_checker::name_of(rest_->item.stream, rest_->item.sequence));
  check_nobody_is_passed_over(item, q);
  if (seen.is_cut_through) check_nobody_else_may_start(item);
  note_turn(item, q);
  transmit({item, q, now_, item.length, 0});
  started_is_cut_through_ = seen.is_cut_through;
  report_credit(q);
}

void PortChecker::enqueued(const SeenFrame& seen, TrafficClass q) {
  drop_pending();
  const Item item = item_of(seen);
  if (q != class_of(seen.frame))
    fail(item, "waits in class " + std::to_string(q) + " instead of " + std::to_string(class_of(seen.frame)));
  std::vector<Item>& queue = queues_[q];
  const auto place = is_timed(q)
                         ? std::upper_bound(queue.begin(), queue.end(), item,
                                            [](const Item& a, const Item& b) { return a.eligible < b.eligible; })
                         : queue.end();
  const bool is_head = place == queue.begin();
  if (displacing_) {
    const auto [last, of] = *displacing_;
    displacing_.reset();
    if (of != q || !why_no_room(q, queue.size() + 1, octets_[q] + last.length, item))
      fail(last, "was dropped for " + wire_checker::name_of(item.stream, item.sequence) + ", for which there was room");
  }
  queue.insert(place, item);
  octets_[q] += item.length;
  // One that comes behind another that was dropped for want of room did not stand first.
  if (turn_ && is_head && !somebody_dropped_ && is_shared(q) && q != *started_class_ &&
      is_preemptable(q) == is_preemptable(*started_class_) && is_ready(q, item))
    (*turn_)[q] = models::wire_length(models::Octets{item.length}).count;
  const models::QueueLimit& limit = config_.queue_limits[q];
  if (queue.size() > limit.frames || octets_[q] > limit.octets)
    fail(item, "is one too many: " + std::to_string(queue.size()) + " frames, " + std::to_string(octets_[q]) +
                   " octets wait in class " + std::to_string(q));
  // Of the frames of an instant the most urgent one leaves; the others are queued afterwards.
  const bool rest_was_right = (started_is_rest_ && is_preemptable(q)) || models::contains(displaced_, q);
  if (started_class_ && is_head && !rest_was_right && comes_before(q, *started_class_) && is_ready(q, item))
    fail(item, "of class " + std::to_string(q) + " has to wait for " +
                   wire_checker::name_of(started_item_.stream, started_item_.sequence) + " of class " +
                   std::to_string(*started_class_));
  if (started_is_cut_through_ && is_head && (q == *started_class_ || is_ready(q, item)))
    fail(item, "has to wait for " + wire_checker::name_of(started_item_.stream, started_item_.sequence) +
                   ", which is cut through");
  report_credit(q);
}

void PortChecker::dequeued(const SeenFrame& seen, TrafficClass q) {
  drop_pending();
  std::vector<Item>& queue = queues_[q];
  const auto found =
      std::find_if(queue.begin(), queue.end(), [&](const Item& item) { return item.handle == seen.handle; });
  if (found == queue.end()) {
    fail(item_of(seen), "leaves a queue in which it is not");
    return;
  }
  if (found != queue.begin())
    fail(*found, "leaves its queue before " + wire_checker::name_of(queue.front().stream, queue.front().sequence));
  octets_[q] -= found->length;
  pending_ = Pending{*found, q};
  queue.erase(found);
}

/// What is wrong with one more frame in a queue that holds so many; nothing if there is room.
std::optional<models::DropReason> PortChecker::why_no_room(TrafficClass q, std::uint64_t frames, std::uint64_t octets,
                                                           const Item& item) const {
  const models::QueueLimit& limit = config_.queue_limits[q];
  if (frames + 1 > limit.frames) return models::DropReason::queue_frames;
  if (octets + item.length > limit.octets) return models::DropReason::queue_octets;
  return std::nullopt;
}

void PortChecker::check_displacing() {
  if (displacing_) fail(displacing_->item, "was dropped for no frame");
  displacing_.reset();
}

void PortChecker::refused(const SeenFrame& seen, models::DropReason reason) {
  if (reason != models::DropReason::queue_frames && reason != models::DropReason::queue_octets) return;
  somebody_found_no_room_ = true;
  const Item item = item_of(seen);
  const TrafficClass q = class_of(seen.frame);
  if (why_no_room(q, queues_[q].size(), octets_[q], item) != reason)
    fail(item, "is dropped for want of room in class " + std::to_string(q) + ", where there is room");
  if (config_.queue_limits[q].drops_oldest && !why_no_room(q, 0, 0, item))
    fail(item, "is dropped although older ones should be");
}

/// It left its queue to be given up.
void PortChecker::drop_pending() {
  if (!pending_) return;
  fail(pending_->item, "left its queue without a start or a drop");
  report_credit(pending_->q);
  pending_.reset();
}

bool PortChecker::dropped(models::FrameIndex handle, models::DropReason reason) {
  somebody_dropped_ = true;
  if (pending_ && pending_->item.handle == handle) {
    if (reason == models::DropReason::queue_frames || reason == models::DropReason::queue_octets) {
      const auto [item, q] = *pending_;
      if (displacing_ && displacing_->q != q) check_displacing();
      if (!config_.queue_limits[q].drops_oldest)
        fail(item, "is dropped although it is not the newest of class " + std::to_string(q));
      displacing_ = Displaced{item, q};
      displaced_ = models::with(displaced_, q);
    }
    report_credit(pending_->q);
    pending_.reset();
    return true;
  }
  drop_pending();
  if (!rest_ || rest_->item.handle != handle || up_) return false;
  rest_.reset();
  return true;
}

void PortChecker::cut(const SeenFrame& seen, models::TransmissionDetail detail) {
  drop_pending();
  const Item item = item_of(seen);
  if (!under_way_ || under_way_->item.handle != seen.handle || now_ >= last_bit_) {
    fail(item, "is cut although it is not a preemptable frame under way");
    return;
  }
  Fragment fragment = *under_way_;
  const std::optional<std::uint32_t> legal = cut_after(now_);
  if (!legal)
    fail(item, "is cut although too little would be left");
  else if (detail.octets != *legal)
    fail(item, "is cut after " + std::to_string(detail.octets) + " octets instead of " + std::to_string(*legal));
  // mCRC and gap follow.
  last_bit_ = fragment.start + octet_ * (8 + Ps{detail.octets} + 4);
  free_at_ = last_bit_ + octet_ * 12;
  if (credits_[fragment.q]) credits_[fragment.q]->transmit(free_at_);
  fragment.occupied += free_at_ - fragment.start;
  fragment.remaining -= std::min(fragment.remaining, detail.octets);
  rest_ = fragment;
  under_way_.reset();
  cut_wants_reason_ = true;
}

void PortChecker::resumed(const SeenFrame& seen, models::TransmissionDetail detail) {
  drop_pending();
  const Item item = item_of(seen);
  if (!rest_ || rest_->item.handle != seen.handle) {
    fail(item, "goes on although it has not been cut");
    return;
  }
  if (detail.octets != rest_->remaining)
    fail(item,
         "goes on with " + std::to_string(detail.octets) + " octets instead of " + std::to_string(rest_->remaining));
  Fragment fragment = *rest_;
  rest_.reset();
  check_start(item, fragment.q, fragment.remaining);
  for (TrafficClass p = 0; p < traffic_class_count; ++p)
    if (!is_preemptable(p) && !queues_[p].empty() && is_ready(p, queues_[p].front()))
      fail(item, "goes on although an express frame of class " + std::to_string(p) + " is ready");
  fragment.start = now_;
  transmit(fragment);
}

void PortChecker::end() {
  drop_pending();
  check_displacing();
  check_turn();
  if (cut_wants_reason_) {
    bool express_waits = hold_at(now_, gates_).asked || !up_;
    for (TrafficClass q = 0; q < traffic_class_count; ++q)
      express_waits = express_waits || (!is_preemptable(q) && !queues_[q].empty());
    if (!express_waits) fail("a frame is cut although no express frame waits and the MAC does not hold");
    cut_wants_reason_ = false;
  }
  due_ = never;
  if (!up_) return;
  due_ = idle_due(std::max(now_, free_at_));
  due_text_ = "the medium is idle although a frame may start";
  if (const Ps cut = now_ < free_at_ ? cut_due() : never; cut < due_) {
    due_ = cut;
    due_text_ = "a preemptable frame goes on although an express frame is ready or the MAC holds";
  }
  if (due_ > now_) return;
  fail(due_text_);
  due_ = never;
}

void PortChecker::finish(Ps now) {
  if (now_ < now + 1) begin(now + 1);
}

}  // namespace takt::wire_checker
