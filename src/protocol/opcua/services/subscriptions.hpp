// SPDX-License-Identifier: Apache-2.0
// Subscriptions and what they send (OPC 10000-4, 5.14 and 7.25).
#pragma once

#include "opcua/services/headers.hpp"

namespace takt::opcua {

struct CreateSubscriptionRequest {
  static constexpr std::uint32_t encoding_id = 787;
  RequestHeader request_header;
  double requested_publishing_interval = 0;
  std::uint32_t requested_lifetime_count = 0;
  std::uint32_t requested_max_keep_alive_count = 0;
  std::uint32_t max_notifications_per_publish = 0;
  bool publishing_enabled = false;
  std::uint8_t priority = 0;
  static constexpr auto members() {
    return std::tuple(&CreateSubscriptionRequest::request_header,
                      &CreateSubscriptionRequest::requested_publishing_interval,
                      &CreateSubscriptionRequest::requested_lifetime_count,
                      &CreateSubscriptionRequest::requested_max_keep_alive_count,
                      &CreateSubscriptionRequest::max_notifications_per_publish,
                      &CreateSubscriptionRequest::publishing_enabled, &CreateSubscriptionRequest::priority);
  }
};

struct CreateSubscriptionResponse {
  static constexpr std::uint32_t encoding_id = 790;
  ResponseHeader response_header;
  std::uint32_t subscription_id = 0;
  double revised_publishing_interval = 0;
  std::uint32_t revised_lifetime_count = 0;
  std::uint32_t revised_max_keep_alive_count = 0;
  static constexpr auto members() {
    return std::tuple(&CreateSubscriptionResponse::response_header, &CreateSubscriptionResponse::subscription_id,
                      &CreateSubscriptionResponse::revised_publishing_interval,
                      &CreateSubscriptionResponse::revised_lifetime_count,
                      &CreateSubscriptionResponse::revised_max_keep_alive_count);
  }
};

struct ModifySubscriptionRequest {
  static constexpr std::uint32_t encoding_id = 793;
  RequestHeader request_header;
  std::uint32_t subscription_id = 0;
  double requested_publishing_interval = 0;
  std::uint32_t requested_lifetime_count = 0;
  std::uint32_t requested_max_keep_alive_count = 0;
  std::uint32_t max_notifications_per_publish = 0;
  std::uint8_t priority = 0;
  static constexpr auto members() {
    return std::tuple(&ModifySubscriptionRequest::request_header, &ModifySubscriptionRequest::subscription_id,
                      &ModifySubscriptionRequest::requested_publishing_interval,
                      &ModifySubscriptionRequest::requested_lifetime_count,
                      &ModifySubscriptionRequest::requested_max_keep_alive_count,
                      &ModifySubscriptionRequest::max_notifications_per_publish, &ModifySubscriptionRequest::priority);
  }
};

struct ModifySubscriptionResponse {
  static constexpr std::uint32_t encoding_id = 796;
  ResponseHeader response_header;
  double revised_publishing_interval = 0;
  std::uint32_t revised_lifetime_count = 0;
  std::uint32_t revised_max_keep_alive_count = 0;
  static constexpr auto members() {
    return std::tuple(
        &ModifySubscriptionResponse::response_header, &ModifySubscriptionResponse::revised_publishing_interval,
        &ModifySubscriptionResponse::revised_lifetime_count, &ModifySubscriptionResponse::revised_max_keep_alive_count);
  }
};

struct SetPublishingModeRequest {
  static constexpr std::uint32_t encoding_id = 799;
  RequestHeader request_header;
  bool publishing_enabled = false;
  List<std::uint32_t> subscription_ids;
  static constexpr auto members() {
    return std::tuple(&SetPublishingModeRequest::request_header, &SetPublishingModeRequest::publishing_enabled,
                      &SetPublishingModeRequest::subscription_ids);
  }
};

struct SetPublishingModeResponse {
  static constexpr std::uint32_t encoding_id = 802;
  ResponseHeader response_header;
  List<StatusCode> results;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&SetPublishingModeResponse::response_header, &SetPublishingModeResponse::results,
                      &SetPublishingModeResponse::diagnostic_infos);
  }
};

struct DeleteSubscriptionsRequest {
  static constexpr std::uint32_t encoding_id = 847;
  RequestHeader request_header;
  List<std::uint32_t> subscription_ids;
  static constexpr auto members() {
    return std::tuple(&DeleteSubscriptionsRequest::request_header, &DeleteSubscriptionsRequest::subscription_ids);
  }
};

struct DeleteSubscriptionsResponse {
  static constexpr std::uint32_t encoding_id = 850;
  ResponseHeader response_header;
  List<StatusCode> results;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&DeleteSubscriptionsResponse::response_header, &DeleteSubscriptionsResponse::results,
                      &DeleteSubscriptionsResponse::diagnostic_infos);
  }
};

struct TransferResult {
  static constexpr std::uint32_t encoding_id = 838;
  StatusCode status_code = StatusCode::Good;
  List<std::uint32_t> available_sequence_numbers;
  static constexpr auto members() {
    return std::tuple(&TransferResult::status_code, &TransferResult::available_sequence_numbers);
  }
};

struct TransferSubscriptionsRequest {
  static constexpr std::uint32_t encoding_id = 841;
  RequestHeader request_header;
  List<std::uint32_t> subscription_ids;
  bool send_initial_values = false;
  static constexpr auto members() {
    return std::tuple(&TransferSubscriptionsRequest::request_header, &TransferSubscriptionsRequest::subscription_ids,
                      &TransferSubscriptionsRequest::send_initial_values);
  }
};

struct TransferSubscriptionsResponse {
  static constexpr std::uint32_t encoding_id = 844;
  ResponseHeader response_header;
  List<TransferResult> results;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&TransferSubscriptionsResponse::response_header, &TransferSubscriptionsResponse::results,
                      &TransferSubscriptionsResponse::diagnostic_infos);
  }
};

struct SubscriptionAcknowledgement {
  static constexpr std::uint32_t encoding_id = 823;
  std::uint32_t subscription_id = 0;
  std::uint32_t sequence_number = 0;
  static constexpr auto members() {
    return std::tuple(&SubscriptionAcknowledgement::subscription_id, &SubscriptionAcknowledgement::sequence_number);
  }
};

struct PublishRequest {
  static constexpr std::uint32_t encoding_id = 826;
  RequestHeader request_header;
  List<SubscriptionAcknowledgement> subscription_acknowledgements;
  static constexpr auto members() {
    return std::tuple(&PublishRequest::request_header, &PublishRequest::subscription_acknowledgements);
  }
};

struct NotificationMessage {
  static constexpr std::uint32_t encoding_id = 805;
  std::uint32_t sequence_number = 0;
  DateTime publish_time;
  List<ExtensionObject> notification_data;
  static constexpr auto members() {
    return std::tuple(&NotificationMessage::sequence_number, &NotificationMessage::publish_time,
                      &NotificationMessage::notification_data);
  }
};

struct PublishResponse {
  static constexpr std::uint32_t encoding_id = 829;
  ResponseHeader response_header;
  std::uint32_t subscription_id = 0;
  List<std::uint32_t> available_sequence_numbers;
  bool more_notifications = false;
  NotificationMessage notification_message;
  List<StatusCode> results;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&PublishResponse::response_header, &PublishResponse::subscription_id,
                      &PublishResponse::available_sequence_numbers, &PublishResponse::more_notifications,
                      &PublishResponse::notification_message, &PublishResponse::results,
                      &PublishResponse::diagnostic_infos);
  }
};

struct RepublishRequest {
  static constexpr std::uint32_t encoding_id = 832;
  RequestHeader request_header;
  std::uint32_t subscription_id = 0;
  std::uint32_t retransmit_sequence_number = 0;
  static constexpr auto members() {
    return std::tuple(&RepublishRequest::request_header, &RepublishRequest::subscription_id,
                      &RepublishRequest::retransmit_sequence_number);
  }
};

struct RepublishResponse {
  static constexpr std::uint32_t encoding_id = 835;
  ResponseHeader response_header;
  NotificationMessage notification_message;
  static constexpr auto members() {
    return std::tuple(&RepublishResponse::response_header, &RepublishResponse::notification_message);
  }
};

struct MonitoredItemNotification {
  static constexpr std::uint32_t encoding_id = 808;
  std::uint32_t client_handle = 0;
  DataValue value;
  static constexpr auto members() {
    return std::tuple(&MonitoredItemNotification::client_handle, &MonitoredItemNotification::value);
  }
};

struct DataChangeNotification {
  static constexpr std::uint32_t encoding_id = 811;
  List<MonitoredItemNotification> monitored_items;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&DataChangeNotification::monitored_items, &DataChangeNotification::diagnostic_infos);
  }
};

struct EventFieldList {
  static constexpr std::uint32_t encoding_id = 919;
  std::uint32_t client_handle = 0;
  List<Variant> event_fields;
  static constexpr auto members() { return std::tuple(&EventFieldList::client_handle, &EventFieldList::event_fields); }
};

struct EventNotificationList {
  static constexpr std::uint32_t encoding_id = 916;
  List<EventFieldList> events;
  static constexpr auto members() { return std::tuple(&EventNotificationList::events); }
};

struct StatusChangeNotification {
  static constexpr std::uint32_t encoding_id = 820;
  StatusCode status = StatusCode::Good;
  DiagnosticInfo diagnostic_info;
  static constexpr auto members() {
    return std::tuple(&StatusChangeNotification::status, &StatusChangeNotification::diagnostic_info);
  }
};

}  // namespace takt::opcua
