// SPDX-License-Identifier: Apache-2.0
#include "cli/threads.hpp"

#include <cstdio>

namespace takt::cli {

void add_threads_option(Command command, std::uint32_t& threads) {
  command.add_option("--threads", threads, "Simulate on so many threads where that is faster; the results are the same")
      .type_name("N")
      .between(std::uint32_t{1}, most_threads);
}

scenario::Division division_for(const scenario::Resolved& resolved, unsigned threads) {
  scenario::Division division = scenario::divide(resolved, threads);
  if (!division.why_fewer.empty())
    std::fprintf(stderr, "takt: %u %s instead of %u: %s\n", division.parts, division.parts == 1 ? "thread" : "threads",
                 threads, division.why_fewer.c_str());
  return division;
}

}  // namespace takt::cli
