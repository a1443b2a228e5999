// SPDX-License-Identifier: Apache-2.0
// The first place on a way where nobody is met.
#pragma once

#include <optional>

#include "schedule/board.hpp"
#include "schedule/way.hpp"

namespace takt::schedule {

/// The least start in [from, until] at the talker; nothing if there is none. `period` as in `periods`.
std::optional<Ps> first_fit(const Board& board, const Periods& periods, std::uint32_t period, const Way& way, Ps from,
                            Ps until);

}  // namespace takt::schedule
