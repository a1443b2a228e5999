// SPDX-License-Identifier: Apache-2.0
// What a bridge announces of itself by IEC/IEEE 60802: delays, PHYs, buffers, features. Part of the tables of
// schema.cpp.
#pragma once

#include "interchange/yang/schema_words.hpp"

namespace takt::interchange::yang {

inline constexpr Schema phy_latency[] = {leaf(iec_bridge_m, "mau-type", Type::int32, true),
                                         leaf(iec_bridge_m, "latency", Type::uint32),
                                         leaf(iec_bridge_m, "latency-variation", Type::uint16)};
inline constexpr Schema supported_algorithm[] = {identity_of(iec_bridge_m, "algorithm", {}, true)};
inline constexpr Schema supported_algorithms[] = {
    leaf(iec_bridge_m, "traffic-class", Type::uint8, true, 0, 7),
    entries(iec_bridge_m, "algorithms", "algorithm", supported_algorithm)};
inline constexpr Schema class_of_pool[] = {leaf(iec_bridge_m, "traffic-class", Type::uint8, true, 0, 7)};
inline constexpr Schema resource_pool[] = {
    leaf(iec_bridge_m, "resource-pool-name", Type::text, true),
    node(iec_bridge_m, "covered-time-interval", rational<iec_bridge_m>),
    entries(iec_bridge_m, "resource-pool-traffic-classes", "traffic-class", class_of_pool)};
inline constexpr Schema supported_mau[] = {leaf(iec_eth_m, "mau-type", Type::int32, true),
                                           leaf(iec_eth_m, "preemption-supported", Type::boolean)};
inline constexpr Schema independent_delay[] = {leaf(iec_bridge_m, "in-port-mau-type", Type::int32, true),
                                               leaf(iec_bridge_m, "out-port-mau-type", Type::int32, true),
                                               leaf(iec_bridge_m, "traffic-class", Type::uint8, true, 0, 7),
                                               leaf(iec_bridge_m, "independent-delay-min", Type::uint32),
                                               leaf(iec_bridge_m, "independent-delay-max", Type::uint32)};
inline constexpr Schema dependent_delay[] = {leaf(iec_bridge_m, "in-port-line-speed", Type::uint32, true),
                                             leaf(iec_bridge_m, "dependent-delay-min", Type::uint32),
                                             leaf(iec_bridge_m, "dependent-delay-max", Type::uint32)};
inline constexpr Schema independent_delay_of_ports[] = {leaf(iec_bridge_m, "in-port", Type::uint8, true),
                                                        leaf(iec_bridge_m, "in-port-mau-type", Type::int32, true),
                                                        leaf(iec_bridge_m, "out-port", Type::uint8, true),
                                                        leaf(iec_bridge_m, "out-port-mau-type", Type::int32, true),
                                                        leaf(iec_bridge_m, "traffic-class", Type::uint8, true, 0, 7),
                                                        leaf(iec_bridge_m, "independent-delay-min", Type::uint32),
                                                        leaf(iec_bridge_m, "independent-delay-max", Type::uint32)};
inline constexpr Schema dependent_delay_of_ports[] = {
    leaf(iec_bridge_m, "in-port", Type::uint8, true), leaf(iec_bridge_m, "in-port-line-speed", Type::uint32, true),
    leaf(iec_bridge_m, "out-port", Type::uint8, true), leaf(iec_bridge_m, "dependent-delay-min", Type::uint32),
    leaf(iec_bridge_m, "dependent-delay-max", Type::uint32)};

}  // namespace takt::interchange::yang
