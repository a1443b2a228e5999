// SPDX-License-Identifier: Apache-2.0
// Properties of scenarios, for GoogleTest and RapidCheck (link rapidcheck and takt_property):
//
//   TEST(Cell, HaltsWhateverIsLost) {
//     EXPECT_TRUE(takt::property::holds("scenarios/robot-arm.json", {.highest_loss = 0.1},
//                                       [](const takt::property::Outcome& run) { return run.reacted_within("halt",
//                                       3_ms); }));
//   }
//
// "For all losses up to 10 % and all phases: halted within 3 ms." What refutes a property is shrunk to a minimal
// schedule of faults, and written as a scenario that `takt run` replays. RC_PARAMS="max_success=10000" tries harder, as
// always with RapidCheck.
#pragma once

#include <rapidcheck.h>

#include <cstdlib>
#include <functional>
#include <iostream>
#include <string>

#include "output/result_folder.hpp"
#include "property/trial.hpp"
#include "scenario/resolve.hpp"

namespace takt::property {

/// For RapidCheck's report.
inline void showValue(const Trouble& trouble, std::ostream& out) {
  constexpr const char* names[] = {"loss on link ", "outage of link ", "crash of host "};
  out << names[static_cast<std::size_t>(trouble.kind)] << trouble.where << ", size " << trouble.size << "/1000, at "
      << trouble.when << "/1000 of the run";
}

using Property = std::function<bool(const Outcome&)>;

namespace detail {

inline rc::Gen<Trouble> trouble(const Space& space) {
  std::vector<Trouble::Kind> kinds;
  if (space.highest_loss > 0) kinds.push_back(Trouble::Kind::loss);
  if (space.link_downs) kinds.push_back(Trouble::Kind::link_down);
  if (space.crashes) kinds.push_back(Trouble::Kind::crash);
  // Without resize() the ranges would be empty in the first, small trials.
  const auto below = [](std::uint32_t end) {
    return rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::uint32_t>(0, end));
  };
  return rc::gen::build<Trouble>(rc::gen::set(&Trouble::kind, rc::gen::elementOf(kinds)),
                                 rc::gen::set(&Trouble::where, below(64)), rc::gen::set(&Trouble::when, below(1000)),
                                 rc::gen::set(&Trouble::size, below(1000)));
}

inline Trial draw(const Space& space) {
  Trial trial;
  const bool has_troubles = space.highest_loss > 0 || space.link_downs || space.crashes;
  if (has_troubles) {
    trial.troubles =
        *rc::gen::suchThat(rc::gen::container<std::vector<Trouble>>(trouble(space)),
                           [&](const std::vector<Trouble>& all) { return all.size() <= space.most_troubles; });
  }
  if (space.phases)
    trial.phases = *rc::gen::container<std::vector<std::uint32_t>>(
        8, rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::uint32_t>(0, 1000)));
  trial.seed = *rc::gen::inRange<std::uint32_t>(0, 1000);
  return trial;
}

/// Where a refutation is written: TAKT_PROPERTY_OUT, or the present folder.
inline std::string file_of(const std::string& name) {
  const char* const folder = std::getenv("TAKT_PROPERTY_OUT");
  return std::string(folder != nullptr ? folder : ".") + "/refuted-" + name + ".json";
}

}  // namespace detail

/// Whether the property holds for all trials that were drawn (100, unless RC_PARAMS says otherwise). If not, the
/// smallest trial that was found is in the file that is printed.
inline bool holds(const std::string& scenario_file, const Space& space, const Property& property) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_file(scenario_file, {}, diagnostics);
  if (!resolved) {
    std::cerr << diagnostics.to_text();
    return false;
  }
  const std::string file = detail::file_of(resolved->scenario.name);
  return rc::check("a property of " + resolved->scenario.name, [&] {
    const scenario::Scenario trial = scenario_of(*resolved, space, detail::draw(space));
    if (property(run(trial))) return;
    // Shrinking goes on from what fails only, so what is written last is the smallest.
    const std::string problem = output::write_file(file, json::encode(trial));
    RC_FAIL(problem.empty() ? "refuted, see takt run " + file : "refuted, and " + problem);
  });
}

}  // namespace takt::property
