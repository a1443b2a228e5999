// SPDX-License-Identifier: Apache-2.0
// The tables of rules, one a profile.
#pragma once

#include "profile/profile.hpp"

namespace takt::profile {

std::span<const Rule> rules_of_60802();
std::span<const Rule> rules_of_uafx();
std::span<const Rule> rules_of_avb();

}  // namespace takt::profile
