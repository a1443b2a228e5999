// SPDX-License-Identifier: Apache-2.0
#include "output/cpu_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "output/text_report.hpp"

namespace takt::output {
namespace {

constexpr std::size_t most_cpu_rows = 64;

std::string row_of(const results::CpuResult& cpu, const results::CpuThreadResult& t, std::size_t width) {
  const std::string response =
      t.response ? fmt::format("{} / {} / {} / {}", readable(t.response->min), readable(t.response->mean),
                               readable(*t.response_p99), readable(t.response->max))
                 : "-";
  std::string row = fmt::format("  {:<{}}  {:>8}  {:>10}  {:>6.2f} %  {}", cpu.node + "/" + t.name, width, t.policy,
                                t.jobs, t.utilisation * 100, response);
  if (t.late > 0) row += fmt::format(", {} late", t.late);
  if (t.refused > 0) row += fmt::format(", {} refused", t.refused);
  return row + "\n";
}

}  // namespace

std::string cpus_part(const results::RunResult& result) {
  if (result.cpus.empty()) return "";
  std::size_t width = 6;
  for (const results::CpuResult& cpu : result.cpus)
    for (const results::CpuThreadResult& t : cpu.threads) width = std::max(width, cpu.node.size() + 1 + t.name.size());
  std::string out = "\nThreads of hosts, the time of a core that they took, and the response times of their jobs\n";
  out += fmt::format("  {:<{}}  {:>8}  {:>10}  {:>8}  {}\n", "thread", width, "policy", "jobs", "busy",
                     "response min / mean / p99 / max");
  std::size_t rows = 0;
  for (const results::CpuResult& cpu : result.cpus)
    for (const results::CpuThreadResult& t : cpu.threads)
      if (++rows <= most_cpu_rows) out += row_of(cpu, t, width);
  if (rows > most_cpu_rows) out += fmt::format("  ... {} more\n", rows - most_cpu_rows);
  return out;
}

}  // namespace takt::output
