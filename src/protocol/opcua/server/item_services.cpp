// SPDX-License-Identifier: Apache-2.0
// Monitored items (OPC 10000-4, 5.13).
#include <algorithm>
#include <cmath>

#include "opcua/server/numeric_range.hpp"
#include "opcua/server/services.hpp"

namespace takt::opcua {
namespace {

bool is_mode(MonitoringMode mode) { return static_cast<std::uint32_t>(mode) <= 2; }

/// Good if a filter of changes may be set on such a value.
StatusCode check_change_filter(const DataChangeFilter& filter, AttributeId attribute, const Node& node) {
  if (attribute != AttributeId::Value) return StatusCode::BadFilterNotAllowed;
  if (static_cast<std::uint32_t>(filter.trigger) > 2 || filter.deadband_type > 1)
    return StatusCode::BadMonitoredItemFilterUnsupported;
  if (filter.deadband_type == 0) return StatusCode::Good;
  const bool is_number = node.value.value && !node.value.value->is_array && number_in(*node.value.value) &&
                         node.value.value->type != BuiltInType::Boolean;
  if (!is_number || !(filter.deadband_value >= 0)) return StatusCode::BadFilterNotAllowed;
  return StatusCode::Good;
}

template <class Body>
StatusCode check_operations(const Body& operations, std::size_t most) {
  if (operations.empty()) return StatusCode::BadNothingToDo;
  return operations.size() > most ? StatusCode::BadTooManyOperations : StatusCode::Good;
}

}  // namespace

/// Changes are told as they happen, so the interval that a client asks for is given back; nothing is sampled but what
/// is made when it is read.
StatusCode Services::set_parameters(MonitoredItem& item, const Node& node, const MonitoringParameters& wanted,
                                    double publishing_ms, std::uint32_t& queue, double& sampling,
                                    ExtensionObject& filter_result) {
  const bool is_of_events = item.attribute() == AttributeId::EventNotifier;
  std::shared_ptr<const DecodedFilter> event_filter;
  DataChangeFilter change_filter;
  if (is_of_events) {
    const auto filter = structure_in<EventFilter>(wanted.filter);
    if (!filter) return StatusCode::BadEventFilterInvalid;
    const FilterCheck check = check_filter(*filter, space_, settings_.limits);
    if (check.has_errors) filter_result = extension_of(check.result);
    if (!check.is_usable) return StatusCode::BadEventFilterInvalid;
    event_filter = std::make_shared<const DecodedFilter>(*filter);
    spend(10 * (event_filter->steps() + event_filter->fields()));
  } else if (!wanted.filter.type.is_null()) {
    const auto filter = structure_in<DataChangeFilter>(wanted.filter);
    if (!filter)
      return structure_in<EventFilter>(wanted.filter) ? StatusCode::BadFilterNotAllowed
                                                      : StatusCode::BadMonitoredItemFilterUnsupported;
    if (const StatusCode status = check_change_filter(*filter, item.attribute(), node); !is_good(status)) return status;
    change_filter = *filter;
  }
  std::swap(item.event_filter, event_filter);
  if (!item.hold()) {
    std::swap(item.event_filter, event_filter);
    return StatusCode::BadTooManyMonitoredItems;
  }
  item.filter = change_filter;
  item.client_handle = wanted.client_handle;
  item.discard_oldest = wanted.discard_oldest;
  const std::size_t limit = is_of_events ? settings_.limits.event_queue : settings_.limits.queue;
  item.queue_size =
      is_of_events && wanted.queue_size == 0 ? limit : std::clamp<std::size_t>(wanted.queue_size, 1, limit);
  queue = static_cast<std::uint32_t>(item.queue_size);
  const double asked = wanted.sampling_interval < 0 ? publishing_ms : wanted.sampling_interval;
  sampling = is_of_events || !(asked >= 0) ? 0 : std::min(asked, 3'600'000.0);
  return StatusCode::Good;
}

MonitoredItemCreateResult Services::create_item(const Request& request, Subscription& subscription,
                                                const MonitoredItemCreateRequest& wanted, TimestampsToReturn times) {
  MonitoredItemCreateResult result;
  const auto refused = [&](StatusCode status) {
    result.status_code = status;
    return result;
  };
  spend(100);
  const Node* const node = space_.find(wanted.item_to_monitor.node_id);
  if (node == nullptr) return refused(StatusCode::BadNodeIdUnknown);
  if (!is_mode(wanted.monitoring_mode)) return refused(StatusCode::BadMonitoringModeInvalid);
  MonitoredItem item(subscription.account);
  item.events_before = events_;
  item.what = wanted.item_to_monitor;
  item.mode = wanted.monitoring_mode;
  item.timestamps = times;
  if (attribute_of(*node, item.attribute(), {request.now.utc}).result() == StatusCode::BadAttributeIdInvalid)
    return refused(StatusCode::BadAttributeIdInvalid);
  if (item.attribute() == AttributeId::EventNotifier && (node->event_notifier & 1) == 0)
    return refused(StatusCode::BadAttributeIdInvalid);
  if (Variant nothing; cut(nothing, item.what.index_range) == StatusCode::BadIndexRangeInvalid)
    return refused(StatusCode::BadIndexRangeInvalid);
  if (!item.what.data_encoding.name.empty() && !(item.what.data_encoding.name == "Default Binary"))
    return refused(StatusCode::BadDataEncodingUnsupported);
  if (subscription.items.size() >= settings_.limits.items) return refused(StatusCode::BadTooManyMonitoredItems);
  const double publishing_ms = static_cast<double>(subscription.interval.ps()) / 1e9;
  const StatusCode status =
      set_parameters(item, *node, wanted.requested_parameters, publishing_ms, result.revised_queue_size,
                     result.revised_sampling_interval, result.filter_result);
  if (!is_good(status)) return refused(status);
  item.id = ++last_item_;
  result.monitored_item_id = item.id;
  MonitoredItem& added = subscription.items.emplace(item.id, std::move(item)).first->second;
  watch(subscription, added, true);
  put_current(subscription, added, request.now);
  return result;
}

void Services::watch(const Subscription& subscription, const MonitoredItem& item, bool begins) {
  if (item.is_of_events()) {
    begins ? static_cast<void>(event_items_.emplace(subscription.id, item.id))
           : static_cast<void>(event_items_.erase({subscription.id, item.id}));
    return;
  }
  const auto key = std::pair(item.what.node_id, item.attribute());
  const auto who = std::pair(subscription.id, item.id);
  auto& watchers = watchers_[key];
  if (begins)
    watchers.push_back(who);
  else
    std::erase(watchers, who);
  if (watchers.empty()) watchers_.erase(key);
}

void Services::put_current(Subscription& subscription, MonitoredItem& item, Now now) {
  if (item.is_of_events()) return;
  spend(20);
  const auto session = sessions_.find(subscription.session);
  const Node* const node = space_.find(item.what.node_id);
  const DataValue value =
      value_for(session == sessions_.end() ? nullptr : &session->second, *node, item.attribute(), now);
  item.put(with_times(value, item.timestamps, now.utc, item.attribute() == AttributeId::Value));
}

void Services::changed(const Node& node, AttributeId attribute) {
  const auto found = watchers_.find(std::pair(node.id, attribute));
  if (found == watchers_.end()) return;
  for (const auto& [subscription, item] : found->second) {
    Subscription& of = subscriptions_.at(subscription);
    put_current(of, of.items.at(item), now_);
  }
}

Answer<CreateMonitoredItemsResponse> Services::create_items(const Request& request,
                                                            const CreateMonitoredItemsRequest& body) {
  Subscription* const subscription = subscription_of(request, body.subscription_id);
  if (subscription == nullptr) return StatusCode::BadSubscriptionIdInvalid;
  if (static_cast<std::uint32_t>(body.timestamps_to_return) > 3) return StatusCode::BadTimestampsToReturnInvalid;
  if (const StatusCode status = check_operations(body.items_to_create, settings_.limits.operations); !is_good(status))
    return status;
  CreateMonitoredItemsResponse response;
  for (const auto& each : body.items_to_create)
    response.results.push_back(create_item(request, *subscription, each, body.timestamps_to_return));
  return response;
}

Answer<ModifyMonitoredItemsResponse> Services::modify_items(const Request& request,
                                                            const ModifyMonitoredItemsRequest& body) {
  Subscription* const subscription = subscription_of(request, body.subscription_id);
  if (subscription == nullptr) return StatusCode::BadSubscriptionIdInvalid;
  if (static_cast<std::uint32_t>(body.timestamps_to_return) > 3) return StatusCode::BadTimestampsToReturnInvalid;
  if (const StatusCode status = check_operations(body.items_to_modify, settings_.limits.operations); !is_good(status))
    return status;
  ModifyMonitoredItemsResponse response;
  for (const auto& each : body.items_to_modify) {
    MonitoredItemModifyResult result;
    const auto item = subscription->items.find(each.monitored_item_id);
    if (item == subscription->items.end()) {
      result.status_code = StatusCode::BadMonitoredItemIdInvalid;
    } else {
      const double publishing_ms = static_cast<double>(subscription->interval.ps()) / 1e9;
      result.status_code = set_parameters(item->second, *space_.find(item->second.what.node_id),
                                          each.requested_parameters, publishing_ms, result.revised_queue_size,
                                          result.revised_sampling_interval, result.filter_result);
      item->second.timestamps = body.timestamps_to_return;
      item->second.shorten();
    }
    response.results.push_back(std::move(result));
  }
  return response;
}

Answer<SetMonitoringModeResponse> Services::set_monitoring_mode(const Request& request,
                                                                const SetMonitoringModeRequest& body) {
  Subscription* const subscription = subscription_of(request, body.subscription_id);
  if (subscription == nullptr) return StatusCode::BadSubscriptionIdInvalid;
  if (!is_mode(body.monitoring_mode)) return StatusCode::BadMonitoringModeInvalid;
  if (const StatusCode status = check_operations(body.monitored_item_ids, settings_.limits.operations);
      !is_good(status))
    return status;
  SetMonitoringModeResponse response;
  for (const std::uint32_t each : body.monitored_item_ids) {
    const auto found = subscription->items.find(each);
    response.results.push_back(found == subscription->items.end() ? StatusCode::BadMonitoredItemIdInvalid
                                                                  : StatusCode::Good);
    if (found == subscription->items.end()) continue;
    MonitoredItem& item = found->second;
    const bool begins = item.mode == MonitoringMode::Disabled && body.monitoring_mode != MonitoringMode::Disabled;
    item.mode = body.monitoring_mode;
    if (item.mode == MonitoringMode::Disabled) item.forget();
    if (begins) put_current(*subscription, item, request.now);
  }
  return response;
}

Answer<DeleteMonitoredItemsResponse> Services::delete_items(const Request& request,
                                                            const DeleteMonitoredItemsRequest& body) {
  Subscription* const subscription = subscription_of(request, body.subscription_id);
  if (subscription == nullptr) return StatusCode::BadSubscriptionIdInvalid;
  if (const StatusCode status = check_operations(body.monitored_item_ids, settings_.limits.operations);
      !is_good(status))
    return status;
  DeleteMonitoredItemsResponse response;
  for (const std::uint32_t each : body.monitored_item_ids) {
    const auto item = subscription->items.find(each);
    response.results.push_back(item == subscription->items.end() ? StatusCode::BadMonitoredItemIdInvalid
                                                                 : StatusCode::Good);
    if (item == subscription->items.end()) continue;
    watch(*subscription, item->second, false);
    subscription->items.erase(item);
  }
  return response;
}

}  // namespace takt::opcua
