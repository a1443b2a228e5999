// SPDX-License-Identifier: Apache-2.0
#include "opcua/encoding/encoder.hpp"

namespace takt::opcua {
namespace {

template <class Bounded>
void put_with_length(Encoder& to, const Bounded& value, Octets octets) {
  to.put(value.is_null() ? std::int32_t{-1} : static_cast<std::int32_t>(octets.size()));
  to.put_octets(octets);
}

/// `flags` go into the octet of the form: NamespaceUri and ServerIndex of an ExpandedNodeId.
void put_node_id(Encoder& to, const NodeId& id, unsigned flags) {
  const auto form = [&](unsigned number) { to.put(static_cast<std::uint8_t>(number | flags)); };
  if (const auto* const number = std::get_if<std::uint32_t>(&id.id)) {
    if (id.name_space == 0 && *number <= 0xFF) {
      form(0);
      to.put(static_cast<std::uint8_t>(*number));
    } else if (id.name_space <= 0xFF && *number <= 0xFFFF) {
      form(1);
      to.put(static_cast<std::uint8_t>(id.name_space));
      to.put(static_cast<std::uint16_t>(*number));
    } else {
      form(2);
      to.put(id.name_space);
      to.put(*number);
    }
    return;
  }
  form(2 + static_cast<unsigned>(id.id.index()));
  to.put(id.name_space);
  if (const auto* const text = std::get_if<Text>(&id.id)) encode(to, *text);
  if (const auto* const guid = std::get_if<Guid>(&id.id)) encode(to, *guid);
  if (const auto* const octets = std::get_if<Bytes>(&id.id)) encode(to, *octets);
}

void put_scalar(Encoder& to, const Scalar& value) {
  std::visit(
      [&](const auto& each) {
        using T = std::decay_t<decltype(each)>;
        if constexpr (std::is_same_v<T, std::monostate>) {
        } else if constexpr (std::is_same_v<T, Boxed<DataValue>>) {
          encode(to, each.value ? *each.value : DataValue());
        } else if constexpr (std::is_same_v<T, Boxed<Variant>>) {
          encode(to, each.value ? *each.value : Variant());
        } else {
          encode(to, each);
        }
      },
      value);
}

}  // namespace

void encode(Encoder& to, const Text& text) {
  put_with_length(to, text, std::as_bytes(std::span(text.value.data(), text.value.size())));
}
void encode(Encoder& to, const Bytes& octets) { put_with_length(to, octets, octets.value); }
void encode(Encoder& to, const Guid& guid) { to.put_octets(guid.value.octets); }
void encode(Encoder& to, const XmlElement& xml) { encode(to, xml.octets); }
void encode(Encoder& to, const NodeId& id) { put_node_id(to, id, 0); }

void encode(Encoder& to, const ExpandedNodeId& id) {
  put_node_id(to, id.id, (id.namespace_uri.empty() ? 0U : 0x80U) | (id.server_index == 0 ? 0U : 0x40U));
  if (!id.namespace_uri.empty()) encode(to, id.namespace_uri);
  if (id.server_index != 0) to.put(id.server_index);
}

void encode(Encoder& to, const QualifiedName& name) {
  to.put(name.name_space);
  encode(to, name.name);
}

void encode(Encoder& to, const LocalizedText& text) {
  to.put(static_cast<std::uint8_t>((text.locale.is_null() ? 0U : 1U) | (text.text.is_null() ? 0U : 2U)));
  if (!text.locale.is_null()) encode(to, text.locale);
  if (!text.text.is_null()) encode(to, text.text);
}

void encode(Encoder& to, const DiagnosticInfo&) { to.put(std::uint8_t{0}); }

void encode(Encoder& to, const ExtensionObject& object) {
  encode(to, object.type);
  to.put(object.form);
  if (object.form != 0) encode(to, object.body);
}

void encode(Encoder& to, const Variant& value) {
  to.put(static_cast<std::uint8_t>(uadp::index_of(value.type) | (value.is_array ? 0x80U : 0U) |
                                   (value.dimensions.empty() ? 0U : 0x40U)));
  if (value.is_array) to.put(value.is_null_array ? std::int32_t{-1} : static_cast<std::int32_t>(value.values.size()));
  for (const Scalar& each : value.values) put_scalar(to, each);
  if (value.dimensions.empty()) return;
  to.put(static_cast<std::int32_t>(value.dimensions.size()));
  for (const std::int32_t each : value.dimensions) to.put(each);
}

void encode(Encoder& to, const DataValue& value) {
  unsigned mask = 0;
  const bool has[] = {value.value.has_value(),
                      value.status.has_value(),
                      value.source_time.has_value(),
                      value.server_time.has_value(),
                      value.source_picoseconds.has_value(),
                      value.server_picoseconds.has_value()};
  for (std::size_t i = 0; i < std::size(has); ++i) mask |= (has[i] ? 1U : 0U) << i;
  to.put(static_cast<std::uint8_t>(mask));
  if (value.value) encode(to, *value.value);
  if (value.status) encode(to, *value.status);
  if (value.source_time) encode(to, *value.source_time);
  if (value.source_picoseconds) to.put(*value.source_picoseconds);
  if (value.server_time) encode(to, *value.server_time);
  if (value.server_picoseconds) to.put(*value.server_picoseconds);
}

}  // namespace takt::opcua
