// SPDX-License-Identifier: Apache-2.0
// What a node of applications sends and hears over OPC UA.
#pragma once

#include "node/applications/config.hpp"
#include "node/description.hpp"

namespace takt::node {

/// Topics that this node publishes or subscribes to.
NodeDescription description_of(const LoadedApplications& loaded);

}  // namespace takt::node
