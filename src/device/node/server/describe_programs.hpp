// SPDX-License-Identifier: Apache-2.0
// What a server says of a node's Programs that does not change.
#pragma once

#include <vector>

#include "node/config.hpp"
#include "opcua/address_space/program_news.hpp"

namespace takt::node {

std::vector<opcua::ProgramDescription> describe_programs(const LoadedConfig& loaded);

}  // namespace takt::node
