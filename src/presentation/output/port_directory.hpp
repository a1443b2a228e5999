// SPDX-License-Identifier: Apache-2.0
// The names under which recorders know ports (models/port_directory.hpp).
#pragma once

#include "models/port_directory.hpp"

namespace takt::output {

using models::PortDirectory;
using models::PortId;

}  // namespace takt::output
