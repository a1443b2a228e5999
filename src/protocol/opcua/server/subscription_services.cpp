// SPDX-License-Identifier: Apache-2.0
// Subscriptions, and who answers Publish requests (OPC 10000-4, 5.14).
#include <algorithm>

#include "opcua/server/services.hpp"

namespace takt::opcua {

Subscription* Services::subscription_of(const Request& request, std::uint32_t id) {
  const auto found = subscriptions_.find(id);
  return found == subscriptions_.end() || found->second.session != request.session->token ? nullptr : &found->second;
}

/// What is not possible is made possible, not refused; a subscription lives for three keep-alives at least, and for as
/// long as the limits say at most.
void Services::revise(Subscription& subscription, double interval, std::uint32_t lifetime,
                      std::uint32_t keep_alive) const {
  const sim::Duration longest = std::max(
      std::min(settings_.limits.most_publishing, sim::Duration::from_ps(settings_.limits.most_subscription.ps() / 3)),
      settings_.limits.least_publishing);
  const double most_ms = static_cast<double>(longest.ps()) / 1e9;
  const double asked = interval > 0 ? std::min(interval, most_ms) : 0;  // a NaN is no interval
  subscription.interval = std::clamp(sim::Duration::from_ps(static_cast<std::int64_t>(asked * 1e9)),
                                     settings_.limits.least_publishing, longest);
  const auto most = static_cast<std::uint32_t>(
      std::clamp<std::int64_t>(settings_.limits.most_subscription.ps() / subscription.interval.ps(), 3, 3'000'000));
  subscription.keep_alive = std::clamp<std::uint32_t>(keep_alive == 0 ? 10 : keep_alive, 1, most / 3);
  subscription.lifetime = std::clamp<std::uint32_t>(lifetime, 3 * subscription.keep_alive, most);
}

Answer<CreateSubscriptionResponse> Services::create_subscription(const Request& request,
                                                                 const CreateSubscriptionRequest& body) {
  const Session& session = *request.session;
  const auto own = std::count_if(subscriptions_.begin(), subscriptions_.end(),
                                 [&](const auto& each) { return each.second.session == session.token; });
  if (static_cast<std::size_t>(own) >= settings_.limits.subscriptions_of_session ||
      !make_room(session, settings_.limits.subscriptions, request.now))
    return StatusCode::BadTooManySubscriptions;
  Subscription made(session.account);
  made.id = ++last_subscription_;
  made.rank = session.rank();
  made.holder = session.holder();
  made.made = request.now.local;
  made.session = session.token;
  made.user = session.user;
  made.most_notifications = body.max_notifications_per_publish;
  made.is_enabled = body.publishing_enabled;
  made.priority = body.priority;
  revise(made, body.requested_publishing_interval, body.requested_lifetime_count, body.requested_max_keep_alive_count);
  made.begin(request.now.local);
  CreateSubscriptionResponse response;
  response.subscription_id = made.id;
  response.revised_publishing_interval = static_cast<double>(made.interval.ps()) / 1e9;
  response.revised_lifetime_count = made.lifetime;
  response.revised_max_keep_alive_count = made.keep_alive;
  subscriptions_.emplace(made.id, std::move(made));
  return response;
}

Answer<ModifySubscriptionResponse> Services::modify_subscription(const Request& request,
                                                                 const ModifySubscriptionRequest& body) {
  Subscription* const subscription = subscription_of(request, body.subscription_id);
  if (subscription == nullptr) return StatusCode::BadSubscriptionIdInvalid;
  revise(*subscription, body.requested_publishing_interval, body.requested_lifetime_count,
         body.requested_max_keep_alive_count);
  subscription->most_notifications = body.max_notifications_per_publish;
  subscription->priority = body.priority;
  ModifySubscriptionResponse response;
  response.revised_publishing_interval = static_cast<double>(subscription->interval.ps()) / 1e9;
  response.revised_lifetime_count = subscription->lifetime;
  response.revised_max_keep_alive_count = subscription->keep_alive;
  return response;
}

Answer<SetPublishingModeResponse> Services::set_publishing_mode(const Request& request,
                                                                const SetPublishingModeRequest& body) {
  if (body.subscription_ids.empty()) return StatusCode::BadNothingToDo;
  if (body.subscription_ids.size() > settings_.limits.operations) return StatusCode::BadTooManyOperations;
  SetPublishingModeResponse response;
  for (const std::uint32_t id : body.subscription_ids) {
    Subscription* const subscription = subscription_of(request, id);
    if (subscription != nullptr) subscription->is_enabled = body.publishing_enabled;
    response.results.push_back(subscription == nullptr ? StatusCode::BadSubscriptionIdInvalid : StatusCode::Good);
  }
  return response;
}

/// Those without a session first.
bool Services::make_room(const Session& newcomer, std::size_t most, Now now) {
  if (subscriptions_.size() < most) return true;
  std::vector<Place> places;
  std::vector<std::uint32_t> numbers;
  for (const auto& [id, each] : subscriptions_) {
    const bool is_orphan = each.session.is_null();
    places.push_back({each.holder, each.rank, is_orphan ? 0 : 1,
                      is_orphan && each.left + settings_.limits.session_grace <= now.local, each.made});
    numbers.push_back(id);
  }
  const auto given = place_to_give(places, {newcomer.holder(), newcomer.rank()});
  if (!given) return false;
  const auto session = sessions_.find(subscriptions_.at(numbers[*given]).session);
  remove(numbers[*given]);
  if (session != sessions_.end() && !has_subscriptions(session->first))
    refuse_publishes(session->second, StatusCode::BadNoSubscription, now);
  return true;
}

/// What it holds counts for its user then, or for the host of who has no name.
void Services::orphan(Subscription& subscription, Now now) {
  subscription.session = NodeId();
  subscription.left = now.local;
  subscription.account->move_below(holder_account(subscription.holder));
}

void Services::remove(std::uint32_t id) {
  const auto found = subscriptions_.find(id);
  for (const auto& [number, item] : found->second.items) watch(found->second, item, false);
  subscriptions_.erase(found);
}

bool Services::has_subscriptions(const NodeId& session) const {
  return std::any_of(subscriptions_.begin(), subscriptions_.end(),
                     [&](const auto& each) { return each.second.session == session; });
}

void Services::refuse_publishes(Session& session, StatusCode why, Now now) {
  for (const QueuedPublish& each : std::exchange(session.publishes, {}))
    fault(session.connection, each.request_id, each.request_handle, why, now);
}

Answer<DeleteSubscriptionsResponse> Services::delete_subscriptions(const Request& request,
                                                                   const DeleteSubscriptionsRequest& body) {
  if (body.subscription_ids.empty()) return StatusCode::BadNothingToDo;
  if (body.subscription_ids.size() > settings_.limits.operations) return StatusCode::BadTooManyOperations;
  DeleteSubscriptionsResponse response;
  for (const std::uint32_t id : body.subscription_ids) {
    const bool is_own = subscription_of(request, id) != nullptr;
    if (is_own) remove(id);
    response.results.push_back(is_own ? StatusCode::Good : StatusCode::BadSubscriptionIdInvalid);
  }
  if (!has_subscriptions(request.session->token))
    refuse_publishes(*request.session, StatusCode::BadNoSubscription, request.now);
  return response;
}

/// To the same user only, and of one without a name, only while nobody has it.
Answer<TransferSubscriptionsResponse> Services::transfer(const Request& request,
                                                         const TransferSubscriptionsRequest& body) {
  if (body.subscription_ids.empty()) return StatusCode::BadNothingToDo;
  if (body.subscription_ids.size() > settings_.limits.operations) return StatusCode::BadTooManyOperations;
  TransferSubscriptionsResponse response;
  Session& session = *request.session;
  for (const std::uint32_t id : body.subscription_ids) {
    TransferResult result;
    const auto found = subscriptions_.find(id);
    if (found == subscriptions_.end()) {
      result.status_code = StatusCode::BadSubscriptionIdInvalid;
    } else if (!(found->second.user == session.user) ||
               (session.user.empty() && !found->second.session.is_null() && found->second.session != session.token)) {
      result.status_code = StatusCode::BadUserAccessDenied;
    } else {
      Subscription& subscription = found->second;
      const auto former = sessions_.find(subscription.session);
      subscription.session = session.token;
      subscription.holder = session.holder();
      subscription.rank = session.rank();
      subscription.account->move_below(session.account);
      subscription.touch();
      if (former != sessions_.end() && former->first != session.token && !has_subscriptions(former->first))
        refuse_publishes(former->second, StatusCode::GoodSubscriptionTransferred, request.now);
      result.available_sequence_numbers = subscription.available();
      spend(subscription.items.size());
      for (auto& [number, item] : subscription.items) {
        if (!body.send_initial_values || item.is_of_events()) continue;
        item.forget();
        put_current(subscription, item, request.now);
      }
      if (!result.available_sequence_numbers.empty() || body.send_initial_values) subscription.wait_again();
    }
    response.results.push_back(std::move(result));
  }
  return response;
}

Answer<RepublishResponse> Services::republish(const Request& request, const RepublishRequest& body) {
  Subscription* const subscription = subscription_of(request, body.subscription_id);
  if (subscription == nullptr) return StatusCode::BadSubscriptionIdInvalid;
  subscription->touch();
  const NotificationMessage* const message = subscription->sent(body.retransmit_sequence_number);
  if (message == nullptr) return StatusCode::BadMessageNotAvailable;
  RepublishResponse response;
  response.notification_message = *message;
  return response;
}

void Services::publish(const Request& request, const PublishRequest& body) {
  Session& session = *request.session;
  const auto refused = [&](StatusCode why) {
    fault(request.connection, request.id, request.header.request_handle, why, request.now);
  };
  if (body.subscription_acknowledgements.size() > settings_.limits.operations)
    return refused(StatusCode::BadTooManyOperations);
  QueuedPublish queued{request.id, request.header.request_handle, sim::LocalTime::never(), {}};
  for (const SubscriptionAcknowledgement& each : body.subscription_acknowledgements) {
    Subscription* const subscription = subscription_of(request, each.subscription_id);
    queued.acknowledged.push_back(subscription == nullptr ? StatusCode::BadSubscriptionIdInvalid
                                                          : subscription->acknowledge(each.sequence_number));
  }
  if (!has_subscriptions(session.token)) return refused(StatusCode::BadNoSubscription);
  constexpr std::uint32_t longest_ms = 86'400'000;
  if (request.header.timeout_hint != 0)
    queued.until = request.now.local + milliseconds(std::min(request.header.timeout_hint, longest_ms));
  for (auto& [id, subscription] : subscriptions_)
    if (subscription.session == session.token) subscription.touch();
  queued.held = HeldOctets(session.buffers);
  if (!queued.held.set(sizeof(QueuedPublish) + queued.acknowledged.size() * sizeof(StatusCode)))
    return refused(StatusCode::BadTooManyPublishRequests);
  session.publishes.push_back(std::move(queued));
  if (session.publishes.size() > settings_.limits.publish_requests) {
    const QueuedPublish oldest = std::move(session.publishes.front());
    session.publishes.pop_front();
    fault(request.connection, oldest.request_id, oldest.request_handle, StatusCode::BadTooManyPublishRequests,
          request.now);
  }
  answer_publishes(session, request.now);
}

/// The highest priority first; those of one priority take turns.
void Services::answer_publishes(Session& session, Now now) {
  while (!session.publishes.empty() && session.connection != 0) {
    Subscription* next = nullptr;
    for (auto& [id, subscription] : subscriptions_) {
      if (subscription.session != session.token || !subscription.is_waiting()) continue;
      const bool is_behind_last = next != nullptr && next->id <= session.last_published && id > session.last_published;
      if (next == nullptr || subscription.priority > next->priority ||
          (subscription.priority == next->priority && is_behind_last))
        next = &subscription;
    }
    if (next == nullptr) return;
    spend(100);
    QueuedPublish request = std::move(session.publishes.front());
    session.publishes.pop_front();
    session.last_published = next->id;
    PublishResponse response;
    response.subscription_id = next->id;
    response.notification_message = next->accept_message(
        now.utc, settings_.limits.retransmissions, settings_.limits.notification_octets, response.more_notifications);
    response.available_sequence_numbers = next->available();
    response.results = std::move(request.acknowledged);
    respond(session.connection, request.request_id, request.request_handle, std::move(response), now);
  }
}

void Services::expire(Subscription& subscription, Now now) {
  const auto session = sessions_.find(subscription.session);
  if (subscription.session.is_null() && subscription.left + settings_.limits.orphan_subscription <= now.local)
    return remove(subscription.id);
  spend(10 + 4 * subscription.items.size());
  for (auto& [id, item] : subscription.items) {
    const Node* const node = space_.find(item.what.node_id);
    if (node->computed && item.attribute() == AttributeId::Value) put_current(subscription, item, now);
  }
  const bool has_request = session != sessions_.end() && !session->second.publishes.empty();
  switch (subscription.expire(now.local, has_request)) {
    case Subscription::Expiry::nothing:
      return;
    case Subscription::Expiry::send:
      if (session != sessions_.end()) answer_publishes(session->second, now);
      return;
    case Subscription::Expiry::end: {
      remove(subscription.id);
      if (session != sessions_.end() && !has_subscriptions(session->first))
        refuse_publishes(session->second, StatusCode::BadNoSubscription, now);
      return;
    }
  }
}

}  // namespace takt::opcua
