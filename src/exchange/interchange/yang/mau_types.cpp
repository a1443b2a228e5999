// SPDX-License-Identifier: Apache-2.0
#include "interchange/yang/mau_types.hpp"

#include <algorithm>
#include <iterator>

namespace takt::interchange::yang {
namespace {

using scenario::Medium;

struct MauType {
  std::int64_t number;
  Medium medium;
};

constexpr MauType mau_types[] = {
    {11, Medium::base_t_10},    // 10BASE-T
    {16, Medium::base_tx_100},  // 100BASE-TX
    {18, Medium::base_fx_100},  // 100BASE-FX
    {22, Medium::base_x_1000},  // 1000BASE-X
    {24, Medium::base_x_1000},  // 1000BASE-LX
    {26, Medium::base_x_1000},  // 1000BASE-SX
    {28, Medium::base_x_1000},  // 1000BASE-CX
    {30, Medium::base_t_1000},  // 1000BASE-T
    {33, Medium::gbase_r_10},   // 10GBASE-R
    {34, Medium::gbase_r_10},   // 10GBASE-ER
    {35, Medium::gbase_r_10},   // 10GBASE-LR
    {36, Medium::gbase_r_10},   // 10GBASE-SR
    {44, Medium::base_fx_100},  // 100BASE-BX10D
    {45, Medium::base_fx_100},  // 100BASE-BX10U
    {46, Medium::base_fx_100},  // 100BASE-LX10
    {47, Medium::base_x_1000},  // 1000BASE-BX10D
    {48, Medium::base_x_1000},  // 1000BASE-BX10U
    {49, Medium::base_x_1000},  // 1000BASE-LX10
    {54, Medium::gbase_t_10},   // 10GBASE-T
};

}  // namespace

std::optional<scenario::Medium> medium_of_mau(std::int64_t mau_type) {
  const auto found = std::ranges::find(mau_types, mau_type, &MauType::number);
  return found == std::end(mau_types) ? std::nullopt : std::optional(found->medium);
}

}  // namespace takt::interchange::yang
