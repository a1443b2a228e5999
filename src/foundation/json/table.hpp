// SPDX-License-Identifier: Apache-2.0
// The tables that describe how C++ types look in JSON, without their types: plain data and function pointers.
//
// Decoding, encoding and the schema walk these same tables. They are made by the typed builders of fields.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "json/node.hpp"
#include "json/quantity.hpp"
#include "json/reader.hpp"

namespace takt::json {

class SchemaBuilder;

/// The limits of a field, as far as its type has any.
struct Bounds {
  bool has_min = false;
  bool has_max = false;
  bool above_min = false;  ///< min itself is excluded
  sim::int128 min = 0;     ///< integers and quantities
  sim::int128 max = 0;
  double min_real = 0;  ///< doubles
  double max_real = 0;
  std::size_t min_length = 0;  ///< strings, in octets
  std::size_t max_length = std::numeric_limits<std::size_t>::max();
  std::size_t min_items = 0;  ///< arrays and maps
  std::size_t max_items = std::numeric_limits<std::size_t>::max();
  bool unique_items = false;
};

/// How one C++ type is read, written and described. `value` points to an object of that type.
struct Codec {
  void (*decode)(const Node& node, void* value, const Bounds& bounds, Reader& reader);
  Node (*encode)(const void* value);
  Node (*schema)(const Bounds& bounds, SchemaBuilder& builder);
  bool (*is_absent)(const void* value) = nullptr;  ///< the member is left out when it is written; null: never
};

/// One member of a JSON object.
struct Field {
  std::string_view name;
  std::string_view help;  ///< a sentence for the schema and the manual
  bool is_required = false;
  Bounds bounds;
  const Codec* codec = nullptr;
  void* (*member)(void* object) = nullptr;
};

/// A rule about which of some optional fields may stand together.
struct Group {
  enum class Rule : std::uint8_t { exactly_one, at_most_one, at_least_one };
  Rule rule;
  std::span<const std::string_view> names;
};

/// A struct that is a JSON object.
struct Object {
  std::string_view name;  ///< of the definition in the schema; unique among all that one schema reaches
  std::string_view help;
  std::span<const Field> fields;
  std::span<const Group> groups;
  std::string_view
      shorthand;  ///< a value that is no object stands for an object with only this field (not at the root)
  Source* (*where)(void* object);  ///< the member that keeps where it was read; may be null
  void (*with_prototype)(void (*use)(const void* object, void* context), void* context);  ///< calls with all defaults
};

struct EnumName {
  std::int64_t value;
  std::string_view name;
  std::string_view help;
};

/// An enum that is a string.
struct Enumeration {
  std::string_view what;  ///< "an operating system"
  std::span<const EnumName> names;
  std::int64_t (*get)(const void* value);
  void (*set)(void* value, std::int64_t number);
};

struct Option {
  std::string_view tag;
  const Object& (*object)();
  void* (*emplace)(void* variant);
};

/// A std::variant of structs that is a JSON object, one of whose members says which.
struct Tagged {
  std::string_view name;
  std::string_view help;
  std::string_view key;             ///< the member that says which, such as "kind"
  std::span<const Option> options;  ///< by index of the variant
  std::size_t (*index)(const void* variant);
  const void* (*get)(const void* variant);
};

/// A type with its own reading, writing and schema.
struct Custom {
  void (*decode)(const Node& node, void* value, Reader& reader);
  Node (*encode)(const void* value);
  Node (*schema)(SchemaBuilder& builder);
};

/// A std::vector, without its type.
struct Sequence {
  const Codec* item;
  void* (*append)(void* vector);
  std::size_t (*size)(const void* vector);
  const void* (*at)(const void* vector, std::size_t index);
  void (*clear)(void* vector);
};

/// A vector of pairs name -> value, without its type.
struct Mapping {
  const Codec* value;
  void* (*append)(void* map, const std::string& name);
  std::size_t (*size)(const void* map);
  const std::string& (*name_at)(const void* map, std::size_t index);
  const void* (*value_at)(const void* map, std::size_t index);
  void (*clear)(void* map);
};

/// Collects the definitions of a schema.
class SchemaBuilder {
 public:
  /// {"$ref": "#/definitions/NAME"}; the definition is made at the first call.
  Node reference(const Object& object);
  Node reference(const Tagged& tagged);
  Node release_definitions() { return std::move(definitions_); }

 private:
  bool define(std::string_view name, const void* table);
  void set(std::string_view name, Node schema);

  Node definitions_ = Node::object();
  std::vector<const void*> tables_;  ///< of the definitions, in their order
};

// Reading (decode.cpp). A value that is wrong is reported and left as it was.
void decode_bool(const Node& node, bool& value, Reader& reader);
void decode_string(const Node& node, std::string& value, const Bounds& bounds, Reader& reader);
void decode_double(const Node& node, double& value, const Bounds& bounds, Reader& reader);
/// False if there is no integer within the bounds, which must have min and max.
bool decode_integer(const Node& node, sim::int128& value, const Bounds& bounds, Reader& reader);
bool decode_quantity(const Node& node, sim::int128& value, const Dimension& dimension, const Bounds& bounds,
                     Reader& reader);
void decode_sequence(const Node& node, void* value, const Sequence& sequence, const Bounds& bounds, Reader& reader);
void decode_mapping(const Node& node, void* value, const Mapping& mapping, const Bounds& bounds, Reader& reader);
void decode_by(const Object& table, const Node& node, void* value, Reader& reader);
void decode_by(const Enumeration& table, const Node& node, void* value, Reader& reader);
void decode_by(const Tagged& table, const Node& node, void* value, Reader& reader);
void decode_by(const Custom& table, const Node& node, void* value, Reader& reader);

// Writing (encode.cpp).
Node encode_sequence(const void* value, const Sequence& sequence);
Node encode_mapping(const void* value, const Mapping& mapping);
Node encode_quantity(sim::int128 value, const Dimension& dimension);
Node encode_by(const Object& table, const void* value);
Node encode_by(const Enumeration& table, const void* value);
Node encode_by(const Tagged& table, const void* value);
Node encode_by(const Custom& table, const void* value);

// Describing (schema.cpp).
Node bool_schema();
Node string_schema(const Bounds& bounds);
Node double_schema(const Bounds& bounds);
Node integer_schema(const Bounds& bounds);
Node quantity_schema(const Dimension& dimension, const Bounds& bounds);
Node quantity_or_auto_schema(const Dimension& dimension, const Bounds& bounds);
Node sequence_schema(const Codec& item, const Bounds& bounds, SchemaBuilder& builder);
Node mapping_schema(const Codec& value, const Bounds& bounds, SchemaBuilder& builder);
Node schema_by(const Object& table, SchemaBuilder& builder);
Node schema_by(const Enumeration& table, SchemaBuilder& builder);
Node schema_by(const Tagged& table, SchemaBuilder& builder);
Node schema_by(const Custom& table, SchemaBuilder& builder);
Node root_schema(const Object& table, std::string_view title);

/// "from 1us to 10s", "of at least 1us", "" ...: the range of a number or quantity in words.
std::string range_text(const Dimension* dimension, const Bounds& bounds);
/// The range of a double in words.
std::string range_text_of_double(const Bounds& bounds);
/// `"a", "b" or "c"`
std::string list_text(std::span<const std::string_view> names);

/// CHECKs that a table makes sense: names are unique, groups and shorthand name fields of it. Not recursive.
void check_table(const Object& table);

}  // namespace takt::json
