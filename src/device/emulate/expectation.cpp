// SPDX-License-Identifier: Apache-2.0
#include "emulate/expectation.hpp"

#include <algorithm>

#include "emulate/log_reader.hpp"
#include "emulate/node_status.hpp"
#include "json/document.hpp"
#include "scenario/run/run.hpp"

namespace takt::emulate {
namespace {

constexpr std::int64_t settled_cycles = 10;

const std::string& name_of(const scenario::Resolved& resolved, std::uint32_t program, std::size_t candidate) {
  return resolved.topology.nodes[resolved.programs[program].candidates()[candidate].node.value].name;
}

GroupState state_of(const scenario::Run& run, std::uint32_t program) {
  const handshake::Binder& binder = run.binder(program);
  GroupState state;
  state.states.push_back(run.state(program, 0));
  for (std::size_t role = 0; role < binder.roles(); ++role) {
    const handshake::Binding& binding = run.roles(program)->binding(role);
    state.states.push_back(run.state(program, role + 1));
    state.nodes.push_back(binding.bound() ? name_of(run.resolved(), program, binding.candidate) : std::string());
  }
  for (std::uint8_t c = 0; c < binder.candidates(); ++c) state.present.push_back(binder.present(c));
  return state;
}

/// Goes to just before `at`; says what each group with roles is in then, unless it has just got there.
std::vector<std::optional<GroupState>> settled_before(scenario::Run& run, sim::TrueTime at) {
  const std::vector<scenario::ResolvedProgram>& programs = run.resolved().programs;
  std::vector<std::optional<GroupState>> states(programs.size());
  std::vector<std::uint64_t> changes(programs.size());
  sim::Duration longest;
  for (const scenario::ResolvedProgram& program : programs)
    if (program.has_roles()) longest = std::max(longest, program.description->cycle * settled_cycles);
  const sim::Duration step = sim::Duration::from_ps(1);
  const sim::TrueTime last = std::max(run.simulation().now(), at - step);
  run.simulation().run(std::max(run.simulation().now(), last - longest));
  for (std::uint32_t p = 0; p < programs.size(); ++p) {
    if (!programs[p].has_roles()) continue;
    states[p] = state_of(run, p);
    changes[p] = run.monitor(p).changes();
  }
  run.simulation().run(last);
  for (std::uint32_t p = 0; p < programs.size(); ++p)
    if (states[p] && (*states[p] != state_of(run, p) || changes[p] != run.monitor(p).changes())) states[p].reset();
  return states;
}

std::vector<std::uint8_t> order_of(const scenario::Run& run, std::uint32_t program) {
  std::vector<std::uint8_t> order;
  const auto add = [&](std::uint8_t candidate) {
    if (std::find(order.begin(), order.end(), candidate) == order.end()) order.push_back(candidate);
  };
  for (const scenario::BindingRecord& record : run.roles(program)->history())
    if (record.candidate) add(*record.candidate);
  for (std::size_t c = 0; c < run.resolved().programs[program].candidates().size(); ++c)
    add(static_cast<std::uint8_t>(c));
  return order;
}

const json::Node* items_of(const json::Node& object, std::string_view key, std::size_t count) {
  const json::Node* const node = object.find(key);
  return node == nullptr || node->items.size() != count ? nullptr : node;
}

}  // namespace

std::optional<Expectation> expectation_of(const scenario::Resolved& resolved, const Plan& plan) {
  if (std::none_of(resolved.programs.begin(), resolved.programs.end(),
                   [](const scenario::ResolvedProgram& program) { return program.has_roles(); }))
    return std::nullopt;
  scenario::Run run(resolved);
  Expectation expectation;
  for (const Action& action : plan.actions)
    expectation.before.push_back(settled_before(run, sim::TrueTime() + action.at));
  expectation.before.push_back(settled_before(run, run.end()));
  for (std::uint32_t p = 0; p < resolved.programs.size(); ++p)
    expectation.order.push_back(resolved.programs[p].has_roles() ? order_of(run, p) : std::vector<std::uint8_t>());
  return expectation;
}

History history_of(const scenario::ProgramMonitor& monitor) {
  History history;
  for (const scenario::StateRecord& record : monitor.history())
    history.changes.push_back({record.time.ps(), record.participant, record.change});
  for (const scenario::CallRecord& call : monitor.calls())
    if (program::is_good(call.status)) history.calls.push_back({call.time.ps(), call.participant, call.method});
  return history;
}

std::optional<GroupState> group_of_status(const std::string& status, const scenario::ResolvedProgram& program) {
  json::Diagnostics diagnostics;
  const auto document = json::parse(status, "status", diagnostics);
  if (!document) return std::nullopt;
  const json::Node* master = &document->root();  // of a nested Program beside the one outside
  for_each_program(document->root(), [&](const json::Node& each) {
    master = emulate::text_of(each, "program") == program.name ? &each : master;
  });
  const json::Node* const roles = items_of(*master, "roles", program.description->roles.size());
  const json::Node* const candidates = items_of(*master, "candidates", program.candidates().size());
  const auto own = published_state_from(emulate::text_of(*master, "state"));
  if (roles == nullptr || candidates == nullptr || !own) return std::nullopt;
  GroupState state;
  state.states.assign(roles->items.size() + 1, handshake::PublishedState::Halted);
  state.states[0] = *own;
  for (const json::Node& role : roles->items)
    state.nodes.push_back(role.find("node") == nullptr ? std::string() : role.find("node")->text);
  for (const json::Node& candidate : candidates->items)
    state.present.push_back(candidate.find("present") != nullptr && candidate.find("present")->boolean);
  return state;
}

std::optional<handshake::PublishedState> state_of_status(const std::string& status) {
  json::Diagnostics diagnostics;
  const auto document = json::parse(status, "status", diagnostics);
  const json::Node* const state = document ? document->root().find("state") : nullptr;
  return state == nullptr ? std::nullopt : published_state_from(state->text);
}

std::string difference(const GroupState& expected, const GroupState& found, const scenario::Resolved& resolved,
                       std::uint32_t program) {
  const scenario::ResolvedProgram& group = resolved.programs[program];
  const auto node = [](const std::string& name) { return name.empty() ? std::string("nobody") : name; };
  for (std::size_t role = 0; role < expected.nodes.size(); ++role)
    if (expected.nodes[role] != found.nodes[role])
      return "role " + group.participant_names[role + 1] + " has " + node(found.nodes[role]) + ", simulated " +
             node(expected.nodes[role]);
  for (std::size_t c = 0; c < expected.present.size(); ++c)
    if (expected.present[c] != found.present[c])
      return name_of(resolved, program, c) +
             (found.present[c] ? " is there, simulated not" : " is not there, simulated it is");
  for (std::size_t p = 0; p < expected.states.size(); ++p)
    if (expected.states[p] != found.states[p])
      return group.participant_names[p] + " is " + std::string(handshake::name_of(found.states[p])) + ", simulated " +
             std::string(handshake::name_of(expected.states[p]));
  return {};
}

}  // namespace takt::emulate
