// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "emulate/coexistence.hpp"
#include "json/record.hpp"

namespace takt::emulate {
namespace {

std::string cell(const std::optional<double>& percent) { return percent ? fmt::format("{:.1f} %", *percent) : "-"; }

std::string table(const char* title, const std::vector<MeasuredThread>& rows) {
  std::string out = fmt::format("{}\n  {:<30}", title, "");
  for (const int interval : coexistence_intervals) out += fmt::format(" {:>9}", fmt::format("{} ms", interval));
  out += "   tests (discarded)      late p99, us\n";
  const auto line = [&](const MeasuredThread& row, const char* what,
                        const std::array<std::optional<double>, 4>& percents, bool is_first) {
    out += fmt::format("  {:<30}", fmt::format("{} {}, {}", row.protocol, row.node, what));
    for (const auto& percent : percents) out += fmt::format(" {:>9}", cell(percent));
    if (is_first) {
      std::uint64_t tests = 0;
      std::uint64_t discarded = 0;
      for (std::size_t c = 0; c < 4; ++c) tests += row.tests[c], discarded += row.discarded[c];
      out += fmt::format("   {:<22}", fmt::format("{} ({})", tests, discarded));
      out += fmt::format(" {:.0f} / {:.0f} / {:.0f} / {:.0f}", row.late_p99_us[0], row.late_p99_us[1],
                         row.late_p99_us[2], row.late_p99_us[3]);
    }
    out += "\n";
  };
  for (const MeasuredThread& row : rows) line(row, row.operation.c_str(), row.success, true);
  out += "  criterion 2, samples buffered\n";
  for (const MeasuredThread& row : rows)
    if (row.operation == "subscribe") line(row, "buffered", row.buffered, false);
  return out;
}

bool subscribes(const MeasuredThread& thread) { return thread.operation == "subscribe"; }
const std::array<int, 4>& intervals_of(const MeasuredCoexistence&) { return coexistence_intervals; }

}  // namespace

std::string to_text(const MeasuredCoexistence& measured) {
  std::string out = "Measured on " + measured.machine + "\n\n";
  out += table("Case study 1, criterion 1: calls that took place in windows of 10 ms", measured.mirror);
  out += "\n" + table("Case study 2, OPC UA to DDS through the gateway", measured.gateway);
  out += "  shared buffer\n";
  for (std::size_t c = 0; c < measured.buffers.size(); ++c)
    if (const auto& buffer = measured.buffers[c])
      out += fmt::format("    {:>2} ms: {} received, {} forwarded, {} overwritten, mean age {:.0f} us\n",
                         coexistence_intervals[c], buffer->received, buffer->forwarded, buffer->overwritten,
                         buffer->mean_age_us);
  return out;
}

const json::Record& describe(json::Type<MeasuredThread>) {
  using T = MeasuredThread;
  static constexpr json::Output outputs[] = {
      json::output<&T::protocol>("protocol", "DDS or OPC UA; of the gateway gateway."),
      json::output<&T::node>("node", "Where it runs."),
      json::output<&T::operation>("operation", "publish or subscribe."),
      json::output<&T::success>("success_percent", "Criterion 1 at each interval; null: not measured.", {.unit = "%"}),
      json::only_if<&subscribes>(
          json::output<&T::buffered>("buffered_percent", "Criterion 2 at each interval.", {.unit = "%"}),
          "of a thread that subscribes"),
      json::output<&T::tests>("tests", "Windows."),
      json::output<&T::discarded>("discarded", "Windows at whose end the scheduler was not let run."),
      json::output<&T::late_p99_us>("late_p99_us", "From an activation to waking up, the 99th percentile.",
                                    {.unit = "us"}),
  };
  static constexpr json::Record record{"thread", "A thread at each interval.", outputs};
  return record;
}

const json::Record& describe(json::Type<MeasuredBuffer>) {
  using B = MeasuredBuffer;
  static constexpr json::Output outputs[] = {
      json::output<&B::received>("received", "Values that came."),
      json::output<&B::forwarded>("forwarded", "Values that were sent on."),
      json::output<&B::overwritten>("overwritten", "Values that made room for a newer one."),
      json::output<&B::mean_age_us>("mean_age_us", "How long they waited.", {.unit = "us"}),
  };
  static constexpr json::Record record{"buffer", "The shared buffer of the gateway.", outputs};
  return record;
}

const json::Record& describe(json::Type<MeasuredCoexistence>) {
  using M = MeasuredCoexistence;
  static constexpr json::Output outputs[] = {
      json::output<&M::machine>("machine", "Kernel, processors, network."),
      json::output<&intervals_of>("intervals_ms", "The columns.", {.unit = "ms"}),
      json::output<&M::mirror>("mirror", "Case study 1."),
      json::output<&M::gateway>("gateway", "Case study 2."),
      json::output<&M::buffers>("buffers", "Of case study 2, at each interval."),
  };
  static constexpr json::Record record{"coexistence", "The mirror architecture as it was measured on a machine.",
                                       outputs};
  return record;
}

std::string to_json(const MeasuredCoexistence& measured) { return json::write(measured); }

}  // namespace takt::emulate
