// SPDX-License-Identifier: Apache-2.0
// The media of links, by their names in IEEE 802.3. Each has one rate.
#pragma once

#include <cstdint>

#include "json/fields.hpp"
#include "sim/units.hpp"

namespace takt::scenario {

enum class Medium : std::uint8_t {
  base_t_10,
  base_t1l_10,
  base_t1s_10,
  base_tx_100,
  base_fx_100,
  base_t1_100,
  base_t_1000,
  base_x_1000,
  base_t1_1000,
  gbase_t_2_5,
  gbase_x_2_5,
  gbase_t_5,
  gbase_t_10,
  gbase_r_10,
};

sim::DataRate rate_of(Medium medium);

const json::Enumeration& describe(json::Type<Medium>);

}  // namespace takt::scenario
