// SPDX-License-Identifier: Apache-2.0
// Index ranges of values (OPC 10000-4, 7.27): "n" or "n:m".
#pragma once

#include "opcua/encoding/variant.hpp"

namespace takt::opcua {

/// Leaves of the value what the range says; no range leaves all. Good, Bad_IndexRangeInvalid or Bad_IndexRangeNoData.
/// Ranges of several dimensions have no data here, for no value has several.
StatusCode cut(Variant& value, std::string_view range);

}  // namespace takt::opcua
