// SPDX-License-Identifier: Apache-2.0
// Browsing (OPC 10000-4, 5.8).
#pragma once

#include "opcua/services/headers.hpp"

namespace takt::opcua {

enum class BrowseDirection : std::int32_t { Forward, Inverse, Both };
/// Also the bits of a mask of classes.
enum class NodeClass : std::int32_t {
  Unspecified = 0,
  Object = 1,
  Variable = 2,
  Method = 4,
  ObjectType = 8,
  VariableType = 16,
  ReferenceType = 32,
  DataType = 64,
  View = 128
};

struct ViewDescription {
  static constexpr std::uint32_t encoding_id = 513;
  NodeId view_id;
  DateTime timestamp;
  std::uint32_t view_version = 0;
  static constexpr auto members() {
    return std::tuple(&ViewDescription::view_id, &ViewDescription::timestamp, &ViewDescription::view_version);
  }
};

struct BrowseDescription {
  static constexpr std::uint32_t encoding_id = 516;
  NodeId node_id;
  BrowseDirection browse_direction = BrowseDirection::Forward;
  NodeId reference_type_id;
  bool include_subtypes = false;
  std::uint32_t node_class_mask = 0;
  std::uint32_t result_mask = 0;
  static constexpr auto members() {
    return std::tuple(&BrowseDescription::node_id, &BrowseDescription::browse_direction,
                      &BrowseDescription::reference_type_id, &BrowseDescription::include_subtypes,
                      &BrowseDescription::node_class_mask, &BrowseDescription::result_mask);
  }
};

struct BrowseRequest {
  static constexpr std::uint32_t encoding_id = 527;
  RequestHeader request_header;
  ViewDescription view;
  std::uint32_t requested_max_references_per_node = 0;
  List<BrowseDescription> nodes_to_browse;
  static constexpr auto members() {
    return std::tuple(&BrowseRequest::request_header, &BrowseRequest::view,
                      &BrowseRequest::requested_max_references_per_node, &BrowseRequest::nodes_to_browse);
  }
};

struct ReferenceDescription {
  static constexpr std::uint32_t encoding_id = 520;
  NodeId reference_type_id;
  bool is_forward = false;
  ExpandedNodeId node_id;
  QualifiedName browse_name;
  LocalizedText display_name;
  NodeClass node_class = NodeClass::Unspecified;
  ExpandedNodeId type_definition;
  static constexpr auto members() {
    return std::tuple(&ReferenceDescription::reference_type_id, &ReferenceDescription::is_forward,
                      &ReferenceDescription::node_id, &ReferenceDescription::browse_name,
                      &ReferenceDescription::display_name, &ReferenceDescription::node_class,
                      &ReferenceDescription::type_definition);
  }
};

struct BrowseResult {
  static constexpr std::uint32_t encoding_id = 524;
  StatusCode status_code = StatusCode::Good;
  Bytes continuation_point;
  List<ReferenceDescription> references;
  static constexpr auto members() {
    return std::tuple(&BrowseResult::status_code, &BrowseResult::continuation_point, &BrowseResult::references);
  }
};

struct BrowseResponse {
  static constexpr std::uint32_t encoding_id = 530;
  ResponseHeader response_header;
  List<BrowseResult> results;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&BrowseResponse::response_header, &BrowseResponse::results, &BrowseResponse::diagnostic_infos);
  }
};

struct BrowseNextRequest {
  static constexpr std::uint32_t encoding_id = 533;
  RequestHeader request_header;
  bool release_continuation_points = false;
  List<Bytes> continuation_points;
  static constexpr auto members() {
    return std::tuple(&BrowseNextRequest::request_header, &BrowseNextRequest::release_continuation_points,
                      &BrowseNextRequest::continuation_points);
  }
};

struct BrowseNextResponse {
  static constexpr std::uint32_t encoding_id = 536;
  ResponseHeader response_header;
  List<BrowseResult> results;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&BrowseNextResponse::response_header, &BrowseNextResponse::results,
                      &BrowseNextResponse::diagnostic_infos);
  }
};

struct RelativePathElement {
  static constexpr std::uint32_t encoding_id = 539;
  NodeId reference_type_id;
  bool is_inverse = false;
  bool include_subtypes = false;
  QualifiedName target_name;
  static constexpr auto members() {
    return std::tuple(&RelativePathElement::reference_type_id, &RelativePathElement::is_inverse,
                      &RelativePathElement::include_subtypes, &RelativePathElement::target_name);
  }
};

struct RelativePath {
  static constexpr std::uint32_t encoding_id = 542;
  List<RelativePathElement> elements;
  static constexpr auto members() { return std::tuple(&RelativePath::elements); }
};

struct BrowsePath {
  static constexpr std::uint32_t encoding_id = 545;
  NodeId starting_node;
  RelativePath relative_path;
  static constexpr auto members() { return std::tuple(&BrowsePath::starting_node, &BrowsePath::relative_path); }
};

struct TranslateBrowsePathsToNodeIdsRequest {
  static constexpr std::uint32_t encoding_id = 554;
  RequestHeader request_header;
  List<BrowsePath> browse_paths;
  static constexpr auto members() {
    return std::tuple(&TranslateBrowsePathsToNodeIdsRequest::request_header,
                      &TranslateBrowsePathsToNodeIdsRequest::browse_paths);
  }
};

struct BrowsePathTarget {
  static constexpr std::uint32_t encoding_id = 548;
  ExpandedNodeId target_id;
  std::uint32_t remaining_path_index = 0;
  static constexpr auto members() {
    return std::tuple(&BrowsePathTarget::target_id, &BrowsePathTarget::remaining_path_index);
  }
};

struct BrowsePathResult {
  static constexpr std::uint32_t encoding_id = 551;
  StatusCode status_code = StatusCode::Good;
  List<BrowsePathTarget> targets;
  static constexpr auto members() { return std::tuple(&BrowsePathResult::status_code, &BrowsePathResult::targets); }
};

struct TranslateBrowsePathsToNodeIdsResponse {
  static constexpr std::uint32_t encoding_id = 557;
  ResponseHeader response_header;
  List<BrowsePathResult> results;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&TranslateBrowsePathsToNodeIdsResponse::response_header,
                      &TranslateBrowsePathsToNodeIdsResponse::results,
                      &TranslateBrowsePathsToNodeIdsResponse::diagnostic_infos);
  }
};

struct RegisterNodesRequest {
  static constexpr std::uint32_t encoding_id = 560;
  RequestHeader request_header;
  List<NodeId> nodes_to_register;
  static constexpr auto members() {
    return std::tuple(&RegisterNodesRequest::request_header, &RegisterNodesRequest::nodes_to_register);
  }
};

struct RegisterNodesResponse {
  static constexpr std::uint32_t encoding_id = 563;
  ResponseHeader response_header;
  List<NodeId> registered_node_ids;
  static constexpr auto members() {
    return std::tuple(&RegisterNodesResponse::response_header, &RegisterNodesResponse::registered_node_ids);
  }
};

struct UnregisterNodesRequest {
  static constexpr std::uint32_t encoding_id = 566;
  RequestHeader request_header;
  List<NodeId> nodes_to_unregister;
  static constexpr auto members() {
    return std::tuple(&UnregisterNodesRequest::request_header, &UnregisterNodesRequest::nodes_to_unregister);
  }
};

struct UnregisterNodesResponse {
  static constexpr std::uint32_t encoding_id = 569;
  ResponseHeader response_header;
  static constexpr auto members() { return std::tuple(&UnregisterNodesResponse::response_header); }
};

}  // namespace takt::opcua
