// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/trace_file.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "json/quantity.hpp"
#include "models/ethernet/sizes.hpp"
#include "scenario/description/limits.hpp"

namespace takt::scenario {
namespace {

constexpr sim::Duration longest_trace =
    sim::Duration::from_ps(8'640'000'000'000'000'000);  // 100 days, as long as the longest run

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

}  // namespace

std::vector<models::TraceSchedule::Entry> parse_trace(std::string_view text, const std::string& file,
                                                      json::Diagnostics& diagnostics) {
  std::vector<models::TraceSchedule::Entry> entries;
  std::uint32_t line_number = 0;
  while (!text.empty() && !diagnostics.full()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    ++line_number;
    if (line.empty() || (line_number == 1 && line.starts_with("time"))) continue;
    const std::size_t comma = line.find(',');
    if (comma == std::string_view::npos) {
      diagnostics.error({file, line_number, 1, ""}, "not a line of a trace",
                        {json::quote(line), "time,payload such as 12.5us,100B"});
      continue;
    }
    const auto time = json::parse_duration(trimmed(line.substr(0, comma)));
    const auto payload = json::parse_octets(trimmed(line.substr(comma + 1)));
    if (!time)
      diagnostics.error({file, line_number, 1, ""}, time.reason().message,
                        {json::quote(line.substr(0, comma)), time.reason().expected});
    if (!payload)
      diagnostics.error({file, line_number, static_cast<std::uint32_t>(comma + 2), ""}, payload.reason().message,
                        {json::quote(line.substr(comma + 1)), payload.reason().expected});
    if (!time || !payload) continue;
    if (*time > longest_trace) {
      diagnostics.error({file, line_number, 1, ""}, "out of range",
                        {json::to_text(*time), "a time of at most " + json::to_text(longest_trace)});
      continue;
    }
    if (!entries.empty() && sim::LocalTime() + *time < entries.back().time) {
      diagnostics.error({file, line_number, 1, ""}, "times must ascend",
                        {json::to_text(*time), "at least " + json::to_text(entries.back().time.since_start())});
      continue;
    }
    if (entries.size() >= most_trace_entries) {
      diagnostics.error({file, line_number, 1, ""}, "too many lines",
                        {"more", "at most " + std::to_string(most_trace_entries)});
      return entries;
    }
    entries.push_back({sim::LocalTime() + *time, *payload});
  }
  if (entries.empty() && !diagnostics.has_errors())
    diagnostics.error({file, 0, 0, ""}, "an empty trace", {"no frames", "lines time,payload"});
  return entries;
}

std::vector<models::TraceSchedule::Entry> read_trace(const std::string& name, const json::Place& place,
                                                     json::Diagnostics& diagnostics) {
  std::filesystem::path path(name);
  if (path.is_relative()) path = std::filesystem::path(place.file).parent_path() / path;
  std::error_code failure;
  std::ifstream file;
  if (std::filesystem::is_regular_file(path, failure)) file.open(path, std::ios::binary);
  if (!file.is_open()) {
    diagnostics.error(place, "cannot read the trace", {json::quote(path.string()), "a CSV file"});
    return {};
  }
  std::ostringstream text;
  text << file.rdbuf();
  return parse_trace(text.str(), path.string(), diagnostics);
}

}  // namespace takt::scenario
