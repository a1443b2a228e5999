// SPDX-License-Identifier: Apache-2.0
#include "output/application_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "output/text_report.hpp"

namespace takt::output {
namespace {

constexpr std::size_t most_rows = 64;

std::string participant_row(const std::string& name, const results::ParticipantResult& p, std::size_t width) {
  std::string row = fmt::format(
      "  {:<{}}  domain {}: {} messages, {} octets sent, {} heartbeats, {} acknacks, {} resent; discovery {} messages, "
      "{} octets, {} matches{}\n",
      name, width, p.domain, p.messages_sent, p.octets_sent, p.heartbeats_sent, p.acknacks_sent, p.resent,
      p.discovery_messages, p.discovery_octets, p.matches,
      p.time_to_match ? " within " + readable(*p.time_to_match) : "");
  for (const std::string& reason : p.incompatible) row += fmt::format("  {:<{}}  not matched: {}\n", "", width, reason);
  return row;
}

std::string percent_text(const std::optional<double>& percent) {
  return percent ? fmt::format("{:.2f} %", *percent) : std::string("-");
}

std::string row_of(const results::ApplicationResult& application, const results::ThreadResult& t, std::size_t width) {
  const std::string response = t.response ? fmt::format("{} / {} / {}", readable(t.response->min),
                                                        readable(t.response->mean), readable(t.response->max))
                                          : "-";
  std::string row =
      fmt::format("  {:<{}}  {:>9}  {:>10}  {:>9}  {:>9}  {:>10}", application.name + "/" + t.name, width,
                  readable(t.every), t.activations, t.missed, t.calls.tests, percent_text(t.calls.percent));
  row += fmt::format("  {:>10}  {}", t.values ? percent_text(t.values->percent) : "", response);
  for (const auto& [count, what] :
       {std::pair(t.refused, "refused"), std::pair(t.timed_out, "timed out"), std::pair(t.overwritten, "overwritten"),
        std::pair(t.values ? t.values->beyond : 0, "too late"), std::pair(t.lost, "lost"),
        std::pair(t.filtered.value_or(0), "filtered"), std::pair(t.calls.discarded, "tests discarded")})
    if (count > 0) row += fmt::format(", {} {}", count, what);
  if (t.measures_round_trips)
    row += t.round_trip
               ? fmt::format(", {} round trips of {} / {} / {}", t.round_trip->count, readable(t.round_trip->min),
                             readable(t.round_trip->mean), readable(t.round_trip->max))
               : ", no round trip";
  return row + "\n";
}

std::string signal_row(const results::SignalResult& s, std::size_t width) {
  if (!s.pulses) return fmt::format("  {:<{}}  no pulse\n", s.name, width);
  std::string row =
      fmt::format("  {:<{}}  {} pulses: min {}, mean {}, max {}, deviation {}, nominal {}; {:.2f} % of them irregular",
                  s.name, width, s.pulses->count, readable(s.pulses->min), readable(s.pulses->mean),
                  readable(s.pulses->max), readable(s.pulses->deviation), readable(s.nominal), *s.irregular_percent());
  if (s.periods)
    row += fmt::format("; period min {}, mean {}, max {}", readable(s.periods->min), readable(s.periods->mean),
                       readable(s.periods->max));
  return row + "\n";
}

}  // namespace

std::string applications_part(const results::RunResult& result) {
  std::size_t width = 6;
  std::size_t rows = 0;
  for (const results::ApplicationResult& a : result.applications)
    for (const results::ThreadResult& t : a.threads) width = std::max(width, a.name.size() + 1 + t.name.size());
  std::string out;
  if (!result.applications.empty()) {
    out += "\nThreads of applications: calls that took place (criterion 1), values that were buffered (criterion 2)\n";
    out += fmt::format("  {:<{}}  {:>9}  {:>10}  {:>9}  {:>9}  {:>10}  {:>10}  {}\n", "thread", width, "every",
                       "activated", "missed", "tests", "calls", "values", "response min / mean / max");
  }
  for (const results::ApplicationResult& a : result.applications)
    for (const results::ThreadResult& t : a.threads)
      if (++rows <= most_rows) out += row_of(a, t, width);
  if (rows > most_rows) out += fmt::format("  ... {} more\n", rows - most_rows);
  const auto any_participant = [](const results::ApplicationResult& a) { return !a.participants.empty(); };
  if (std::any_of(result.applications.begin(), result.applications.end(), any_participant))
    out += "\nParticipants of DDS\n";
  rows = 0;
  for (const results::ApplicationResult& a : result.applications)
    for (const results::ParticipantResult& p : a.participants)
      if (++rows <= most_rows) out += participant_row(a.name, p, width);
  for (const results::ApplicationResult& a : result.applications)
    if (a.buffer)
      out += fmt::format(
          "\nGateway {}: {} values received, {} forwarded, {} overwritten, {} dropped, {} stale, {} not mapped; age "
          "min {}, mean {}, max {}\n",
          a.name, a.buffer->received, a.buffer->forwarded, a.buffer->overwritten, a.buffer->dropped, a.buffer->stale,
          a.buffer->not_mapped, readable(a.buffer->age_min), readable(a.buffer->age_mean), readable(a.buffer->age_max));
  for (const results::ApplicationResult& a : result.applications)
    for (const results::KeptResult& each : a.kept)
      out += fmt::format(
          "\nPersistence service {}: topic {}, {} samples received, {} restored at its last start, {} kept\n", a.name,
          each.topic, each.received, each.restored, each.kept);
  if (result.signals.empty()) return out;
  out += "\nDigital outputs\n";
  width = 0;
  for (const results::SignalResult& s : result.signals) width = std::max(width, s.name.size());
  for (const results::SignalResult& s : result.signals) out += signal_row(s, width);
  return out;
}

}  // namespace takt::output
