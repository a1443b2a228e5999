// Monitored items and subscriptions (OPC 10000-4, 5.13 and 5.14) as values: time and notifications in, messages out. Who answers Publish requests is `subscription_services.cpp`.
#pragma once

#include <deque>
#include <map>

#include "opcua/server/event_filter.hpp"
#include "opcua/server/settings.hpp"
#include "opcua/services/monitored_items.hpp"
#include "opcua/services/subscriptions.hpp"

namespace takt::opcua {

class MonitoredItem {
 public:
  std::uint32_t id = 0;
  std::uint32_t client_handle = 0;
  ReadValueId what;
  MonitoringMode mode = MonitoringMode::Reporting;
  TimestampsToReturn timestamps = TimestampsToReturn::Both;
  std::size_t queue_size = 1;
  bool discard_oldest = true;
  DataChangeFilter filter;
  std::optional<EventFilter> event_filter;  ///< of events

  AttributeId attribute() const { return static_cast<AttributeId>(what.attribute_id); }
  bool is_of_events() const { return event_filter.has_value(); }
  /// A value, if the filter lets it pass; every one is kept, for none is sampled away.
  void put(DataValue value);
  void put(EventFieldList fields);
  /// Nothing that waits is sent any more, and the next value counts whatever it is.
  void forget();
  bool has_news() const { return mode == MonitoringMode::Reporting && (!values_.empty() || !events_.empty()); }
  /// At most so many; how many.
  std::size_t take_values(List<MonitoredItemNotification>& into, std::size_t most);
  std::size_t take_events(List<EventFieldList>& into, std::size_t most);
  /// Queues that were longer.
  void shorten();

 private:
  bool is_change(const DataValue& value) const;

  std::deque<DataValue> values_;
  std::deque<EventFieldList> events_;
  std::optional<DataValue> last_;
  bool has_overflowed_ = false;  ///< of events, told by an event of its own
};

class Subscription {
 public:
  std::uint32_t id = 0;
  NodeId session;            ///< its token; null: of none any more
  NodeId owner;              ///< of the session that made it; who may take it over is asked by user
  Text user;
  sim::Duration interval;
  std::uint32_t lifetime = 0;
  std::uint32_t keep_alive = 0;
  std::size_t most_notifications = 0;  ///< of a message; 0: any
  bool is_enabled = true;
  std::uint8_t priority = 0;
  std::map<std::uint32_t, MonitoredItem> items;

  /// The first timer expires one interval from now.
  void begin(sim::LocalTime now) { next_ = now + interval; }
  sim::LocalTime next_time() const { return next_; }
  /// What an expiry of the timer asks for.
  enum class Expiry : std::uint8_t { nothing, send, end };
  /// `has_request`: a Publish request waits in its session.
  Expiry expire(sim::LocalTime now, bool has_request);
  /// Something is to be sent as soon as there is a request.
  bool is_waiting() const { return is_waiting_; }
  /// The message that is to be sent now; `more` if it could not take all. A keep-alive if there is nothing.
  NotificationMessage take_message(DateTime now, std::size_t kept, bool& more);
  /// A Publish request has been there: its session lives.
  void touch() { expiries_without_request_ = 0; }

  List<std::uint32_t> available() const;
  StatusCode acknowledge(std::uint32_t sequence_number);
  const NotificationMessage* sent(std::uint32_t sequence_number) const;
  bool has_news() const;
  /// Of a transfer: what each item has now is sent again.
  void wait_again() { is_waiting_ = true; }

 private:
  sim::LocalTime next_;
  std::uint32_t expiries_without_news_ = 0;
  std::uint32_t expiries_without_request_ = 0;
  std::uint32_t next_sequence_number_ = 1;
  bool is_waiting_ = false;
  bool has_sent_ = false;
  std::deque<NotificationMessage> sent_;
};

/// What is told of a value, by the item's choice of times.
DataValue with_times(DataValue value, TimestampsToReturn times, DateTime now, bool is_value);

}  // namespace takt::opcua
