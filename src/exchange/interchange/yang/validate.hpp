// SPDX-License-Identifier: Apache-2.0
// What libyang says of instance data, by modules that the user has. Optional: without libyang2-dev takt is built
// without it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "interchange/export.hpp"

namespace takt::interchange {

/// Whether this takt is built with libyang.
bool can_validate_yang();

struct YangValidation {
  std::string mistake = {};               ///< the folder or its modules cannot be used; nothing else counts then
  std::vector<std::string> invalid = {};  ///< "sw1.json: what libyang says (where)"
};

/// Validates each file (but the table of names) for itself, as configuration. The folder has modules as
/// NAME@REVISION.yang, or has folders of them as docs/interchange.md says. CHECKs that can_validate_yang.
YangValidation validate_yang(std::span<const OutputFile> files, bool is_2018, const std::string& folder);

}  // namespace takt::interchange
