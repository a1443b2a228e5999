// SPDX-License-Identifier: Apache-2.0
// The nodes of a key service (OPC 10000-14, 8.3 and 9.1.3): PublishSubscribe with its method GetSecurityKeys, and their
// types.
#pragma once

#include "opcua/address_space/address_space.hpp"

namespace takt::opcua {

/// Once.
void add_key_service(AddressSpace& space);

}  // namespace takt::opcua
