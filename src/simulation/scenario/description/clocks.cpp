// SPDX-License-Identifier: Apache-2.0
// Special members of large structs, compiled once: copies inline cost each unit that makes one seconds.
#include "scenario/description/clocks.hpp"

namespace takt::scenario {

Gptp::Gptp() = default;
Gptp::Gptp(const Gptp&) = default;
Gptp::Gptp(Gptp&&) noexcept = default;
Gptp& Gptp::operator=(const Gptp&) = default;
Gptp& Gptp::operator=(Gptp&&) noexcept = default;
Gptp::~Gptp() = default;

Clock::Clock() = default;
Clock::Clock(const Clock&) = default;
Clock::Clock(Clock&&) noexcept = default;
Clock& Clock::operator=(const Clock&) = default;
Clock& Clock::operator=(Clock&&) noexcept = default;
Clock::~Clock() = default;

}  // namespace takt::scenario
