// SPDX-License-Identifier: Apache-2.0
// Quality of service of scenario files as that of DDS.
#pragma once

#include "dds/qos/policies.hpp"
#include "scenario/description/dds.hpp"

namespace takt::scenario {

dds::DataWriterQos writer_qos(const Qos& qos, std::int32_t transport_priority);
/// A reader keeps as many samples as its thread takes in a call, unless a depth is said.
dds::DataReaderQos reader_qos(const Qos& qos, std::uint32_t buffer);

}  // namespace takt::scenario
