#include "cli/threads.hpp"

#include <cstdio>

namespace takt::cli {

void add_threads_option(Command command, std::uint32_t& threads) {
  command.add_option("--threads", threads, "Simulate on so many threads where that is faster; the results are the same").type_name("N").between(std::uint32_t{1}, most_threads);
}

scenario::Division division_for(const scenario::Resolved& resolved, unsigned threads, std::string_view why_one) {
  scenario::Division division = scenario::divide(resolved, why_one.empty() ? threads : 1);
  const std::string& why = threads > 1 && !why_one.empty() ? std::string(why_one) : division.why_fewer;
  if (!why.empty())
    std::fprintf(stderr, "takt: %u %s instead of %u: %s\n", division.parts, division.parts == 1 ? "thread" : "threads", threads, why.c_str());
  return division;
}

}  // namespace takt::cli
