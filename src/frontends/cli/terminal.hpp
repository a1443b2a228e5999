// SPDX-License-Identifier: Apache-2.0
// What is printed, and how a terminal shows it: its width, and colour where it helps. Pages are plain text; colour
// comes at the very end, so that no report knows of it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "json/diagnostics.hpp"

namespace takt::cli {

/// Columns of the terminal that standard output is, at least 80; 0 (as many as it takes) if it is none.
std::size_t page_width();

/// The page with verdicts coloured: words such as "pass" and "FAIL" that begin a line, and the verdict of the last
/// line. Other text is left as it is.
std::string with_colour(std::string_view page);

/// The page with lines that are longer than `width` (0: none is) broken between words; what follows stands below the
/// column in which the line's last part begins.
std::string folded(std::string_view page, std::size_t width);

/// Prints a page for people on standard output, folded to the width of a terminal, in colour if a terminal looks and
/// NO_COLOR (https://no-color.org) is not set.
void print(const std::string& page);

/// Says on standard error, behind the page, what was written: what WrittenFiles says of a folder, and a page with
/// pictures; each may be empty.
void print_files(const std::string& summary, const std::string& report);

/// Prints diagnostics on standard error, with the same rules.
void tell(const json::Diagnostics& diagnostics);

}  // namespace takt::cli
