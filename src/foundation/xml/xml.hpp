// SPDX-License-Identifier: Apache-2.0
// XML as a tree with places, bounded: read by expat, without document types, so that nothing expands.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "json/diagnostics.hpp"

namespace takt {

struct XmlAttribute {
  std::string name_space;  ///< empty without a prefix
  std::string name;
  std::string value;
};

struct XmlElement {
  std::string name_space;
  std::string name;
  json::Place place;
  std::string text;  ///< all character data of it, white space at both ends taken off
  std::vector<XmlAttribute> attributes;
  std::vector<XmlElement> children;
  /// Namespaces by prefix that are declared at it; "" is the default.
  std::vector<std::pair<std::string, std::string>> declared;
  const XmlAttribute* attribute(std::string_view which) const;
};

inline constexpr std::size_t max_xml_depth = 64;
inline constexpr std::size_t max_xml_elements = std::size_t{1} << 20;

/// The elements at the top: one, or several as instance data of NETCONF has them. A text that is not XML, has a
/// document type, or exceeds a limit is one diagnostic.
std::optional<std::vector<XmlElement>> parse_xml(std::string_view text, const std::string& file,
                                                 json::Diagnostics& diagnostics);

/// The text with &, <, > and " as entities: for character data and for values of attributes in double quotes.
std::string xml_escaped(std::string_view text);

}  // namespace takt
