// SPDX-License-Identifier: Apache-2.0
#include "node/server/describe_programs.hpp"

#include <algorithm>

namespace takt::node {
namespace {

/// Participants by number: the master, then slaves or roles.
std::vector<std::string> participants_of(const Program& program) {
  std::vector<std::string> names = {program.master};
  for (const Role& role : program.roles) names.push_back(role.name);
  if (program.roles.empty()) names.insert(names.end(), program.slaves.begin(), program.slaves.end());
  return names;
}

opcua::ProgramDescription describe_one(const std::string& node, const LoadedProgram& loaded) {
  const Program& program = loaded.program;
  opcua::ProgramDescription made;
  made.name = program.name;
  made.handshake = program.variant == Variant::robust ? "robust" : "paper";
  made.own = node;
  made.role = program.master == node ? "master" : program.roles.empty() ? "slave" : "candidate";
  made.master = program.master;
  made.participants = participants_of(program);
  const bool hears_all = program.master == node || program.subscription == Subscription::all_to_all;
  // A candidate's number comes with its role; in a star it hears the master, whatever its role is.
  if (!hears_all)
    made.peers = {program.master};
  else if (made.role != "candidate")
    std::copy_if(made.participants.begin(), made.participants.end(), std::back_inserter(made.peers),
                 [&](const std::string& each) { return each != node; });
  made.cycle_ms = static_cast<double>(program.cycle.ps()) / 1e9;
  return made;
}

}  // namespace

std::vector<opcua::ProgramDescription> describe_programs(const LoadedConfig& loaded) {
  std::vector<opcua::ProgramDescription> all;
  for (const LoadedProgram& each : loaded.programs) all.push_back(describe_one(loaded.config.node, each));
  return all;
}

}  // namespace takt::node
