// SPDX-License-Identifier: Apache-2.0
#include "emulate/log_reader.hpp"

#include <algorithm>
#include <array>

#include "json/document.hpp"

namespace takt::emulate {
namespace {

using handshake::PublishedState;

std::string text_of(const json::Node& object, std::string_view key) {
  const json::Node* const node = object.find(key);
  return node == nullptr ? std::string() : node->text;
}

template <class Integer>
Integer number_of(const json::Node& object, std::string_view key) {
  const json::Node* const node = object.find(key);
  return node == nullptr ? Integer{0} : static_cast<Integer>(json::integer_of(*node).value_or(0));
}

std::optional<handshake::IntentKind> intent_from(std::string_view name) {
  for (std::size_t i = 0; i < handshake::intent_kind_count; ++i)
    if (const auto kind = static_cast<handshake::IntentKind>(i); handshake::name_of(kind) == name) return kind;
  return std::nullopt;
}

/// From 0.
std::optional<std::uint8_t> role_from(const scenario::ResolvedProgram& program, const std::string& name) {
  const auto found = std::find(program.participant_names.begin(), program.participant_names.end(), name);
  if (!program.has_roles() || found == program.participant_names.end() || found == program.participant_names.begin())
    return std::nullopt;
  return static_cast<std::uint8_t>(found - program.participant_names.begin() - 1);
}

}  // namespace

std::optional<PublishedState> published_state_from(std::string_view name) {
  const auto& names = handshake::published_state_names;
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end()
             ? std::nullopt
             : std::optional(handshake::published_state_at(static_cast<std::size_t>(found - names.begin())));
}

LogReader::LogReader(const scenario::Resolved& resolved, const PlannedNode& node) : resolved_(resolved) {
  for (const PlannedNode::Part& part : node.parts) parts_.push_back({resolved.programs[part.program].name, part});
}

bool LogReader::take(const std::string& line) {
  json::Diagnostics diagnostics;
  const auto document = json::parse(line, "log", diagnostics);
  if (!document) return true;
  const json::Node& event = document->root();
  const std::string kind = text_of(event, "event");
  if (event.find("time_ns") != nullptr) time_ = number_of<std::int64_t>(event, "time_ns");
  if (kind == "end") status_ = line;
  if (kind == "start") {
    if (has_started_) crash();
    has_started_ = true;
  }
  constexpr std::array<std::string_view, 6> kinds = {"transition", "intent",     "run",
                                                     "bound",      "role taken", "role dropped"};
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) return true;
  const std::string program = text_of(event, "program");
  const auto part = std::find_if(parts_.begin(), parts_.end(),
                                 [&](const Part& each) { return program.empty() || each.program == program; });
  if (part == parts_.end()) return false;
  if (kind == "bound") return read_binding(*part, event);
  if (kind.starts_with("role")) return read_role(*part, kind, event);
  if (part->part.candidate && !part->role) return false;
  LoggedStep step;
  step.time = time_;
  step.program = part->part.program;
  step.participant = part->role ? static_cast<std::uint8_t>(*part->role + 1) : part->part.participant;
  step.self = self_of(*part);
  step.run = number_of<std::uint32_t>(event, "run");
  step.intent_run = number_of<std::uint32_t>(event, "intent_run");
  if (kind == "intent" && !(step.raised = intent_from(text_of(event, "kind")))) return false;
  if (kind == "transition") {
    const auto from = published_state_from(text_of(event, "from"));
    const auto to = published_state_from(text_of(event, "to"));
    if (!from || !to || event.find("number") == nullptr) return false;
    step.change = handshake::StateChange{number_of<std::uint8_t>(event, "number"), *from, *to};
    part->state = *to;
  }
  steps_.push_back(step);
  return true;
}

bool LogReader::read_binding(const Part& part, const json::Node& event) {
  const scenario::ResolvedProgram& program = resolved_.programs[part.part.program];
  const auto role = role_from(program, text_of(event, "role"));
  if (!role) return false;
  LoggedStep step;
  step.time = time_;
  step.program = part.part.program;
  step.participant = static_cast<std::uint8_t>(*role + 1);
  step.bound = handshake::Binding();
  const std::string node = text_of(event, "to");
  for (std::size_t c = 0; c < program.candidates().size(); ++c)
    if (resolved_.topology.nodes[program.candidates()[c].node.value].name == node)
      step.bound = {static_cast<std::uint8_t>(c), number_of<std::uint32_t>(event, "life")};
  steps_.push_back(step);
  return step.bound->bound() == !node.empty();
}

bool LogReader::read_role(Part& part, std::string_view kind, const json::Node& event) {
  gone(part);
  if (kind == "role dropped") return true;
  part.role = role_from(resolved_.programs[part.part.program], text_of(event, "role"));
  part.life = number_of<std::uint32_t>(event, "life");
  return part.role.has_value();
}

std::optional<handshake::Binding> LogReader::self_of(const Part& part) const {
  return part.part.candidate ? std::optional(handshake::Binding{*part.part.candidate, part.life}) : std::nullopt;
}

void LogReader::crash() {
  for (Part& part : parts_) gone(part);
}

/// Its participant is no more. A candidate without a role has none.
void LogReader::gone(Part& part) {
  if (part.part.candidate && !part.role) return;
  LoggedStep step;
  step.time = time_;
  step.program = part.part.program;
  step.participant = part.role ? static_cast<std::uint8_t>(*part.role + 1) : part.part.participant;
  step.self = self_of(part);
  step.is_crash = true;
  if (part.state != PublishedState::Halted) step.change = handshake::StateChange{0, part.state, PublishedState::Halted};
  part.state = PublishedState::Halted;
  part.role.reset();
  steps_.push_back(step);
}

std::vector<LoggedStep> LogReader::finish() {
  if (status_.empty()) crash();
  return std::move(steps_);
}

std::vector<History> histories_of(const std::vector<LoggedStep>& steps, std::size_t programs) {
  std::vector<History> histories(programs);
  for (const LoggedStep& step : steps)
    if (step.change) histories[step.program].changes.push_back({step.time, step.participant, *step.change});
  return histories;
}

}  // namespace takt::emulate
