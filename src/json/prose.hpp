// A field of free text: unlike a name it may have line feeds and tabs.
#pragma once

#include "json/codecs.hpp"

namespace takt::json {

void decode_prose(const Node& node, std::string& value, Reader& reader);

inline constexpr Codec prose_codec{[](const Node& node, void* value, const Bounds&, Reader& reader) {
                                     decode_prose(node, *static_cast<std::string*>(value), reader);
                                   },
                                   CodecOf<std::string>::codec.encode, CodecOf<std::string>::codec.schema};

/// A string field of a table (see fields.hpp) as free text.
constexpr Field prose(Field field) {
  field.codec = &prose_codec;
  return field;
}

}  // namespace takt::json
