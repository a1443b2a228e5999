// SPDX-License-Identifier: Apache-2.0
// Names and texts of others on their way out: into a line of a terminal, a log or a comment, a cell of CSV, the name of
// a file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace takt::json {

/// Where a text has its first character that acts instead of being shown: a control character (C0, DEL, C1), a line or
/// paragraph separator, or one that turns the direction of writing. npos if it has none.
std::size_t find_control(std::string_view text);

/// The text in one line that shows all it is made of: control characters as \u001b, octets that are no UTF-8 as \xff.
/// For terminals, logs and comments (of scripts, ini, NED), which end where a line ends.
std::string printable(std::string_view text);

/// The same of a page, whose line feeds and tabs stay.
std::string printable_page(std::string_view page);

/// A field of comma-separated values (RFC 4180), in quotes where it must be.
std::string csv_field(std::string_view text);

/// A text as the name of one file: separators of paths, what file systems refuse, a leading dot and the percent sign
/// are written as %2F, by their octets. So two texts never become one name.
std::string file_name(std::string_view text);

/// A text as one word of a shell, in quotes where it must be.
std::string shell_word(std::string_view text);

}  // namespace takt::json
