// SPDX-License-Identifier: Apache-2.0
// Monitored items (OPC 10000-4, 5.13).
#pragma once

#include "opcua/services/attributes.hpp"

namespace takt::opcua {

enum class MonitoringMode : std::int32_t { Disabled, Sampling, Reporting };

struct MonitoringParameters {
  static constexpr std::uint32_t encoding_id = 742;
  std::uint32_t client_handle = 0;
  double sampling_interval = 0;
  ExtensionObject filter;
  std::uint32_t queue_size = 0;
  bool discard_oldest = false;
  static constexpr auto members() {
    return std::tuple(&MonitoringParameters::client_handle, &MonitoringParameters::sampling_interval,
                      &MonitoringParameters::filter, &MonitoringParameters::queue_size,
                      &MonitoringParameters::discard_oldest);
  }
};

struct MonitoredItemCreateRequest {
  static constexpr std::uint32_t encoding_id = 745;
  ReadValueId item_to_monitor;
  MonitoringMode monitoring_mode = MonitoringMode::Disabled;
  MonitoringParameters requested_parameters;
  static constexpr auto members() {
    return std::tuple(&MonitoredItemCreateRequest::item_to_monitor, &MonitoredItemCreateRequest::monitoring_mode,
                      &MonitoredItemCreateRequest::requested_parameters);
  }
};

struct CreateMonitoredItemsRequest {
  static constexpr std::uint32_t encoding_id = 751;
  RequestHeader request_header;
  std::uint32_t subscription_id = 0;
  TimestampsToReturn timestamps_to_return = TimestampsToReturn::Source;
  List<MonitoredItemCreateRequest> items_to_create;
  static constexpr auto members() {
    return std::tuple(&CreateMonitoredItemsRequest::request_header, &CreateMonitoredItemsRequest::subscription_id,
                      &CreateMonitoredItemsRequest::timestamps_to_return,
                      &CreateMonitoredItemsRequest::items_to_create);
  }
};

struct MonitoredItemCreateResult {
  static constexpr std::uint32_t encoding_id = 748;
  StatusCode status_code = StatusCode::Good;
  std::uint32_t monitored_item_id = 0;
  double revised_sampling_interval = 0;
  std::uint32_t revised_queue_size = 0;
  ExtensionObject filter_result;
  static constexpr auto members() {
    return std::tuple(&MonitoredItemCreateResult::status_code, &MonitoredItemCreateResult::monitored_item_id,
                      &MonitoredItemCreateResult::revised_sampling_interval,
                      &MonitoredItemCreateResult::revised_queue_size, &MonitoredItemCreateResult::filter_result);
  }
};

struct CreateMonitoredItemsResponse {
  static constexpr std::uint32_t encoding_id = 754;
  ResponseHeader response_header;
  List<MonitoredItemCreateResult> results;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&CreateMonitoredItemsResponse::response_header, &CreateMonitoredItemsResponse::results,
                      &CreateMonitoredItemsResponse::diagnostic_infos);
  }
};

struct MonitoredItemModifyRequest {
  static constexpr std::uint32_t encoding_id = 757;
  std::uint32_t monitored_item_id = 0;
  MonitoringParameters requested_parameters;
  static constexpr auto members() {
    return std::tuple(&MonitoredItemModifyRequest::monitored_item_id,
                      &MonitoredItemModifyRequest::requested_parameters);
  }
};

struct ModifyMonitoredItemsRequest {
  static constexpr std::uint32_t encoding_id = 763;
  RequestHeader request_header;
  std::uint32_t subscription_id = 0;
  TimestampsToReturn timestamps_to_return = TimestampsToReturn::Source;
  List<MonitoredItemModifyRequest> items_to_modify;
  static constexpr auto members() {
    return std::tuple(&ModifyMonitoredItemsRequest::request_header, &ModifyMonitoredItemsRequest::subscription_id,
                      &ModifyMonitoredItemsRequest::timestamps_to_return,
                      &ModifyMonitoredItemsRequest::items_to_modify);
  }
};

struct MonitoredItemModifyResult {
  static constexpr std::uint32_t encoding_id = 760;
  StatusCode status_code = StatusCode::Good;
  double revised_sampling_interval = 0;
  std::uint32_t revised_queue_size = 0;
  ExtensionObject filter_result;
  static constexpr auto members() {
    return std::tuple(&MonitoredItemModifyResult::status_code, &MonitoredItemModifyResult::revised_sampling_interval,
                      &MonitoredItemModifyResult::revised_queue_size, &MonitoredItemModifyResult::filter_result);
  }
};

struct ModifyMonitoredItemsResponse {
  static constexpr std::uint32_t encoding_id = 766;
  ResponseHeader response_header;
  List<MonitoredItemModifyResult> results;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&ModifyMonitoredItemsResponse::response_header, &ModifyMonitoredItemsResponse::results,
                      &ModifyMonitoredItemsResponse::diagnostic_infos);
  }
};

struct SetMonitoringModeRequest {
  static constexpr std::uint32_t encoding_id = 769;
  RequestHeader request_header;
  std::uint32_t subscription_id = 0;
  MonitoringMode monitoring_mode = MonitoringMode::Disabled;
  List<std::uint32_t> monitored_item_ids;
  static constexpr auto members() {
    return std::tuple(&SetMonitoringModeRequest::request_header, &SetMonitoringModeRequest::subscription_id,
                      &SetMonitoringModeRequest::monitoring_mode, &SetMonitoringModeRequest::monitored_item_ids);
  }
};

struct SetMonitoringModeResponse {
  static constexpr std::uint32_t encoding_id = 772;
  ResponseHeader response_header;
  List<StatusCode> results;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&SetMonitoringModeResponse::response_header, &SetMonitoringModeResponse::results,
                      &SetMonitoringModeResponse::diagnostic_infos);
  }
};

struct DeleteMonitoredItemsRequest {
  static constexpr std::uint32_t encoding_id = 781;
  RequestHeader request_header;
  std::uint32_t subscription_id = 0;
  List<std::uint32_t> monitored_item_ids;
  static constexpr auto members() {
    return std::tuple(&DeleteMonitoredItemsRequest::request_header, &DeleteMonitoredItemsRequest::subscription_id,
                      &DeleteMonitoredItemsRequest::monitored_item_ids);
  }
};

struct DeleteMonitoredItemsResponse {
  static constexpr std::uint32_t encoding_id = 784;
  ResponseHeader response_header;
  List<StatusCode> results;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&DeleteMonitoredItemsResponse::response_header, &DeleteMonitoredItemsResponse::results,
                      &DeleteMonitoredItemsResponse::diagnostic_infos);
  }
};

}  // namespace takt::opcua
