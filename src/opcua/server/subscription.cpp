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
  if (values_.size() < queue_size) {
    values_.push_back(std::move(value));
    return;
  }
  // A queue of one holds the newest; that it does is no overflow.
  if (discard_oldest || queue_size == 1) values_.pop_front();
  else values_.pop_back();
  values_.push_back(std::move(value));
  if (queue_size == 1) return;
  DataValue& marked = discard_oldest ? values_.front() : values_.back();
  marked.status = static_cast<StatusCode>(code_of(marked.result()) | code_of(StatusCode::GoodOverflow));
}

void MonitoredItem::put(EventFieldList fields) {
  if (mode == MonitoringMode::Disabled) return;
  if (events_.size() >= queue_size) {
    has_overflowed_ = true;
    if (!discard_oldest) return;
    events_.pop_front();
  }
  events_.push_back(std::move(fields));
}

void MonitoredItem::forget() {
  values_.clear();
  events_.clear();
  last_.reset();
  has_overflowed_ = false;
}

void MonitoredItem::shorten() {
  while (values_.size() > queue_size) discard_oldest ? values_.pop_front() : values_.pop_back();
  while (events_.size() > queue_size) discard_oldest ? events_.pop_front() : events_.pop_back();
}

std::size_t MonitoredItem::take_values(List<MonitoredItemNotification>& into, std::size_t most) {
  std::size_t taken = 0;
  for (; taken < most && !values_.empty(); ++taken) {
    into.push_back({client_handle, std::move(values_.front())});
    values_.pop_front();
  }
  return taken;
}

std::size_t MonitoredItem::take_events(List<EventFieldList>& into, std::size_t most) {
  std::size_t taken = 0;
  for (; taken < most && !events_.empty(); ++taken) {
    into.push_back(std::move(events_.front()));
    events_.pop_front();
  }
  if (events_.empty() && has_overflowed_ && taken < most) {
    Event overflow;
    overflow.type = NodeId(ids::event_queue_overflow_event_type);
    overflow.fields["EventType"] = Variant(overflow.type);
    overflow.fields["SourceNode"] = Variant(NodeId(ids::server));
    overflow.fields["SourceName"] = Variant(Text("Server"));
    overflow.fields["Message"] = Variant(LocalizedText("events were lost: the queue of this item is too short"));
    overflow.fields["Severity"] = Variant(std::uint16_t{500});
    into.push_back({client_handle, selected_fields(*event_filter, overflow)});
    has_overflowed_ = false;
    ++taken;
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

NotificationMessage Subscription::take_message(DateTime now, std::size_t kept, bool& more) {
  NotificationMessage message;
  message.sequence_number = next_sequence_number_;
  message.publish_time = now;
  const std::size_t most = most_notifications == 0 ? static_cast<std::size_t>(-1) : most_notifications;
  DataChangeNotification values;
  EventNotificationList events;
  std::size_t taken = 0;
  for (auto& [number, item] : items) {
    if (!is_enabled || !item.has_news()) continue;
    taken += item.take_values(values.monitored_items, most - taken);
    taken += item.take_events(events.events, most - taken);
  }
  if (!values.monitored_items.empty()) message.notification_data.push_back(extension_of(values));
  if (!events.events.empty()) message.notification_data.push_back(extension_of(events));
  more = is_enabled && has_news();
  is_waiting_ = more;
  has_sent_ = true;
  expiries_without_news_ = 0;
  if (message.notification_data.empty()) return message;
  next_sequence_number_ = next_sequence_number_ == 0xFFFF'FFFFU ? 1 : next_sequence_number_ + 1;
  sent_.push_back(message);
  if (sent_.size() > kept) sent_.pop_front();
  return message;
}

List<std::uint32_t> Subscription::available() const {
  List<std::uint32_t> numbers;
  for (const NotificationMessage& each : sent_) numbers.push_back(each.sequence_number);
  return numbers;
}

StatusCode Subscription::acknowledge(std::uint32_t sequence_number) {
  const auto found = std::find_if(sent_.begin(), sent_.end(), [&](const auto& each) { return each.sequence_number == sequence_number; });
  if (found == sent_.end()) return StatusCode::BadSequenceNumberUnknown;
  sent_.erase(found);
  return StatusCode::Good;
}

const NotificationMessage* Subscription::sent(std::uint32_t sequence_number) const {
  const auto found = std::find_if(sent_.begin(), sent_.end(), [&](const auto& each) { return each.sequence_number == sequence_number; });
  return found == sent_.end() ? nullptr : &*found;
}

}  // namespace takt::opcua
