// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/known_names.hpp"

#include <algorithm>

namespace takt::scenario {

StreamNames::StreamNames(const Resolved& r, const json::Diagnostics& diagnostics) {
  for (const models::StreamPlan& stream : r.plan.streams) names_.insert(stream.name);
  if (!diagnostics.has_errors()) return;
  const Scenario& scenario = r.scenario;
  const auto place = [&](std::string_view list) { return scenario.where.at(list); };
  for (const Stream& stream : scenario.streams) names_.insert(stream.name);
  has_all_streams_ = are_all_named(scenario.streams, place("streams"), diagnostics);
  for (const Program& program : scenario.programs)
    if (std::none_of(r.programs.begin(), r.programs.end(),
                     [&](const ResolvedProgram& other) { return other.name == program.name; })) {
      add_program(program);
      // The right name of a participant whose name is wrong is that of a node.
      if (diagnostics.is_refused(program.where.at("master")) || diagnostics.is_refused(program.where.at("slaves")))
        for (const TopologyNode& node : r.topology.nodes) names_.insert(program.name + "/state/" + node.name);
    }
  for (const Program& program : scenario.programs)
    if (!are_all_named(program.process_data, program.where.at("process_data"), diagnostics))
      owners_.insert(program.name);
  has_all_owners_ = !may_be_unread_program(scenario, diagnostics);
  for (const std::string_view list : {"topics", "domains", "applications", "gateways", "persistence"})
    if (diagnostics.is_refused(place(list))) has_all_owners_ = false;
}

void StreamNames::add_program(const Program& program) {
  // Of roles it is not known who may have them; names that are "" could not be read.
  const bool is_unclear = !program.roles.empty() || program.master.empty() || program.slaves.empty() ||
                          std::find(program.slaves.begin(), program.slaves.end(), "") != program.slaves.end() ||
                          std::any_of(program.process_data.begin(), program.process_data.end(),
                                      [](const ProcessData& data) { return data.name.empty(); });
  if (is_unclear) {
    owners_.insert(program.name);
    return;
  }
  names_.insert(program.name + "/state/" + program.master);
  for (const std::string& slave : program.slaves) names_.insert(program.name + "/state/" + slave);
  for (const ProcessData& data : program.process_data) names_.insert(program.name + "/" + data.name);
}

bool StreamNames::may_be(std::string_view name) const {
  if (names_.contains(name)) return true;
  const std::size_t slash = name.find('/');
  if (slash == std::string_view::npos) return !has_all_streams_;
  return !has_all_owners_ || owners_.contains(name.substr(0, slash));
}

bool may_be_unread_program(const Scenario& scenario, const json::Diagnostics& diagnostics) {
  return !are_all_named(scenario.programs, scenario.where.at("programs"), diagnostics);
}

}  // namespace takt::scenario
