// SPDX-License-Identifier: Apache-2.0
#include "scenario/description/medium.hpp"

#include <array>
#include <iterator>
#include <string_view>

namespace takt::scenario {
namespace {

using sim::DataRate;

struct MediumRow {
  Medium medium;
  std::string_view name;
  DataRate rate;
  std::string_view help;
};

constexpr MediumRow medium_rows[] = {
    {Medium::base_t_10, "10BASE-T", DataRate{10'000'000}, "two pairs"},
    {Medium::base_t1l_10, "10BASE-T1L", DataRate{10'000'000}, "one pair of up to 1000 m, as Ethernet-APL has it"},
    {Medium::base_t1s_10, "10BASE-T1S", DataRate{10'000'000}, "one pair in half duplex: refused"},
    {Medium::base_tx_100, "100BASE-TX", DataRate{100'000'000}, "two pairs"},
    {Medium::base_fx_100, "100BASE-FX", DataRate{100'000'000}, "two fibres"},
    {Medium::base_t1_100, "100BASE-T1", DataRate{100'000'000}, "one pair"},
    {Medium::base_t_1000, "1000BASE-T", DataRate{1'000'000'000}, "four pairs"},
    {Medium::base_x_1000, "1000BASE-X", DataRate{1'000'000'000}, "two fibres or a backplane"},
    {Medium::base_t1_1000, "1000BASE-T1", DataRate{1'000'000'000}, "one pair"},
    {Medium::gbase_t_2_5, "2.5GBASE-T", DataRate{2'500'000'000}, "four pairs"},
    {Medium::gbase_x_2_5, "2.5GBASE-X", DataRate{2'500'000'000}, "two fibres or a backplane"},
    {Medium::gbase_t_5, "5GBASE-T", DataRate{5'000'000'000}, "four pairs"},
    {Medium::gbase_t_10, "10GBASE-T", DataRate{10'000'000'000}, "four pairs"},
    {Medium::gbase_r_10, "10GBASE-R", DataRate{10'000'000'000}, "two fibres or a backplane"},
};

constexpr bool are_in_order() {
  for (std::size_t i = 0; i < std::size(medium_rows); ++i)
    if (static_cast<std::size_t>(medium_rows[i].medium) != i) return false;
  return true;
}
static_assert(are_in_order(), "a medium is found by its number");

constexpr auto medium_names = [] {
  std::array<json::EnumName, std::size(medium_rows)> made{};
  for (std::size_t i = 0; i < made.size(); ++i)
    made[i] = json::name(medium_rows[i].medium, medium_rows[i].name, medium_rows[i].help);
  return made;
}();

}  // namespace

sim::DataRate rate_of(Medium medium) { return medium_rows[static_cast<std::size_t>(medium)].rate; }

const json::Enumeration& describe(json::Type<Medium>) {
  static constexpr json::Enumeration table = json::enumeration<Medium>("a medium", medium_names);
  return table;
}

}  // namespace takt::scenario
