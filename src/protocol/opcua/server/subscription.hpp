// SPDX-License-Identifier: Apache-2.0
// Monitored items and subscriptions (OPC 10000-4, 5.13 and 5.14) as values: time and notifications in, messages out.
// Who answers Publish requests is `subscription_services.cpp`.
#pragma once

#include <deque>
#include <map>

#include "opcua/server/budget.hpp"
#include "opcua/server/event_filter.hpp"
#include "opcua/server/settings.hpp"
#include "opcua/services/monitored_items.hpp"
#include "opcua/services/subscriptions.hpp"

namespace takt::opcua {

/// An event that waits, and what is told of it: decoded when it is sent, so that it takes no more memory than this
/// until then.
struct QueuedEvent {
  std::shared_ptr<const EventRecord> event;
  std::shared_ptr<const DecodedFilter> filter;
};

class MonitoredItem {
 public:
  /// What it holds counts against `account`.
  explicit MonitoredItem(const std::shared_ptr<OctetAccount>& account) : held_(account) {}

  std::uint32_t id = 0;
  std::uint32_t client_handle = 0;
  ReadValueId what;
  MonitoringMode mode = MonitoringMode::Reporting;
  TimestampsToReturn timestamps = TimestampsToReturn::Both;
  std::size_t queue_size = 1;
  bool discard_oldest = true;
  DataChangeFilter filter;
  std::shared_ptr<const DecodedFilter> event_filter;  ///< of events
  std::uint64_t events_before = 0;                    ///< number of the last event before it was made

  AttributeId attribute() const { return static_cast<AttributeId>(what.attribute_id); }
  bool is_of_events() const { return event_filter != nullptr; }
  /// Counts itself, with its filter; false if there is no room.
  bool hold();
  /// A value, if the filter lets it pass; every one is kept, for none is sampled away. Where the queue is full, or
  /// there is no room for more, one is lost and that is told.
  void put(DataValue value);
  void put(std::shared_ptr<const EventRecord> event);
  /// Events were lost before they came here.
  void lose_events() { has_overflowed_ = true; }
  /// Nothing that waits is sent any more, and the next value counts whatever it is.
  void forget();
  bool has_news() const { return mode == MonitoringMode::Reporting && (!values_.empty() || !events_.empty()); }
  /// At most so many notifications and octets; how many notifications.
  std::size_t drain_values(List<MonitoredItemNotification>& into, std::size_t most, std::size_t& octets);
  std::size_t drain_events(List<EventFieldList>& into, std::size_t most, std::size_t& octets);
  /// Queues that were longer.
  void shorten();

 private:
  bool is_change(const DataValue& value) const;
  void drop_value(bool oldest);
  void drop_event(bool oldest);

  HeldOctets held_;
  std::size_t own_octets_ = 0;     ///< of `held_`: without the queues
  std::vector<DataValue> values_;  ///< oldest first, as events
  std::vector<QueuedEvent> events_;
  std::optional<DataValue> last_;
  bool has_overflowed_ = false;  ///< of events, told by an event of its own
};

class Subscription {
 public:
  explicit Subscription(std::shared_ptr<OctetAccount> above)
      : account(std::make_shared<OctetAccount>(static_cast<std::size_t>(-1), std::move(above))),
        sent_octets_(account) {}

  std::uint32_t id = 0;
  std::shared_ptr<OctetAccount> account;  ///< of all that it holds; below that of its session
  int rank = 0;                           ///< of its user
  std::string holder;                     ///< its user, or the host of who has no name
  sim::LocalTime made;
  sim::LocalTime left;  ///< since when it has had no session
  NodeId session;       ///< its token; null: of none any more
  NodeId owner;         ///< of the session that made it; who may take it over is asked by user
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
  /// When something is due; of one without a session at the latest its end.
  sim::LocalTime next_time(sim::Duration orphaned_for) const {
    return session.is_null() ? std::min(next_, left + orphaned_for) : next_;
  }
  /// What an expiry of the timer asks for.
  enum class Expiry : std::uint8_t { nothing, send, end };
  /// `has_request`: a Publish request waits in its session.
  Expiry expire(sim::LocalTime now, bool has_request);
  /// Something is to be sent as soon as there is a request.
  bool is_waiting() const { return is_waiting_; }
  /// The message that is to be sent now; `more` if it could not take all. A keep-alive if there is nothing.
  /// It has no more octets than `most_octets`, about, unless a single notification has.
  NotificationMessage accept_message(DateTime now, std::size_t kept, std::size_t most_octets, bool& more);
  /// A Publish request has been there: its session lives.
  void touch() { expiries_without_request_ = 0; }

  List<std::uint32_t> available() const;
  StatusCode acknowledge(std::uint32_t sequence_number);
  const NotificationMessage* sent(std::uint32_t sequence_number) const;
  bool has_news() const;
  /// Of a transfer: what each item has now is sent again.
  void wait_again() { is_waiting_ = true; }

 private:
  void drop_sent(std::deque<NotificationMessage>::iterator message);

  sim::LocalTime next_;
  std::uint32_t expiries_without_news_ = 0;
  std::uint32_t expiries_without_request_ = 0;
  std::uint32_t next_sequence_number_ = 1;
  bool is_waiting_ = false;
  bool has_sent_ = false;
  std::deque<NotificationMessage> sent_;
  HeldOctets sent_octets_;
};

/// What is told of a value, by the item's choice of times.
DataValue with_times(DataValue value, TimestampsToReturn times, DateTime now, bool is_value);

}  // namespace takt::opcua
