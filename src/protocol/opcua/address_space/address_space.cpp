// SPDX-License-Identifier: Apache-2.0
#include "opcua/address_space/address_space.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::opcua {
namespace {

/// OPC 10000-3, 8.48 and 8.49, with their binary encodings.
struct StructureField {
  Text name;
  LocalizedText description;
  NodeId data_type;
  std::int32_t value_rank = -1;
  List<std::uint32_t> array_dimensions;
  std::uint32_t max_string_length = 0;
  bool is_optional = false;
  static constexpr auto members() {
    return std::tuple(&StructureField::name, &StructureField::description, &StructureField::data_type,
                      &StructureField::value_rank, &StructureField::array_dimensions,
                      &StructureField::max_string_length, &StructureField::is_optional);
  }
};
struct StructureDefinition {
  static constexpr std::uint32_t encoding_id = ids::structure_definition_encoding;
  NodeId default_encoding_id;
  NodeId base_data_type = NodeId(22);
  std::int32_t structure_type = 0;
  List<StructureField> fields;
  static constexpr auto members() {
    return std::tuple(&StructureDefinition::default_encoding_id, &StructureDefinition::base_data_type,
                      &StructureDefinition::structure_type, &StructureDefinition::fields);
  }
};
struct EnumField {
  std::int64_t value = 0;
  LocalizedText display_name;
  LocalizedText description;
  Text name;
  static constexpr auto members() {
    return std::tuple(&EnumField::value, &EnumField::display_name, &EnumField::description, &EnumField::name);
  }
};
struct EnumDefinition {
  static constexpr std::uint32_t encoding_id = ids::enum_definition_encoding;
  List<EnumField> fields;
  static constexpr auto members() { return std::tuple(&EnumDefinition::fields); }
};

constexpr std::uint32_t has_encoding = 38;

/// Of the fields of one data type.
ExtensionObject definition_of(std::span<const StandardField> fields) {
  if (fields.front().value >= 0) {
    EnumDefinition made;
    for (const StandardField& each : fields)
      made.fields.push_back({each.value, LocalizedText(each.name), {}, Text(each.name)});
    return extension_of(made);
  }
  StructureDefinition made;
  for (const StandardReference& each : standard_references())
    if (each.from == fields.front().of && each.type == has_encoding) made.default_encoding_id = NodeId(each.to);
  for (const StandardField& each : fields)
    made.fields.push_back({Text(each.name), {}, NodeId(each.data_type), each.value_rank, {}, 0, false});
  return extension_of(made);
}

Node standard_node(const StandardNode& from) {
  Node node = make_node(NodeId(from.id), from.node_class, 0, from.name);
  node.inverse_name = from.inverse_name.empty() ? LocalizedText() : LocalizedText(from.inverse_name);
  node.is_abstract = from.is_abstract;
  node.is_symmetric = from.is_symmetric;
  node.event_notifier = from.event_notifier;
  node.data_type = NodeId(from.data_type);
  node.value_rank = from.value_rank;
  node.executable = from.node_class == NodeClass::Method;
  if (from.number >= 0) node.value.value = Variant(static_cast<std::uint32_t>(from.number));
  return node;
}

template <class T>
DataValue of_value(T value) {
  DataValue made;
  made.value = Variant(std::move(value));
  return made;
}

DataValue value_of(const Node& node, const ReadContext& context) {
  return node.computed ? node.computed(context) : node.value;
}

/// Of arrays their number of dimensions, each of any length.
DataValue dimensions_of(const Node& node) {
  return of_value(Variant::array(std::vector<std::uint32_t>(static_cast<std::size_t>(std::max(0, node.value_rank)))));
}

constexpr unsigned bit(NodeClass node_class) { return static_cast<unsigned>(node_class); }
constexpr unsigned object = bit(NodeClass::Object), variable = bit(NodeClass::Variable),
                   method = bit(NodeClass::Method), object_type = bit(NodeClass::ObjectType),
                   variable_type = bit(NodeClass::VariableType), reference_type = bit(NodeClass::ReferenceType),
                   data_type = bit(NodeClass::DataType), any = 0xFF;

struct Attribute {
  AttributeId id;
  unsigned classes;
  DataValue (*get)(const Node& node, const ReadContext& context);
};

/// OPC 10000-3, 5: which class has what.
constexpr Attribute attributes[] = {
    {AttributeId::NodeId, any, [](const Node& node, const ReadContext&) { return of_value(node.id); }},
    {AttributeId::NodeClass, any,
     [](const Node& node, const ReadContext&) { return of_value(static_cast<std::int32_t>(node.node_class)); }},
    {AttributeId::BrowseName, any, [](const Node& node, const ReadContext&) { return of_value(node.browse_name); }},
    {AttributeId::DisplayName, any, [](const Node& node, const ReadContext&) { return of_value(node.display_name); }},
    {AttributeId::WriteMask, any, [](const Node&, const ReadContext&) { return of_value(std::uint32_t{0}); }},
    {AttributeId::UserWriteMask, any, [](const Node&, const ReadContext&) { return of_value(std::uint32_t{0}); }},
    {AttributeId::IsAbstract, object_type | variable_type | reference_type | data_type,
     [](const Node& node, const ReadContext&) { return of_value(node.is_abstract); }},
    {AttributeId::Symmetric, reference_type,
     [](const Node& node, const ReadContext&) { return of_value(node.is_symmetric); }},
    {AttributeId::InverseName, reference_type,
     [](const Node& node, const ReadContext&) { return of_value(node.inverse_name); }},
    {AttributeId::EventNotifier, object,
     [](const Node& node, const ReadContext&) { return of_value(node.event_notifier); }},
    {AttributeId::Value, variable, value_of},
    {AttributeId::DataType, variable | variable_type,
     [](const Node& node, const ReadContext&) { return of_value(node.data_type); }},
    {AttributeId::ValueRank, variable | variable_type,
     [](const Node& node, const ReadContext&) { return of_value(node.value_rank); }},
    {AttributeId::ArrayDimensions, variable | variable_type,
     [](const Node& node, const ReadContext&) { return dimensions_of(node); }},
    {AttributeId::AccessLevel, variable, [](const Node&, const ReadContext&) { return of_value(std::uint8_t{1}); }},
    {AttributeId::UserAccessLevel, variable, [](const Node&, const ReadContext&) { return of_value(std::uint8_t{1}); }},
    {AttributeId::MinimumSamplingInterval, variable,
     [](const Node& node, const ReadContext&) { return of_value(node.computed ? 100.0 : 0.0); }},
    {AttributeId::Historizing, variable, [](const Node&, const ReadContext&) { return of_value(false); }},
    {AttributeId::Executable, method, [](const Node& node, const ReadContext&) { return of_value(node.executable); }},
    {AttributeId::UserExecutable, method,
     [](const Node& node, const ReadContext&) { return of_value(node.executable); }},
    {AttributeId::DataTypeDefinition, data_type,
     [](const Node& node, const ReadContext&) { return of_value(node.definition); }},
    {AttributeId::AccessLevelEx, variable, [](const Node&, const ReadContext&) { return of_value(std::uint32_t{1}); }},
};

/// Attributes that a node of the class may have, and this one has not.
bool is_absent(const Node& node, AttributeId attribute) {
  switch (attribute) {
    case AttributeId::InverseName:
      return node.is_symmetric;
    case AttributeId::ArrayDimensions:
      return node.value_rank < 1;
    case AttributeId::DataTypeDefinition:
      return node.definition.type.is_null();
    default:
      return false;
  }
}

}  // namespace

Node make_node(NodeId id, NodeClass node_class, std::uint16_t name_space, std::string_view name) {
  Node node;
  node.id = std::move(id);
  node.node_class = node_class;
  node.browse_name = {name_space, Text(name)};
  node.display_name = LocalizedText(name);
  return node;
}

AddressSpace::AddressSpace() {
  for (const StandardNode& each : standard_nodes()) add(standard_node(each));
  for (const StandardReference& each : standard_references()) refer(NodeId(each.from), each.type, NodeId(each.to));
  const std::span<const StandardField> fields = standard_fields();
  for (std::size_t begin = 0, end = 0; begin < fields.size(); begin = end) {
    while (end < fields.size() && fields[end].of == fields[begin].of) ++end;
    find(NodeId(fields[begin].of))->definition = definition_of(fields.subspan(begin, end - begin));
  }
  std::map<std::uint32_t, std::vector<LocalizedText>> texts;
  for (const StandardText& each : standard_texts()) texts[each.of].emplace_back(each.text);
  for (const auto& [of, array] : texts) find(NodeId(of))->value.value = Variant::array(array);
}

Node& AddressSpace::add(Node node) {
  const auto [at, is_new] = nodes_.try_emplace(node.id, std::move(node));
  TAKT_CHECK(is_new, "a node is added once");
  return at->second;
}

void AddressSpace::refer(const NodeId& from, std::uint32_t type, const NodeId& to) {
  Node* const source = find(from);
  Node* const target = find(to);
  TAKT_CHECK(source != nullptr && target != nullptr, "both ends of a reference are there");
  source->references.push_back({NodeId(type), to, true});
  target->references.push_back({NodeId(type), from, false});
}

Node& AddressSpace::add_below(const NodeId& parent, std::uint32_t reference, Node node, std::uint32_t type) {
  Node& added = add(std::move(node));
  refer(parent, reference, added.id);
  if (type != 0) refer(added.id, ids::has_type_definition, NodeId(type));
  return added;
}

const Node* AddressSpace::find(const NodeId& id) const {
  const auto found = nodes_.find(id);
  return found == nodes_.end() ? nullptr : &found->second;
}
Node* AddressSpace::find(const NodeId& id) {
  const auto found = nodes_.find(id);
  return found == nodes_.end() ? nullptr : &found->second;
}

void AddressSpace::set_value(const NodeId& id, Variant value, DateTime source_time, StatusCode status) {
  Node* const node = find(id);
  TAKT_CHECK(node != nullptr, "values are set of nodes that are there");
  const bool is_same = node->value.value == value && node->value.result() == status;
  node->value.value = std::move(value);
  node->value.status = status;
  node->value.source_time = source_time;
  if (!is_same && listener_) listener_(*node, AttributeId::Value);
}

void AddressSpace::set_executable(const NodeId& id, bool executable) {
  Node* const node = find(id);
  TAKT_CHECK(node != nullptr, "methods that are there are executable or not");
  if (node->executable == executable) return;
  node->executable = executable;
  if (!listener_) return;
  listener_(*node, AttributeId::Executable);
  listener_(*node, AttributeId::UserExecutable);
}

bool AddressSpace::is_subtype(const NodeId& type, const NodeId& base) const {
  NodeId at = type;
  for (int depth = 0; depth < 32; ++depth) {
    if (at == base) return true;
    const Node* const node = find(at);
    if (node == nullptr) return false;
    const auto up = std::find_if(node->references.begin(), node->references.end(), [](const Reference& each) {
      return !each.is_forward && each.type == NodeId(ids::has_subtype);
    });
    if (up == node->references.end()) return false;
    at = up->target;
  }
  return false;
}

const Node* AddressSpace::target(const Node& from, std::uint32_t type) const {
  const auto found = std::find_if(from.references.begin(), from.references.end(),
                                  [&](const Reference& each) { return each.is_forward && each.type == NodeId(type); });
  return found == from.references.end() ? nullptr : find(found->target);
}

DataValue attribute_of(const Node& node, AttributeId attribute, const ReadContext& context) {
  const auto found = std::find_if(std::begin(attributes), std::end(attributes),
                                  [&](const Attribute& each) { return each.id == attribute; });
  if (found == std::end(attributes) || (found->classes & bit(node.node_class)) == 0 || is_absent(node, attribute)) {
    DataValue none;
    none.status = StatusCode::BadAttributeIdInvalid;
    return none;
  }
  return found->get(node, context);
}

}  // namespace takt::opcua
