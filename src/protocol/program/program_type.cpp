// SPDX-License-Identifier: Apache-2.0
#include "program/program_type.hpp"

#include <algorithm>

namespace takt::program {
namespace {

Outcome unknown() {
  Outcome outcome;
  outcome.status = StatusCode::BadNodeIdUnknown;
  return outcome;
}

}  // namespace

Program* ProgramType::find(const std::string& name) {
  for (const auto& each : instances_)
    if (each->name() == name) return each.get();
  return nullptr;
}

StatusCode ProgramType::create(ProgramSettings settings, const Program::Creator& creator, sim::LocalTime now) {
  if (!creatable_) return StatusCode::BadNotExecutable;
  if (settings.name.empty() || find(settings.name) != nullptr) return StatusCode::BadInvalidArgument;
  if (max_instance_count_ >= 0 && instance_count() >= static_cast<std::uint32_t>(max_instance_count_))
    return StatusCode::BadResourceUnavailable;
  instances_.push_back(std::make_unique<Program>(std::move(settings), creator, now));
  return StatusCode::Good;
}

StatusCode ProgramType::remove(const std::string& name) {
  const Program* const program = find(name);
  if (program == nullptr) return StatusCode::BadNodeIdUnknown;
  if (!program->settings().deletable) return StatusCode::BadUserAccessDenied;
  if (program->state() != State::Halted) return StatusCode::BadInvalidState;
  std::erase_if(instances_, [&](const auto& each) { return each.get() == program; });
  return StatusCode::Good;
}

Outcome ProgramType::call(const std::string& name, const Call& call, sim::LocalTime now) {
  Program* const program = find(name);
  return program == nullptr ? unknown() : settled(name, program->call(call, now));
}

Outcome ProgramType::advance(const std::string& name, std::uint32_t transition_number, sim::LocalTime now,
                             std::vector<NamedValue> result) {
  Program* const program = find(name);
  return program == nullptr ? unknown() : settled(name, program->advance(transition_number, now, std::move(result)));
}

Outcome ProgramType::settled(const std::string& name, Outcome outcome) {
  if (outcome.deleted) std::erase_if(instances_, [&](const auto& each) { return each->name() == name; });
  return outcome;
}

}  // namespace takt::program
