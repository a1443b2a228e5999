// SPDX-License-Identifier: Apache-2.0
#include "json/any.hpp"

namespace takt::json {
namespace {

void decode_any(const Node& node, Any& value, Reader& reader) {
  value.node = node;
  value.where = reader.source(node);
}
Node encode_any(const Any& value) { return value.node; }
Node schema_any(SchemaBuilder&) { return Node::object(); }

}  // namespace

const Custom& describe(Type<Any>) {
  static constexpr Custom table = custom<Any, decode_any, encode_any, schema_any>();
  return table;
}

}  // namespace takt::json
