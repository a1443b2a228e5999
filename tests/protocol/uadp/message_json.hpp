// SPDX-License-Identifier: Apache-2.0
// NetworkMessages as JSON, in the words of tests/golden/uadp, and octets from and to hexadecimal text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "uadp/data_set_message.hpp"
#include "uadp/network_message.hpp"
#include "uadp/raw_layout.hpp"

namespace takt::uadp {

std::vector<std::byte> octets_of(std::string_view hex);
std::string hex_of(Octets octets);

/// A value as {"type", "value"}, with "array" if it is one.
nlohmann::json to_json(const Variant& variant);
/// All of a decoded message but its flag octets. `expected` tells the types of RawData fields, which no message does.
nlohmann::json to_json(const NetworkMessage& message, const nlohmann::json& expected);

/// The layout of RawData fields of these types.
RawLayout raw_layout_of(const nlohmann::json& fields);

}  // namespace takt::uadp
