// SPDX-License-Identifier: Apache-2.0
#include "opcua/address_space/key_service_nodes.hpp"

namespace takt::opcua {
namespace {

// Nodes of the core nodeset that only these have to do with.
constexpr std::uint32_t pub_sub_key_service_type = 15906, publish_subscribe_type = 14416;

struct ArgumentText {
  std::string_view name;
  std::uint32_t data_type;
  std::int32_t rank = -1;
};
constexpr ArgumentText inputs[] = {
    {"SecurityGroupId", ids::string}, {"StartingTokenId", ids::integer_id}, {"RequestedKeyCount", ids::uint32}};
constexpr ArgumentText outputs[] = {{"SecurityPolicyUri", ids::string},
                                    {"FirstTokenId", ids::integer_id},
                                    {"Keys", ids::byte_string, 1},
                                    {"TimeToNextKey", ids::duration},
                                    {"KeyLifetime", ids::duration}};

void add_arguments(AddressSpace& space, const NodeId& method, std::uint32_t id, std::string_view name,
                   std::span<const ArgumentText> texts) {
  std::vector<ExtensionObject> arguments;
  for (const ArgumentText& each : texts)
    arguments.push_back(extension_of(Argument{Text(each.name),
                                              NodeId(each.data_type),
                                              each.rank,
                                              each.rank == 1 ? List<std::uint32_t>{0} : List<std::uint32_t>(),
                                              {}}));
  Node node = make_node(NodeId(id), NodeClass::Variable, 0, name);
  node.data_type = NodeId(ids::argument);
  node.value_rank = 1;
  node.value.value = Variant::array(arguments);
  space.add_below(method, ids::has_property, std::move(node), ids::property_type);
}

/// Its arguments have the ids behind its own, as in the nodeset.
void add_method(AddressSpace& space, const NodeId& parent, std::uint32_t id) {
  Node method = make_node(NodeId(id), NodeClass::Method, 0, "GetSecurityKeys");
  method.executable = true;
  space.add_below(parent, ids::has_component, std::move(method), 0);
  add_arguments(space, NodeId(id), id + 1, "InputArguments", inputs);
  add_arguments(space, NodeId(id), id + 2, "OutputArguments", outputs);
}

}  // namespace

void add_key_service(AddressSpace& space) {
  for (const std::uint32_t each : {ids::duration, ids::integer_id})
    if (space.find(NodeId(each)) == nullptr)
      space.add_below(NodeId(each == ids::duration ? ids::double_ : ids::uint32), ids::has_subtype,
                      make_node(NodeId(each), NodeClass::DataType, 0, each == ids::duration ? "Duration" : "IntegerId"),
                      0);
  space.add_below(NodeId(ids::base_object_type), ids::has_subtype,
                  make_node(NodeId(pub_sub_key_service_type), NodeClass::ObjectType, 0, "PubSubKeyServiceType"), 0);
  add_method(space, NodeId(pub_sub_key_service_type), ids::get_security_keys_of_type);
  space.add_below(NodeId(pub_sub_key_service_type), ids::has_subtype,
                  make_node(NodeId(publish_subscribe_type), NodeClass::ObjectType, 0, "PublishSubscribeType"), 0);
  space.add_below(NodeId(ids::server), ids::has_component,
                  make_node(NodeId(ids::publish_subscribe), NodeClass::Object, 0, "PublishSubscribe"),
                  publish_subscribe_type);
  add_method(space, NodeId(ids::publish_subscribe), ids::get_security_keys);
}

}  // namespace takt::opcua
