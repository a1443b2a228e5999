// SPDX-License-Identifier: Apache-2.0
// Names with characters that shells, pages, tables and files treat specially.
#pragma once

#include <set>
#include <string>

#include "tests/generator/draw.hpp"
#include "tests/generator/schema.hpp"

namespace takt::generator {

/// The names that the scenario gives to nodes, streams, Programs and all else that has a "name".
std::set<std::string> names_in(const Node& root);

/// Gives each of them another one, wherever it stands: alone, before the number of a port ("sw0:40") or as a part of a
/// path ("p0/state/h0"). A name keeps its old one within, so that all stay different.
void give_odd_names(Node& root, Draw& draw);

}  // namespace takt::generator
