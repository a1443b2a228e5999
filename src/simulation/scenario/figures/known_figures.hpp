// SPDX-License-Identifier: Apache-2.0
// What result.json can hold, so that a pointer to what no run has is found out before the run.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace takt::scenario {

enum class FigureKind : std::uint8_t {
  number,   ///< or a truth value
  counter,  ///< a number that result.json has only if it is not 0
  text,
  verdict,  ///< what the run's requirements come to: no figure for a requirement
};

/// A way through result.json. A step is a name, "[]" (an index), "<>" (any name), or "<stream>" and its like (a name of
/// the scenario).
struct KnownFigure {
  FigureKind kind;
  std::string pattern;
  std::vector<std::string> steps;  ///< of the pattern
  bool is_of_whole_run = false;    ///< counts from the start: no account of it is kept from a later instant on
};

/// Every value that is no object and no array: a walk over the tables of results (json/record.hpp) and of GraphFigures.
const std::vector<KnownFigure>& known_figures();

/// The known figures that a pointer can lead to ("*" stands for everything), and if there are none, why.
struct Lookup {
  std::vector<const KnownFigure*> figures;
  std::size_t wrong_step = 0;  ///< the first step that leads nowhere; all of them if it is no value that they lead to
  std::vector<std::string> expected = {};  ///< what could stand there: names, "<stream>", "an index"
};
Lookup look_up(const std::vector<std::string>& steps);

/// Whether one step of a pattern is the name of something of the scenario: "<stream>" is "stream"; else "".
std::string_view placeholder_of(std::string_view pattern_step);
/// The steps of a pattern or a pointer.
std::vector<std::string> steps_of(std::string_view pointer);

}  // namespace takt::scenario
