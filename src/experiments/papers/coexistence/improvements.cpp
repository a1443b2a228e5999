// SPDX-License-Identifier: Apache-2.0
#include "papers/coexistence/improvements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "json/fields.hpp"
#include "papers/coexistence/criteria.hpp"
#include "papers/coexistence/variants.hpp"
#include "scenario/resolve.hpp"

namespace takt::papers::coexistence {
namespace {

struct Variant {
  const char* name;  // of files
  const char* text;
  bool real_time;
  bool tsn;
};
constexpr std::array<Variant, 4> variants = {{
    {"as-published", "general-user Linux, plain Ethernet", false, false},
    {"preempt-rt", "PREEMPT_RT", true, false},
    {"tsn", "gates and gPTP", false, true},
    {"preempt-rt-tsn", "PREEMPT_RT, gates and gPTP", true, true},
}};

class Improver {
 public:
  Improver(const Options& options, Reproduction& made, json::Diagnostics& diagnostics)
      : options_(options), made_(made), diagnostics_(diagnostics) {}

  bool row(const Variant& variant, int interval) {
    ImprovementRow row;
    row.variant = variant.text;
    row.interval = interval;
    const auto mirror = changed("mirror", variant, interval, false);
    const auto gateway = changed("gateway", variant, interval, false);
    const auto reaction = changed("gateway", variant, interval, true);
    if (!mirror || !gateway || !reaction) return false;
    if (options_.progress) options_.progress(fmt::format("{} at {} ms", variant.text, interval));
    add_criteria(run(*mirror), row);
    const RunFigures signal = run(*gateway);
    row.signal = measure(signal.edges, sim::Duration::from_ps(interval * 1'000'000'000LL), signal.begin, signal.end);
    const RunFigures rare = run(*reaction, commanding_application);
    row.reaction = reactions(rare.commands, rare.edges, rare.begin, rare.end);
    made_.improvements.push_back(row);
    return true;
  }

 private:
  std::unique_ptr<scenario::Resolved> changed(const char* of, const Variant& variant, int interval, bool is_reaction) {
    const auto base =
        scenario::load_file(fmt::format("{}/{}-{}ms.json", options_.scenarios, of, interval), {}, diagnostics_);
    if (!base) return nullptr;
    scenario::Scenario scenario = base->scenario;
    scenario.name = fmt::format("{}-{}ms-{}", is_reaction ? "reaction" : of, interval, variant.name);
    if (variant.real_time) use_real_time_linux(scenario);
    if (variant.tsn) use_tsn(scenario);
    if (is_reaction) command_rarely(scenario);
    made_.scenarios.emplace_back(scenario.name, json::encode(scenario));
    return scenario::resolve(scenario, diagnostics_);
  }

  static void add_criteria(const RunFigures& figures, ImprovementRow& row) {
    row.least_success = 100;
    for (const PublishedTable& table : tables) {
      const double success = thread_of(figures, table).success;
      row.success += success / static_cast<double>(tables.size());
      row.least_success = std::min(row.least_success, success);
    }
    row.least_buffered = 100;
    for (const Receiver& receiver : receivers) {
      const double buffered = thread_of(figures, receiver).buffered;
      row.buffered += buffered / static_cast<double>(receivers.size());
      row.least_buffered = std::min(row.least_buffered, buffered);
    }
  }

  const Options& options_;
  Reproduction& made_;
  json::Diagnostics& diagnostics_;
};

}  // namespace

bool improve(const Options& options, Reproduction& made, json::Diagnostics& diagnostics) {
  Improver improver(options, made, diagnostics);
  for (const int interval : intervals) {
    if (options.is_short && interval != 10 && interval != 1) continue;
    for (const Variant& variant : variants)
      if (!improver.row(variant, interval)) return false;
  }
  return true;
}

}  // namespace takt::papers::coexistence
