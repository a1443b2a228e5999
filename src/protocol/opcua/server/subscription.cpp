// SPDX-License-Identifier: Apache-2.0
#include "opcua/server/subscription.hpp"

#include <algorithm>
#include <cmath>

#include "opcua/server/numeric_range.hpp"

namespace takt::opcua {
namespace {

/// So far, without a dead band or with one that is too narrow for it, a number counts as another one.
bool is_beyond(const DataValue& value, const DataValue& last, double deadband) {
  const auto a = value.value ? number_in(*value.value) : std::nullopt;
  const auto b = last.value ? number_in(*last.value) : std::nullopt;
  return !a || !b || std::abs(*a - *b) > deadband;
}

/// A node of a map or a queue, and what an allocator keeps of it.
constexpr std::size_t allocation_octets = 64;

std::size_t octets_of_message(const NotificationMessage& message) {
  std::size_t octets = sizeof(NotificationMessage);
  for (const ExtensionObject& each : message.notification_data)
    octets += sizeof(ExtensionObject) + each.body.value.size();
  return octets;
}

std::size_t octets_of_queued(const QueuedEvent& queued) { return sizeof(QueuedEvent) + queued.event->octets(); }

}  // namespace

DataValue with_times(DataValue value, TimestampsToReturn times, DateTime now, bool is_value) {
  const bool wants_source = times == TimestampsToReturn::Source || times == TimestampsToReturn::Both;
  const bool wants_server = times == TimestampsToReturn::Server || times == TimestampsToReturn::Both;
  if (!wants_source || !is_value) value.source_time.reset();
  if (wants_source && is_value && !value.source_time && !is_bad(value.result())) value.source_time = now;
  value.server_time = wants_server ? std::optional(now) : std::nullopt;
  if (value.status == StatusCode::Good) value.status.reset();
  return value;
}

bool MonitoredItem::is_change(const DataValue& value) const {
  if (!last_ || last_->result() != value.result()) return true;
  if (filter.trigger == DataChangeTrigger::Status) return false;
  if (last_->value != value.value) return filter.deadband_type == 0 || is_beyond(value, *last_, filter.deadband_value);
  return filter.trigger == DataChangeTrigger::StatusValueTimestamp && last_->source_time != value.source_time;
}

void MonitoredItem::put(DataValue value) {
  if (mode == MonitoringMode::Disabled) return;
  if (!what.index_range.empty() && value.value) {
    if (const StatusCode status = cut(*value.value, what.index_range); !is_good(status)) {
      value.value.reset();
      value.status = status;
    }
  }
  if (!is_change(value)) return;
  last_ = value;
  const std::size_t octets = octets_of(value);
  bool is_lost = values_.size() >= queue_size;
  if (is_lost) drop_value(discard_oldest || queue_size == 1);
  while (!held_.add(octets)) {
    if (values_.empty()) return;  // the newest one is read
    drop_value(discard_oldest);
    is_lost = true;
  }
  values_.push_back(std::move(value));
  // A queue of one holds the newest; that it does is no overflow.
  if (!is_lost || queue_size == 1) return;
  DataValue& marked = discard_oldest ? values_.front() : values_.back();
  marked.status = static_cast<StatusCode>(code_of(marked.result()) | code_of(StatusCode::GoodOverflow));
}

void MonitoredItem::drop_value(bool oldest) {
  held_.remove(octets_of(oldest ? values_.front() : values_.back()));
  values_.erase(oldest ? values_.begin() : values_.end() - 1);
}

void MonitoredItem::drop_event(bool oldest) {
  held_.remove(octets_of_queued(oldest ? events_.front() : events_.back()));
  events_.erase(oldest ? events_.begin() : events_.end() - 1);
}

bool MonitoredItem::hold() {
  const std::size_t before = own_octets_;
  own_octets_ = sizeof(MonitoredItem) + allocation_octets + what.index_range.value.size() +
                octets_of(Variant(what.node_id)) + (event_filter ? event_filter->octets() : 0);
  if (held_.set(held_.octets() - before + own_octets_)) return true;
  own_octets_ = before;
  return false;
}

/// Each one counts the whole event, though all share it: who keeps one alive may be the last.
void MonitoredItem::put(std::shared_ptr<const EventRecord> event) {
  if (mode == MonitoringMode::Disabled) return;
  QueuedEvent queued{std::move(event), event_filter};
  const std::size_t octets = octets_of_queued(queued);
  while (events_.size() >= queue_size || !held_.add(octets)) {
    has_overflowed_ = true;
    if (!discard_oldest || events_.empty()) return;
    drop_event(true);
  }
  events_.push_back(std::move(queued));
}

void MonitoredItem::forget() {
  while (!values_.empty()) drop_value(true);
  while (!events_.empty()) drop_event(true);
  last_.reset();
  has_overflowed_ = false;
}

void MonitoredItem::shorten() {
  while (values_.size() > queue_size) drop_value(discard_oldest);
  while (events_.size() > queue_size) drop_event(discard_oldest);
}

std::size_t MonitoredItem::drain_values(List<MonitoredItemNotification>& into, std::size_t most, std::size_t& octets) {
  std::size_t taken = 0;
  for (; taken < most && octets > 0 && taken < values_.size(); ++taken) {
    const std::size_t of_this = octets_of(values_[taken]);
    held_.remove(of_this);
    octets -= std::min(octets, of_this);
    into.push_back({client_handle, std::move(values_[taken])});
  }
  values_.erase(values_.begin(), values_.begin() + static_cast<std::ptrdiff_t>(taken));
  return taken;
}

std::size_t MonitoredItem::drain_events(List<EventFieldList>& into, std::size_t most, std::size_t& octets) {
  std::size_t taken = 0;
  const auto tell = [&](const DecodedFilter& filter, const EventRecord& event) {
    into.push_back({client_handle, filter.selected_fields(event)});
    for (const Variant& each : into.back().event_fields) octets -= std::min(octets, octets_of(each));
    ++taken;
  };
  while (taken < most && octets > 0 && !events_.empty()) {
    tell(*events_.front().filter, *events_.front().event);
    drop_event(true);
  }
  if (events_.empty() && has_overflowed_ && taken < most && octets > 0) {
    Event overflow;
    overflow.type = NodeId(ids::event_queue_overflow_event_type);
    overflow.fields["EventType"] = Variant(overflow.type);
    overflow.fields["SourceNode"] = Variant(NodeId(ids::server));
    overflow.fields["SourceName"] = Variant(Text("Server"));
    overflow.fields["Message"] = Variant(LocalizedText("events were lost: there was no room for them"));
    overflow.fields["Severity"] = Variant(std::uint16_t{500});
    tell(*event_filter, EventRecord(std::move(overflow), 0));
    has_overflowed_ = false;
  }
  return taken;
}

bool Subscription::has_news() const {
  return std::any_of(items.begin(), items.end(), [](const auto& each) { return each.second.has_news(); });
}

Subscription::Expiry Subscription::expire(sim::LocalTime now, bool has_request) {
  while (next_ <= now) next_ = next_ + interval;
  expiries_without_request_ = has_request ? 0 : expiries_without_request_ + 1;
  if (expiries_without_request_ >= lifetime) return Expiry::end;
  const bool has_data = is_enabled && has_news();
  if (!has_data) ++expiries_without_news_;
  // The first expiry tells the client that the subscription is there.
  if (has_data || !has_sent_ || expiries_without_news_ >= keep_alive) is_waiting_ = true;
  return is_waiting_ ? Expiry::send : Expiry::nothing;
}

NotificationMessage Subscription::accept_message(DateTime now, std::size_t kept, std::size_t most_octets, bool& more) {
  NotificationMessage message;
  message.sequence_number = next_sequence_number_;
  message.publish_time = now;
  const std::size_t most = most_notifications == 0 ? static_cast<std::size_t>(-1) : most_notifications;
  DataChangeNotification values;
  EventNotificationList events;
  std::size_t taken = 0;
  std::size_t octets = most_octets;
  for (auto& [number, item] : items) {
    if (!is_enabled || !item.has_news()) continue;
    if (octets == 0) break;
    taken += item.drain_values(values.monitored_items, most - taken, octets);
    taken += item.drain_events(events.events, most - taken, octets);
  }
  if (!values.monitored_items.empty()) message.notification_data.push_back(extension_of(values));
  if (!events.events.empty()) message.notification_data.push_back(extension_of(events));
  more = is_enabled && has_news();
  is_waiting_ = more;
  has_sent_ = true;
  expiries_without_news_ = 0;
  if (message.notification_data.empty()) return message;
  next_sequence_number_ = next_sequence_number_ == 0xFFFF'FFFFU ? 1 : next_sequence_number_ + 1;
  // What there is no room for cannot be sent again; the oldest goes first.
  while (!sent_.empty() && sent_.size() >= kept) drop_sent(sent_.begin());
  while (!sent_octets_.add(octets_of_message(message))) {
    if (sent_.empty()) return message;
    drop_sent(sent_.begin());
  }
  sent_.push_back(message);
  return message;
}

void Subscription::drop_sent(std::deque<NotificationMessage>::iterator message) {
  sent_octets_.remove(octets_of_message(*message));
  sent_.erase(message);
}

List<std::uint32_t> Subscription::available() const {
  List<std::uint32_t> numbers;
  for (const NotificationMessage& each : sent_) numbers.push_back(each.sequence_number);
  return numbers;
}

StatusCode Subscription::acknowledge(std::uint32_t sequence_number) {
  const auto found = std::find_if(sent_.begin(), sent_.end(),
                                  [&](const auto& each) { return each.sequence_number == sequence_number; });
  if (found == sent_.end()) return StatusCode::BadSequenceNumberUnknown;
  drop_sent(found);
  return StatusCode::Good;
}

const NotificationMessage* Subscription::sent(std::uint32_t sequence_number) const {
  const auto found = std::find_if(sent_.begin(), sent_.end(),
                                  [&](const auto& each) { return each.sequence_number == sequence_number; });
  return found == sent_.end() ? nullptr : &*found;
}

}  // namespace takt::opcua
