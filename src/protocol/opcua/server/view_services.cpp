// SPDX-License-Identifier: Apache-2.0
// Browsing (OPC 10000-4, 5.8).
#include <algorithm>

#include "opcua/server/services.hpp"

namespace takt::opcua {
namespace {

constexpr std::size_t most_references_of_request = 50'000;

namespace result_mask {
constexpr std::uint32_t reference_type = 1, is_forward = 2, node_class = 4, browse_name = 8, display_name = 16,
                        type_definition = 32;
}

/// References of this type, or of one below it; all, if it is null.
bool is_wanted(const AddressSpace& space, const Reference& reference, const NodeId& type, bool subtypes) {
  if (type.is_null() || reference.type == type) return true;
  return subtypes && space.is_subtype(reference.type, type);
}

bool is_reference_type(const AddressSpace& space, const NodeId& id) {
  const Node* const node = space.find(id);
  return id.is_null() || (node != nullptr && node->node_class == NodeClass::ReferenceType);
}

}  // namespace

ReferenceDescription Services::describe(const Reference& reference, std::uint32_t mask) const {
  ReferenceDescription made;
  const Node& target = *space_.find(reference.target);
  made.node_id = ExpandedNodeId(target.id);
  if ((mask & result_mask::reference_type) != 0) made.reference_type_id = reference.type;
  made.is_forward = (mask & result_mask::is_forward) != 0 && reference.is_forward;
  if ((mask & result_mask::node_class) != 0) made.node_class = target.node_class;
  if ((mask & result_mask::browse_name) != 0) made.browse_name = target.browse_name;
  if ((mask & result_mask::display_name) != 0) made.display_name = target.display_name;
  const Node* const type = space_.target(target, ids::has_type_definition);
  if ((mask & result_mask::type_definition) != 0 && type != nullptr) made.type_definition = ExpandedNodeId(type->id);
  return made;
}

/// More than the longest response has; a request that wants more is to be several.
bool Services::may_look_at(std::size_t references) {
  looked_at_ += references + 1;
  spend(5 * (references + 1));
  return looked_at_ <= most_references_of_request;
}

BrowseResult Services::browse(Session& session, const BrowseDescription& what, std::size_t most) {
  BrowseResult result;
  const Node* const node = space_.find(what.node_id);
  if (node == nullptr)
    result.status_code = StatusCode::BadNodeIdUnknown;
  else if (static_cast<std::uint32_t>(what.browse_direction) > 2)
    result.status_code = StatusCode::BadBrowseDirectionInvalid;
  else if (!is_reference_type(space_, what.reference_type_id))
    result.status_code = StatusCode::BadReferenceTypeIdInvalid;
  if (!is_good(result.status_code)) return result;
  result.references.is_empty_not_null = true;
  if (!may_look_at(node->references.size())) {
    result.status_code = StatusCode::BadResourceUnavailable;
    return result;
  }
  for (const Reference& each : node->references) {
    if (what.browse_direction != BrowseDirection::Both &&
        each.is_forward != (what.browse_direction == BrowseDirection::Forward))
      continue;
    if (!is_wanted(space_, each, what.reference_type_id, what.include_subtypes)) continue;
    const auto target_class = static_cast<std::uint32_t>(space_.find(each.target)->node_class);
    if (what.node_class_mask != 0 && (what.node_class_mask & target_class) == 0) continue;
    result.references.push_back(describe(each, what.result_mask));
  }
  cut_references(session, result, most);
  return result;
}

/// What is beyond `most` waits behind a continuation point.
void Services::cut_references(Session& session, BrowseResult& result, std::size_t most) {
  if (result.references.size() <= most) return;
  if (session.points.size() >= settings_.limits.continuation_points) {
    result = BrowseResult();
    result.status_code = StatusCode::BadNoContinuationPoints;
    return;
  }
  ContinuationPoint point;
  point.most = most;
  point.held = HeldOctets(session.buffers);
  if (!point.held.set((result.references.size() - most) * sizeof(ReferenceDescription) * 2)) {
    result = BrowseResult();
    result.status_code = StatusCode::BadNoContinuationPoints;
    return;
  }
  const auto behind = result.references.begin() + static_cast<std::ptrdiff_t>(most);
  point.references.assign(behind, result.references.end());
  result.references.erase(behind, result.references.end());
  result.continuation_point = Bytes(random_octets(16));
  session.points.emplace(result.continuation_point, std::move(point));
}

Answer<BrowseResponse> Services::browse(const Request& request, const BrowseRequest& body) {
  if (body.nodes_to_browse.empty()) return StatusCode::BadNothingToDo;
  if (body.nodes_to_browse.size() > settings_.limits.operations) return StatusCode::BadTooManyOperations;
  if (!body.view.view_id.is_null()) return StatusCode::BadViewIdUnknown;
  const std::size_t limit = settings_.limits.references;
  const std::size_t most = body.requested_max_references_per_node == 0
                               ? limit
                               : std::min<std::size_t>(limit, body.requested_max_references_per_node);
  BrowseResponse response;
  looked_at_ = 0;
  for (const BrowseDescription& each : body.nodes_to_browse)
    response.results.push_back(browse(*request.session, each, most));
  return response;
}

Answer<BrowseNextResponse> Services::browse_next(const Request& request, const BrowseNextRequest& body) {
  if (body.continuation_points.empty()) return StatusCode::BadNothingToDo;
  if (body.continuation_points.size() > settings_.limits.operations) return StatusCode::BadTooManyOperations;
  BrowseNextResponse response;
  for (const Bytes& each : body.continuation_points) {
    BrowseResult result;
    auto point = request.session->points.extract(each);
    if (point.empty()) {
      result.status_code = StatusCode::BadContinuationPointInvalid;
    } else if (!body.release_continuation_points) {
      result.references = std::move(point.mapped().references);
      cut_references(*request.session, result, point.mapped().most);
    }
    if (!body.release_continuation_points || !is_good(result.status_code))
      response.results.push_back(std::move(result));
  }
  return response;
}

BrowsePathResult Services::translate(const BrowsePath& path) {
  BrowsePathResult result;
  const auto failed = [&](StatusCode status) {
    result.status_code = status;
    return result;
  };
  if (space_.find(path.starting_node) == nullptr) return failed(StatusCode::BadNodeIdUnknown);
  if (path.relative_path.elements.empty()) return failed(StatusCode::BadNothingToDo);
  if (path.relative_path.elements.back().target_name.name.empty()) return failed(StatusCode::BadBrowseNameInvalid);
  std::vector<const Node*> at = {space_.find(path.starting_node)};
  for (const RelativePathElement& element : path.relative_path.elements) {
    if (!is_reference_type(space_, element.reference_type_id)) return failed(StatusCode::BadReferenceTypeIdInvalid);
    std::vector<const Node*> next;
    for (const Node* const node : at) {
      if (!may_look_at(node->references.size())) return failed(StatusCode::BadResourceUnavailable);
      for (const Reference& each : node->references) {
        if (each.is_forward == element.is_inverse ||
            !is_wanted(space_, each, element.reference_type_id, element.include_subtypes))
          continue;
        const Node* const target = space_.find(each.target);
        if (target->browse_name == element.target_name && std::find(next.begin(), next.end(), target) == next.end())
          next.push_back(target);
      }
    }
    at = std::move(next);
  }
  if (at.empty()) return failed(StatusCode::BadNoMatch);
  for (const Node* const node : at) result.targets.push_back({ExpandedNodeId(node->id), 0xFFFF'FFFFU});
  return result;
}

Answer<TranslateBrowsePathsToNodeIdsResponse> Services::translate(const Request&,
                                                                  const TranslateBrowsePathsToNodeIdsRequest& body) {
  if (body.browse_paths.empty()) return StatusCode::BadNothingToDo;
  if (body.browse_paths.size() > settings_.limits.operations) return StatusCode::BadTooManyOperations;
  TranslateBrowsePathsToNodeIdsResponse response;
  looked_at_ = 0;
  for (const BrowsePath& each : body.browse_paths) response.results.push_back(translate(each));
  return response;
}

/// Identifiers are quick enough as they are.
Answer<RegisterNodesResponse> Services::register_nodes(const Request&, const RegisterNodesRequest& body) {
  if (body.nodes_to_register.empty()) return StatusCode::BadNothingToDo;
  if (body.nodes_to_register.size() > settings_.limits.operations) return StatusCode::BadTooManyOperations;
  RegisterNodesResponse response;
  response.registered_node_ids = body.nodes_to_register;
  return response;
}

Answer<UnregisterNodesResponse> Services::unregister_nodes(const Request&, const UnregisterNodesRequest& body) {
  if (body.nodes_to_unregister.empty()) return StatusCode::BadNothingToDo;
  return UnregisterNodesResponse();
}

}  // namespace takt::opcua
