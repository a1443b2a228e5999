// SPDX-License-Identifier: Apache-2.0
// gPTP as instance data: the data sets of IEEE 802.1AS in the module of IEEE 1588 and what 802.1AS adds to it. What
// devices do of themselves (servos, windows of measurements) no module says.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "interchange/device_import.hpp"
#include "interchange/export.hpp"
#include "interchange/ports.hpp"
#include "interchange/yang/data.hpp"

namespace takt::interchange::yang {

/// An instance for each domain. Losses are told.
void write_gptp(Data& root, const scenario::Resolved& resolved, const Device& device, Dialect dialect,
                Exported& exported);

/// Domain 0 and further ones; takt has intervals, timeouts and thresholds once, so that ports that differ are refused.
void read_gptp(const Data& root, ImportedDevice& device, Imported& imported, json::Diagnostics& diagnostics);

/// Identities of the module and the numbers that PTP messages carry.
struct NamedNumber {
  std::string_view name;  ///< without its module
  std::uint8_t number;
};
/// The tables by the leaf that has the identity: "clock-class", "clock-accuracy", "time-source". Null if there is none.
std::optional<std::string_view> identity_of_number(std::string_view leaf, std::uint8_t number);
std::optional<std::uint8_t> number_of_identity(std::string_view leaf, std::string_view name);

/// IEEE 1588 5.3.2, TimeInterval: 2^-16 ns. Rounded; every whole number of ps comes back.
std::int64_t time_interval(sim::Duration duration);
std::optional<sim::Duration> duration_of_time_interval(std::int64_t interval);  ///< null beyond an hour

/// IEEE 802.1AS 6.4.3.1, ScaledNs: the same unit in 96 bits, as twelve octets in hexadecimal ("00-00-...-28").
std::string scaled_ns(sim::Duration duration);
std::optional<sim::Duration> duration_of_scaled_ns(std::string_view text);  ///< null if it is none, or beyond an hour

/// A time as the logarithm to base 2 of seconds; -128 is no time at all. Null if it is no power of two.
std::optional<std::int8_t> log_of_seconds(sim::Duration duration);
std::optional<sim::Duration> duration_of_log(
    std::int64_t exponent);  ///< null beyond an hour, or if it is no whole number of ps

}  // namespace takt::interchange::yang
