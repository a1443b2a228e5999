// SPDX-License-Identifier: Apache-2.0
#include "cli/places.hpp"

#include <cstdio>

#include "cli/terminal.hpp"
#include "output/writable.hpp"

namespace takt::cli {

bool can_write(const std::vector<Place>& places, bool is_json) {
  json::Diagnostics diagnostics;
  for (const Place& place : places) {
    if (place.path.empty()) continue;
    const bool is_folder =
        place.kind == Place::Kind::folder || (place.kind == Place::Kind::either && place.path.ends_with('/'));
    const std::string why = is_folder ? output::why_no_folder(place.path) : output::why_no_file(place.path);
    if (!why.empty())
      diagnostics.error({place.option, 0, 0, ""},
                        is_folder ? "no folder that can be written to" : "no file that can be written",
                        {why, is_folder ? "a folder that is there or can be made, and takes files"
                                        : "a file that can be written, in a folder that is there or can be made"});
  }
  if (!diagnostics.has_errors()) return true;
  if (is_json)
    std::fputs(json::pretty(diagnostics.to_json()).c_str(), stdout);
  else
    tell(diagnostics);
  return false;
}

}  // namespace takt::cli
