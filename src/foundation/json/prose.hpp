// SPDX-License-Identifier: Apache-2.0
// A field of free text: unlike a name it may have line feeds and tabs.
#pragma once

#include <optional>
#include <string>
#include <type_traits>

#include "json/fields.hpp"

namespace takt::json {

void decode_prose(const Node& node, std::string& value, Reader& reader);

/// As that of an optional string, but for what it decodes.
inline constexpr Codec optional_prose_codec = [] {
  Codec codec = CodecOf<std::optional<std::string>>::codec;
  codec.decode = [](const Node& node, void* value, const Bounds&, Reader& reader) {
    decode_prose(node, static_cast<std::optional<std::string>*>(value)->emplace(), reader);
  };
  return codec;
}();

/// The field of an optional string (see fields.hpp) as free text.
template <auto Member>
requires std::is_same_v<typename detail::MemberOf<Member>::Type, std::optional<std::string>>
constexpr Field optional_prose(std::string_view name, std::string_view help) {
  Field field = optional<Member>(name, help);
  field.codec = &optional_prose_codec;
  return field;
}

}  // namespace takt::json
