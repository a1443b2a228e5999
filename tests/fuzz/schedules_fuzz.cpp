// SPDX-License-Identifier: Apache-2.0
// Any octets as an instance of a scheduling problem, in whatever format they look like: neither crash nor hang, and
// what is accepted survives a round trip.
//
// A line "--- file ---" separates two files.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "schedule_instances/instances.hpp"
#include "schedule_instances/write.hpp"
#include "schedule/decide.hpp"
#include "sim/check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace takt;
  std::string_view text(reinterpret_cast<const char*>(data), size);
  constexpr std::string_view between = "--- file ---\n";
  std::vector<schedule_instances::TextFile> files;
  for (int i = 0; i < 3; ++i) {
    const std::size_t end = text.find(between);
    files.push_back({"file" + std::to_string(i), std::string(text.substr(0, end))});
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + between.size());
  }
  json::Diagnostics diagnostics;
  schedule_instances::InstanceReader reader(files);
  while (!reader.is_at_end() && !diagnostics.has_errors()) {
    const auto problem = reader.next(diagnostics);
    TAKT_CHECK(!problem || !diagnostics.has_errors(), "what is wrong is no problem");
    if (!problem) continue;
    const std::string written = json::pretty(schedule_instances::write_problem(*problem));
    json::Diagnostics none;
    schedule_instances::InstanceReader again(std::vector<schedule_instances::TextFile>{{"again", written}});
    const auto copy = again.next(none);
    TAKT_CHECK(copy && json::pretty(schedule_instances::write_problem(*copy)) == written,
               "a problem that is written means the same");
    // What is accepted can be asked about, whatever its numbers.
    schedule::SearchOptions options;
    options.attempts = 1;
    int asked = 0;
    options.stop = [&asked] { return ++asked > 20; };
    schedule::decide(*problem, options);
  }
  TAKT_CHECK(diagnostics.to_text().size() <= std::size_t{1} << 22, "what is told to the user is bounded");
  return 0;
}
