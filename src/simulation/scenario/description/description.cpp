// SPDX-License-Identifier: Apache-2.0
// Special members of large structs, compiled once: copies inline cost each unit that makes one seconds.
#include "scenario/description/description.hpp"

namespace takt::scenario {

Scenario::Scenario() = default;
Scenario::Scenario(const Scenario&) = default;
Scenario::Scenario(Scenario&&) noexcept = default;
Scenario& Scenario::operator=(const Scenario&) = default;
Scenario& Scenario::operator=(Scenario&&) noexcept = default;
Scenario::~Scenario() = default;

Requirement::Requirement() = default;
Requirement::Requirement(const Requirement&) = default;
Requirement::Requirement(Requirement&&) noexcept = default;
Requirement& Requirement::operator=(const Requirement&) = default;
Requirement& Requirement::operator=(Requirement&&) noexcept = default;
Requirement::~Requirement() = default;

NetworkSection::NetworkSection() = default;
NetworkSection::NetworkSection(const NetworkSection&) = default;
NetworkSection::NetworkSection(NetworkSection&&) noexcept = default;
NetworkSection& NetworkSection::operator=(const NetworkSection&) = default;
NetworkSection& NetworkSection::operator=(NetworkSection&&) noexcept = default;
NetworkSection::~NetworkSection() = default;

Egress::Egress() = default;
Egress::Egress(const Egress&) = default;
Egress::Egress(Egress&&) noexcept = default;
Egress& Egress::operator=(const Egress&) = default;
Egress& Egress::operator=(Egress&&) noexcept = default;
Egress::~Egress() = default;

Stream::Stream() = default;
Stream::Stream(const Stream&) = default;
Stream::Stream(Stream&&) noexcept = default;
Stream& Stream::operator=(const Stream&) = default;
Stream& Stream::operator=(Stream&&) noexcept = default;
Stream::~Stream() = default;

}  // namespace takt::scenario
