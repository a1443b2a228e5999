// gPTP as instance data: the data sets of IEEE 802.1AS in the module of IEEE 1588 and what 802.1AS adds to it. What devices do of themselves (servos,
// windows of measurements) no module says.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "interchange/device_import.hpp"
#include "interchange/export.hpp"
#include "interchange/ports.hpp"
#include "interchange/yang/data.hpp"

namespace takt::interchange::yang {

/// An instance for each domain. Losses are told.
void write_gptp(Data& root, const scenario::Resolved& resolved, const Device& device, Dialect dialect, Exported& exported);

/// Domain 0 and further ones; takt has intervals, timeouts and thresholds once, so that ports that differ are refused.
void read_gptp(const Data& root, ImportedDevice& device, Imported& imported, json::Diagnostics& diagnostics);

/// Identities of the module and the numbers that PTP messages carry.
struct NamedNumber {
  std::string_view name;             ///< without its module
  std::uint8_t number;
};
/// The tables by the leaf that has the identity: "clock-class", "clock-accuracy", "time-source". Null if there is none.
std::optional<std::string_view> identity_of_number(std::string_view leaf, std::uint8_t number);
std::optional<std::uint8_t> number_of_identity(std::string_view leaf, std::string_view name);

/// IEEE 1588 5.3.2, TimeInterval: 2^-16 ns. Rounded; every whole number of ps comes back.
std::int64_t time_interval(sim::Duration duration);
std::optional<sim::Duration> duration_of_time_interval(std::int64_t interval);   ///< null beyond an hour

}  // namespace takt::interchange::yang
