// SPDX-License-Identifier: Apache-2.0
// Nodes, their attributes and their references (OPC 10000-3): what is browsed, read and monitored.
#pragma once

#include <functional>
#include <map>
#include <span>

#include "opcua/address_space/standard_nodes.hpp"
#include "opcua/services/attributes.hpp"
#include "opcua/services/view.hpp"

namespace takt::opcua {

struct Reference {
  NodeId type;
  NodeId target;
  bool is_forward = true;
  bool operator==(const Reference&) const = default;
};

/// What a value depends on when it is read.
struct ReadContext {
  DateTime now;
};

struct Node {
  NodeId id;
  NodeClass node_class = NodeClass::Object;
  QualifiedName browse_name;
  LocalizedText display_name;
  std::vector<Reference> references = {};
  bool is_abstract = false;
  bool is_symmetric = false;
  LocalizedText inverse_name = {};
  std::uint8_t event_notifier = 0;
  NodeId data_type = {};
  std::int32_t value_rank = -1;
  DataValue value = {};
  /// Instead of `value`, where it is made when it is read.
  std::function<DataValue(const ReadContext&)> computed = {};
  bool executable = false;          ///< of a method
  ExtensionObject definition = {};  ///< of a data type
};

/// A node with a name to be found under.
Node make_node(NodeId id, NodeClass node_class, std::uint16_t name_space, std::string_view name);

class AddressSpace {
 public:
  /// Somebody is told of each change of an attribute (a value, or Executable).
  using Listener = std::function<void(const Node& node, AttributeId attribute)>;

  /// With namespace 0.
  AddressSpace();
  AddressSpace(const AddressSpace&) = delete;
  AddressSpace& operator=(const AddressSpace&) = delete;

  void listen(Listener listener) { listener_ = std::move(listener); }

  /// A node that is not there yet.
  Node& add(Node node);
  /// Forward and, at the target, inverse. Both nodes are there.
  void refer(const NodeId& from, std::uint32_t type, const NodeId& to);
  /// Below a parent, of a type (0: a method, which has none).
  Node& add_below(const NodeId& parent, std::uint32_t reference, Node node, std::uint32_t type);

  /// Null if there is none.
  const Node* find(const NodeId& id) const;
  Node* find(const NodeId& id);
  std::size_t size() const { return nodes_.size(); }

  /// The same value is no change; another status or another time of the same value is told with the next one.
  void set_value(const NodeId& id, Variant value, DateTime source_time, StatusCode status = StatusCode::Good);
  void set_executable(const NodeId& id, bool executable);

  /// `type` is `base`, or below it by HasSubtype.
  bool is_subtype(const NodeId& type, const NodeId& base) const;
  /// The first target by references of a type, forward; null if there is none.
  const Node* target(const Node& from, std::uint32_t type) const;

 private:
  std::map<NodeId, Node> nodes_;
  Listener listener_;
};

/// An attribute as Read gives it, but for what depends on the user: UserExecutable is Executable.
/// Bad_AttributeIdInvalid for one that the node has not.
DataValue attribute_of(const Node& node, AttributeId attribute, const ReadContext& context);

}  // namespace takt::opcua
