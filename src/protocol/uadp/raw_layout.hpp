// SPDX-License-Identifier: Apache-2.0
// Where the fields of a DataSet stand when they are encoded as RawData (OPC 10000-14, 7.2.4.5.11): at fixed offsets.
#pragma once

#include <string>
#include <vector>

#include "uadp/variant.hpp"

namespace takt::uadp {

/// What the FieldMetaData says about the length of a field (OPC 10000-14, 6.2.3.2.4).
struct RawField {
  BuiltInType type = BuiltInType::Double;
  bool is_array = false;
  std::uint32_t array_length = 0;       ///< ArrayDimensions[0]: most elements of an array, all others are zeros
  std::uint32_t max_string_length = 0;  ///< octets; of String, ByteString and XmlElement
  bool operator==(const RawField&) const = default;
};

/// Fixed offsets of all fields. A value of set-up: it allocates when it is made, not when it is asked.
class RawLayout {
 public:
  RawLayout() = default;
  /// Every field must have a fixed length (`problem_of` says nothing).
  explicit RawLayout(std::vector<RawField> fields);

  /// Why a field has no fixed length; empty if it has one.
  static std::string problem_of(const RawField& field);

  std::size_t count() const { return fields_.size(); }
  const RawField& field(std::size_t index) const { return fields_[index]; }
  /// Octets from the begin of the body to the field.
  std::size_t offset(std::size_t index) const { return offsets_[index]; }
  /// Octets of the whole body.
  std::size_t size() const { return size_; }

  /// The field of a body; nothing if the body is too short or a length in it exceeds the layout's.
  std::optional<Variant> at(Octets body, std::size_t index) const;

  /// Writes a value that was encoded as a Variant; false, and zeros, if it is of another type or too long.
  bool put(Writer& writer, std::size_t index, const Variant& value) const;

 private:
  std::vector<RawField> fields_;
  std::vector<std::size_t> offsets_;
  std::size_t size_ = 0;
};

}  // namespace takt::uadp
