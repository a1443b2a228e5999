// SPDX-License-Identifier: Apache-2.0
// The reference of a kind of file for people, from its JSON Schema: so it cannot say other things than the loader does.
#pragma once

#include <string>
#include <string_view>

#include "json/node.hpp"

namespace takt::json {

/// Markdown: the keys of the file, then a section for each kind of object in it, with a row for each key: what may
/// stand there with unit and range, what holds without it, what it means. `schema` is that of schema_tree(); `opening`
/// is the text below the title, with how to renew the page.
std::string reference(const Node& schema, std::string_view opening);
/// `text` as the cell of a table in Markdown.
std::string in_cell(std::string_view text);

}  // namespace takt::json
