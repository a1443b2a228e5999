// SPDX-License-Identifier: Apache-2.0
// Identifiers and names (OPC 10000-6, 5.2.2.9 to 5.2.2.14).
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <variant>

#include "opcua/encoding/text.hpp"
#include "uadp/builtin_type.hpp"

namespace takt::opcua {

using uadp::BuiltInType;
using uadp::DateTime;

struct Guid {
  uadp::Guid value;
  friend bool operator==(const Guid&, const Guid&) = default;
  friend auto operator<=>(const Guid& a, const Guid& b) { return a.value.octets <=> b.value.octets; }
};

struct NodeId {
  std::uint16_t name_space = 0;
  std::variant<std::uint32_t, Text, Guid, Bytes> id = std::uint32_t{0};

  NodeId() = default;
  /// In namespace 0.
  NodeId(std::uint32_t number) : id(number) {}  // NOLINT: standard nodes are numbers
  NodeId(std::uint16_t in, std::uint32_t number) : name_space(in), id(number) {}
  NodeId(std::uint16_t in, std::string_view text) : name_space(in), id(Text(text)) {}

  bool is_null() const { return *this == NodeId(); }
  /// The number in namespace 0; 0 for any other.
  std::uint32_t standard() const { return name_space == 0 && id.index() == 0 ? std::get<std::uint32_t>(id) : 0; }
  bool operator==(const NodeId&) const = default;
  auto operator<=>(const NodeId&) const = default;
};

/// As in "ns=1;s=cell"; octets and GUIDs in hexadecimal.
std::string to_text(const NodeId& id);

/// Only identifiers in this server are written: without NamespaceUri and ServerIndex.
struct ExpandedNodeId {
  NodeId id;
  Text namespace_uri;
  std::uint32_t server_index = 0;

  ExpandedNodeId() = default;
  ExpandedNodeId(NodeId of) : id(std::move(of)) {}  // NOLINT
  bool operator==(const ExpandedNodeId&) const = default;
};

struct QualifiedName {
  std::uint16_t name_space = 0;
  Text name;
  bool operator==(const QualifiedName&) const = default;
};

struct LocalizedText {
  Text locale;
  Text text;
  LocalizedText() = default;
  LocalizedText(std::string_view plain) : text(plain) {}  // NOLINT: a text without a language
  LocalizedText(std::string_view of, std::string_view plain) : locale(of), text(plain) {}
  bool operator==(const LocalizedText&) const = default;
};

/// Read over, and never written but as "nothing".
struct DiagnosticInfo {
  bool operator==(const DiagnosticInfo&) const = default;
};

/// A structure as it stands in a stream: with the NodeId of its encoding, so that who does not know it can step over
/// it.
struct ExtensionObject {
  NodeId type;            ///< of the encoding; null: nothing
  std::uint8_t form = 0;  ///< 0 no body, 1 octets, 2 XML
  Bytes body;
  bool operator==(const ExtensionObject&) const = default;
};

}  // namespace takt::opcua
