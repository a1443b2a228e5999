// SPDX-License-Identifier: Apache-2.0
// One value of a document replaced from the command line: --set network.links.0.rate=100Mbps
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "json/diagnostics.hpp"
#include "json/document.hpp"

namespace takt::json {

/// Applies "pointer=value" to a document.
///
/// The pointer is RFC 6901 ("/network/links/0/rate"; needed for names that contain a dot) or dotted
/// ("network.links.0.rate"). The value is JSON if it reads as JSON, otherwise it is a string as it stands. Members that
/// are missing are made, as objects, down to the last one; an item of an array must exist or be the next one.
/// The new value's position is in a source of its own, named "--set pointer=value".
///
/// False, a diagnostic that names the option, and an unchanged document, if that cannot be done.
bool apply(Document& document, std::string_view option, Diagnostics& diagnostics);

/// A value that a program puts into a document.
struct Replacement {
  std::string pointer;  ///< RFC 6901 or dotted, as above; the last step "-" appends to an array
  Node value;
  std::string origin;  ///< names the source of the value in diagnostics, "slaves = 3", if it is not written anywhere:
  Place place = {};    ///< where it is written, which diagnostics name instead
};

/// Applies all of them in their order, with one copy of the document. False, diagnostics and an unchanged document, if
/// one of them cannot be done.
bool replace(Document& document, std::span<const Replacement> replacements, Diagnostics& diagnostics);

}  // namespace takt::json
