// Numbers of PTP messages and the identities that the module of IEEE 1588 gives them.
#include <algorithm>
#include <span>

#include "interchange/yang/gptp.hpp"
#include "sim/check.hpp"

namespace takt::interchange::yang {
namespace {

// IEEE 1588-2019 tables 4, 5 and 6.
constexpr NamedNumber classes[] = {
    {"cc-primary-sync", 6}, {"cc-primary-sync-lost", 7}, {"cc-application-specific-sync", 13}, {"cc-application-specific-sync-lost", 14}, {"cc-primary-sync-alternative-a", 52},
    {"cc-application-specific-alternative-a", 58}, {"cc-primary-sync-alternative-b", 187}, {"cc-application-specific-alternative-b", 193}, {"cc-default", 248}, {"cc-time-receiver-only", 255},
};
constexpr NamedNumber accuracies[] = {
    {"ca-time-accurate-to-1000-fs", 0x17}, {"ca-time-accurate-to-2500-fs", 0x18}, {"ca-time-accurate-to-10-ps", 0x19}, {"ca-time-accurate-to-25ps", 0x1A}, {"ca-time-accurate-to-100-ps", 0x1B},
    {"ca-time-accurate-to-250-ps", 0x1C}, {"ca-time-accurate-to-1000-ps", 0x1D}, {"ca-time-accurate-to-2500-ps", 0x1E}, {"ca-time-accurate-to-10-ns", 0x1F}, {"ca-time-accurate-to-25-ns", 0x20},
    {"ca-time-accurate-to-100-ns", 0x21}, {"ca-time-accurate-to-250-ns", 0x22}, {"ca-time-accurate-to-1000-ns", 0x23}, {"ca-time-accurate-to-2500-ns", 0x24}, {"ca-time-accurate-to-10-us", 0x25},
    {"ca-time-accurate-to-25-us", 0x26}, {"ca-time-accurate-to-100-us", 0x27}, {"ca-time-accurate-to-250-us", 0x28}, {"ca-time-accurate-to-1000-us", 0x29}, {"ca-time-accurate-to-2500-us", 0x2A},
    {"ca-time-accurate-to-10-ms", 0x2B}, {"ca-time-accurate-to-25-ms", 0x2C}, {"ca-time-accurate-to-100-ms", 0x2D}, {"ca-time-accurate-to-250-ms", 0x2E}, {"ca-time-accurate-to-1-s", 0x2F},
    {"ca-time-accurate-to-10-s", 0x30}, {"ca-time-accurate-to-gt-10-s", 0x31},
};
constexpr NamedNumber sources[] = {
    {"atomic-clock", 0x10}, {"gnss", 0x20}, {"terrestrial-radio", 0x30}, {"serial-time-code", 0x39}, {"ptp", 0x40}, {"ntp", 0x50}, {"hand-set", 0x60}, {"other", 0x90}, {"internal-oscillator", 0xA0},
};

std::span<const NamedNumber> table_of(std::string_view leaf) {
  if (leaf == "clock-class") return classes;
  if (leaf == "clock-accuracy") return accuracies;
  TAKT_CHECK(leaf == "time-source", "a leaf with a table of identities");
  return sources;
}

}  // namespace

std::optional<std::string_view> identity_of_number(std::string_view leaf, std::uint8_t number) {
  const auto table = table_of(leaf);
  const auto found = std::ranges::find(table, number, &NamedNumber::number);
  return found == table.end() ? std::nullopt : std::optional(found->name);
}

std::optional<std::uint8_t> number_of_identity(std::string_view leaf, std::string_view name) {
  if (const std::size_t colon = name.find(':'); colon != std::string_view::npos) name.remove_prefix(colon + 1);
  const auto table = table_of(leaf);
  const auto found = std::ranges::find(table, name, &NamedNumber::name);
  return found == table.end() ? std::nullopt : std::optional(found->number);
}

namespace {
/// numerator / denominator to the nearest whole number, halves away from 0.
std::int64_t nearest(sim::int128 numerator, std::int64_t denominator) {
  const sim::int128 half = denominator / 2;
  return static_cast<std::int64_t>((numerator < 0 ? numerator - half : numerator + half) / denominator);
}
}  // namespace

std::int64_t time_interval(sim::Duration duration) { return nearest(static_cast<sim::int128>(duration.ps()) * 65536, 1000); }

std::optional<sim::Duration> duration_of_time_interval(std::int64_t interval) {
  const sim::int128 hour = static_cast<sim::int128>(3'600'000'000'000) * 65536;   // ns
  if (interval > hour || -static_cast<sim::int128>(interval) > hour) return std::nullopt;
  return sim::Duration::from_ps(nearest(static_cast<sim::int128>(interval) * 1000, 65536));
}

}  // namespace takt::interchange::yang
