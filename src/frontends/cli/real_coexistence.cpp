// SPDX-License-Identifier: Apache-2.0
#include "cli/real_coexistence.hpp"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "cli/interrupt.hpp"
#include "emulate/coexistence.hpp"
#include "node/dds/participant.hpp"

namespace takt::cli {
namespace {

constexpr int windows_of_short = 100;

bool write(const std::string& folder, const char* name, const std::string& text) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::ofstream file(std::filesystem::path(folder) / name);
  return static_cast<bool>(file << text << std::flush);
}

}  // namespace

std::optional<emulate::MeasuredCoexistence> measure_coexistence(const RealCoexistenceOptions& options,
                                                                ExitStatus& failure) {
  failure = ExitStatus::internal_error;
  if (!node::has_dds()) {
    std::fprintf(stderr, "takt: cannot measure here: DDS is not in this build; needed is %s\n", node::dds_needed);
    return std::nullopt;
  }
  if (::geteuid() != 0)
    std::fprintf(stderr, "takt: warning: network namespaces need root (try sudo); measuring over loopback instead\n");
  const InterruptGuard interrupt;
  emulate::CoexistenceSettings settings;
  if (options.is_short) settings.windows = windows_of_short;
  if (!options.is_quiet)
    settings.progress = [](const std::string& what) { std::fprintf(stderr, "%s\n", what.c_str()); };
  if (!options.out.empty()) settings.keep = (std::filesystem::path(options.out) / "measured").string();
  settings.stop_requested = [](const void* guard) { return static_cast<const InterruptGuard*>(guard)->requested(); };
  settings.context = &interrupt;
  std::string problem;
  const auto measured = emulate::measure_coexistence(settings, problem);
  if (!measured) {
    if (interrupt.requested())
      failure = ExitStatus::interrupted;
    else
      std::fprintf(stderr, "takt: cannot measure here: %s\n", problem.c_str());
    return std::nullopt;
  }
  if (!options.out.empty() && (!write(options.out, "measured.txt", to_text(*measured)) ||
                               !write(options.out, "measured.json", to_json(*measured)))) {
    std::fprintf(stderr, "takt: cannot write results into %s\n", options.out.c_str());
    return std::nullopt;
  }
  return measured;
}

papers::coexistence::MeasuredCriteria criteria_of(const emulate::MeasuredCoexistence& measured) {
  using namespace papers::coexistence;
  MeasuredCriteria made;
  made.machine = measured.machine;
  for (const emulate::MeasuredThread& thread : measured.mirror) {
    for (std::size_t t = 0; t < tables.size(); ++t)
      if (tables[t].protocol == thread.protocol && tables[t].node == thread.node &&
          tables[t].operation == thread.operation)
        made.success[t] = thread.success;
    for (std::size_t r = 0; r < receivers.size(); ++r)
      if (thread.operation == "subscribe" && receivers[r].protocol == thread.protocol &&
          receivers[r].node == thread.node)
        made.buffered[r] = thread.buffered;
  }
  return made;
}

}  // namespace takt::cli
