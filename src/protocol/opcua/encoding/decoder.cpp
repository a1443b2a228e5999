// SPDX-License-Identifier: Apache-2.0
#include "opcua/encoding/decoder.hpp"

#include <algorithm>
#include <limits>

namespace takt::opcua {
namespace {

/// Reads the identifier of a form without its flags.
void get_node_id(Decoder& from, NodeId& id, unsigned form) {
  if (form == 0) {
    id = NodeId(from.get<std::uint8_t>());
    return;
  }
  id.name_space = form == 1 ? from.get<std::uint8_t>() : from.get<std::uint16_t>();
  switch (form) {
    case 1:
      id.id = std::uint32_t{from.get<std::uint16_t>()};
      return;
    case 2:
      id.id = from.get<std::uint32_t>();
      return;
    case 3:
      decode(from, id.id.emplace<Text>());
      return;
    case 4:
      decode(from, id.id.emplace<Guid>());
      return;
    case 5:
      decode(from, id.id.emplace<Bytes>());
      return;
    default:
      from.fail();
  }
}

template <std::size_t Index>
void get_scalar(Decoder& from, Scalar& value) {
  using T = std::variant_alternative_t<Index, Scalar>;
  if constexpr (std::is_same_v<T, std::monostate>) {
    from.fail();
  } else if constexpr (std::is_same_v<T, Boxed<DataValue>> || std::is_same_v<T, Boxed<Variant>>) {
    using Inner = std::conditional_t<std::is_same_v<T, Boxed<DataValue>>, DataValue, Variant>;
    Inner inner;
    decode(from, inner);
    value = T{std::make_shared<const Inner>(std::move(inner))};
  } else {
    decode(from, value.emplace<Index>());
  }
}

void get_scalar(Decoder& from, Scalar& value, BuiltInType type) {
  using Getter = void (*)(Decoder&, Scalar&);
  static constexpr auto getters = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::array<Getter, sizeof...(I)>{&get_scalar<I>...};
  }
  (std::make_index_sequence<std::variant_size_v<Scalar>>());
  getters[uadp::index_of(type)](from, value);
}

void get_diagnostic(Decoder& from) {
  const Decoder::Deeper deeper(from);
  const auto mask = from.get<std::uint8_t>();
  if ((mask & 0x80U) != 0) from.fail();
  // SymbolicId, NamespaceUri, Locale, LocalizedText: one index each.
  for (const unsigned bit : {0x01U, 0x02U, 0x08U, 0x04U})
    if ((mask & bit) != 0) from.get<std::int32_t>();
  Text additional;
  if ((mask & 0x10U) != 0) decode(from, additional);
  if ((mask & 0x20U) != 0) from.get<std::uint32_t>();
  if ((mask & 0x40U) != 0 && !from.failed()) get_diagnostic(from);
}

}  // namespace

Octets Decoder::read_with_length(bool& is_null) {
  const auto length = reader_.get<std::int32_t>();
  is_null = length < 0;
  if (length < -1) fail();
  if (length <= 0) return {};
  if (static_cast<std::size_t>(length) > reader_.left()) {
    fail();
    return {};
  }
  if (static_cast<std::size_t>(length) > limits_.text_octets) {
    fail(StatusCode::BadEncodingLimitsExceeded);
    return {};
  }
  return reader_.take(static_cast<std::size_t>(length));
}

std::optional<std::size_t> Decoder::count() {
  const auto count = reader_.get<std::int32_t>();
  if (count == -1 || failed()) return std::nullopt;
  const auto elements = static_cast<std::size_t>(count);
  if (count < 0 || elements > reader_.left()) {
    fail();
    return std::nullopt;
  }
  if (elements > limits_.array_elements || elements > budget_) {
    fail(StatusCode::BadEncodingLimitsExceeded);
    return std::nullopt;
  }
  budget_ -= elements;
  return elements;
}

void decode(Decoder& from, Text& text) {
  bool is_null = false;
  const Octets octets = from.read_with_length(is_null);
  text.value.assign(reinterpret_cast<const char*>(octets.data()), octets.size());
  text.is_empty_not_null = !is_null;
}

void decode(Decoder& from, Bytes& octets) {
  bool is_null = false;
  const Octets taken = from.read_with_length(is_null);
  octets.value.assign(taken.begin(), taken.end());
  octets.is_empty_not_null = !is_null;
}

void decode(Decoder& from, Guid& guid) {
  const Octets octets = from.take(guid.value.octets.size());
  std::copy(octets.begin(), octets.end(), guid.value.octets.begin());
}

void decode(Decoder& from, XmlElement& xml) { decode(from, xml.octets); }
void decode(Decoder& from, NodeId& id) { get_node_id(from, id, from.get<std::uint8_t>()); }

void decode(Decoder& from, ExpandedNodeId& id) {
  const auto form = from.get<std::uint8_t>();
  get_node_id(from, id.id, form & 0x3FU);
  if ((form & 0x80U) != 0) decode(from, id.namespace_uri);
  if ((form & 0x40U) != 0) id.server_index = from.get<std::uint32_t>();
}

void decode(Decoder& from, QualifiedName& name) {
  name.name_space = from.get<std::uint16_t>();
  decode(from, name.name);
}

void decode(Decoder& from, LocalizedText& text) {
  const auto mask = from.get<std::uint8_t>();
  if ((mask & ~0x03U) != 0) from.fail();
  if ((mask & 0x01U) != 0) decode(from, text.locale);
  if ((mask & 0x02U) != 0) decode(from, text.text);
}

void decode(Decoder& from, DiagnosticInfo&) { get_diagnostic(from); }

void decode(Decoder& from, ExtensionObject& object) {
  decode(from, object.type);
  object.form = from.get<std::uint8_t>();
  if (object.form > 2) from.fail();
  if (object.form != 0) decode(from, object.body);
}

void decode(Decoder& from, Variant& value) {
  const Decoder::Deeper deeper(from);
  const auto octet = from.get<std::uint8_t>();
  const unsigned id = octet & 0x3FU;
  const bool has_dimensions = (octet & 0x40U) != 0;
  value.is_array = (octet & 0x80U) != 0;
  // 26 to 31 are kept for later and are read as ByteStrings; there are no others, no matrix that is no array, and no
  // single value in a value.
  if (id > 31 || (has_dimensions && !value.is_array)) return from.fail();
  value.type = id > 25 ? BuiltInType::ByteString : static_cast<BuiltInType>(id);
  if (value.type == BuiltInType::Null) return value.is_array ? from.fail() : void();
  if (value.type == BuiltInType::Variant && !value.is_array) return from.fail();
  std::size_t count = 1;
  if (value.is_array) {
    const auto elements = from.count();
    value.is_null_array = !elements;
    count = elements.value_or(0);
  }
  for (std::size_t i = 0; i < count && !from.failed(); ++i) get_scalar(from, value.values.emplace_back(), value.type);
  if (!has_dimensions) return;
  const auto dimensions = from.count();
  std::int64_t product = 1;
  for (std::size_t i = 0; i < dimensions.value_or(0); ++i) {
    const auto length = from.get<std::int32_t>();
    if (length < 0) return from.fail();
    product = std::min<std::int64_t>(product * length, std::numeric_limits<std::int32_t>::max());
    value.dimensions.push_back(length);
  }
  if (product != static_cast<std::int64_t>(count)) from.fail();
}

void decode(Decoder& from, DataValue& value) {
  const Decoder::Deeper deeper(from);
  const auto mask = from.get<std::uint8_t>();
  if ((mask & 0xC0U) != 0) from.fail();
  if ((mask & 0x01U) != 0 && !from.failed()) decode(from, value.value.emplace());
  if ((mask & 0x02U) != 0) decode(from, value.status.emplace());
  if ((mask & 0x04U) != 0) decode(from, value.source_time.emplace());
  if ((mask & 0x10U) != 0) value.source_picoseconds = from.get<std::uint16_t>();
  if ((mask & 0x08U) != 0) decode(from, value.server_time.emplace());
  if ((mask & 0x20U) != 0) value.server_picoseconds = from.get<std::uint16_t>();
}

std::optional<double> number_in(const Variant& value) {
  if (value.is_array || value.values.empty()) return std::nullopt;
  return std::visit(
      [](const auto& each) -> std::optional<double> {
        using T = std::decay_t<decltype(each)>;
        if constexpr (std::is_arithmetic_v<T>)
          return static_cast<double>(each);
        else
          return std::nullopt;
      },
      value.values.front());
}

namespace {

struct OctetsOfScalar {
  std::size_t operator()(const Text& text) const { return text.value.size(); }
  std::size_t operator()(const Bytes& octets) const { return octets.value.size(); }
  std::size_t operator()(const XmlElement& xml) const { return xml.octets.value.size(); }
  std::size_t operator()(const QualifiedName& name) const { return name.name.value.size(); }
  std::size_t operator()(const LocalizedText& text) const { return text.locale.value.size() + text.text.value.size(); }
  std::size_t operator()(const NodeId& id) const {
    const auto* const text = std::get_if<Text>(&id.id);
    const auto* const octets = std::get_if<Bytes>(&id.id);
    return text != nullptr ? text->value.size() : octets != nullptr ? octets->value.size() : 0;
  }
  std::size_t operator()(const ExpandedNodeId& id) const { return (*this)(id.id) + id.namespace_uri.value.size(); }
  std::size_t operator()(const ExtensionObject& object) const {
    return (*this)(object.type) + object.body.value.size();
  }
  std::size_t operator()(const Boxed<Variant>& boxed) const { return boxed.value ? octets_of(*boxed.value) : 0; }
  std::size_t operator()(const Boxed<DataValue>& boxed) const { return boxed.value ? octets_of(*boxed.value) : 0; }
  template <class Plain>
  std::size_t operator()(const Plain&) const {
    return 0;
  }
};

}  // namespace

std::size_t octets_of(const Variant& value) {
  std::size_t octets = sizeof(Variant) + value.dimensions.size() * sizeof(std::int32_t);
  for (const Scalar& each : value.values) octets += sizeof(Scalar) + std::visit(OctetsOfScalar(), each);
  return octets;
}

std::size_t octets_of(const DataValue& value) {
  return sizeof(DataValue) + (value.value ? octets_of(*value.value) - sizeof(Variant) : 0);
}

std::string to_text(const NodeId& id) {
  constexpr std::string_view digits = "0123456789abcdef";
  const auto hexadecimal = [&](Octets octets) {
    std::string text;
    for (const std::byte each : octets)
      text += {digits[static_cast<unsigned>(each) >> 4], digits[static_cast<unsigned>(each) & 15]};
    return text;
  };
  std::string text = id.name_space == 0 ? std::string() : "ns=" + std::to_string(id.name_space) + ";";
  if (const auto* const number = std::get_if<std::uint32_t>(&id.id)) return text + "i=" + std::to_string(*number);
  if (const auto* const name = std::get_if<Text>(&id.id)) return text + "s=" + name->value;
  if (const auto* const guid = std::get_if<Guid>(&id.id)) return text + "g=" + hexadecimal(guid->value.octets);
  return text + "b=" + hexadecimal(std::get<Bytes>(id.id).value);
}

}  // namespace takt::opcua
