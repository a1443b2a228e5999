// SPDX-License-Identifier: Apache-2.0
// What the words of "server" mean together.
#pragma once

#include "node/config.hpp"

namespace takt::node {

/// Of the server of a file that has one; loads the keys that it gives.
void check_server(LoadedConfig& loaded, json::Diagnostics& diagnostics);

}  // namespace takt::node
