#include "scenario/resolve/requirements.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "json/suggest.hpp"
#include "scenario/applications/resolve_applications.hpp"
#include "scenario/figures/requirement.hpp"
#include "scenario/resolve/known_names.hpp"

namespace takt::scenario {
namespace {

class Requirements {
 public:
  Requirements(const Resolved& resolved, json::Diagnostics& diagnostics) : r_(resolved), diagnostics_(diagnostics), streams_(resolved, diagnostics) {}

  void check(const Requirement& requirement) {
    if (requirement.program) find_program(r_.scenario, *requirement.program, requirement.where.at("program"), diagnostics_);
    if (!check_figure(r_, requirement, diagnostics_)) return;
    const auto refuse = [&](bool is_there, std::string_view key, std::string_view subject) {
      if (is_there) diagnostics_.error(requirement.where.at(key), "does not belong to this requirement", {json::quote(key), "a requirement with \"" + std::string(subject) + "\""});
    };
    for (const auto& [limit, key] : {std::pair(&requirement.latency, "latency"), std::pair(&requirement.jitter, "jitter")})
      if (*limit && (*limit)->within && !(*limit)->equal)
        diagnostics_.error((*limit)->where.at("within"), "does not belong to this limit", {"\"within\" without \"equal\"", "\"within\" beside \"equal\""});
    if (requirement.within && !requirement.within->time && !requirement.figure)
      diagnostics_.error(requirement.where.at("within"), "a time without a unit", {"a number", "a duration such as \"7ms\""});
    if (requirement.reaction) {
      if (!requirement.within) diagnostics_.error(requirement.where.place(), "missing key", {"\"reaction\" without a limit", "\"within\""});
      if (r_.scenario.programs.empty()) diagnostics_.error_unless(may_be_unread_program(r_.scenario, diagnostics_), requirement.where.at("reaction"), "a reaction without a program", {"no programs", "\"programs\""});
      refuse(requirement.latency.has_value(), "latency", "stream");
      refuse(requirement.jitter.has_value(), "jitter", "stream");
      refuse(requirement.dropped.has_value(), "dropped", "stream");
      refuse(requirement.delivered.has_value(), "delivered", "stream");
    }
    if (requirement.sync) {
      if (!r_.scenario.clocks.gptp) diagnostics_.error_unless(diagnostics_.is_refused(r_.scenario.where.at("clocks")), requirement.where.at("sync"), "synchronisation without gPTP", {"no \"gptp\" in \"clocks\"", "\"gptp\""});
      if (requirement.node && !r_.topology.find(*requirement.node))
        report_unknown_node(r_.topology, *requirement.node, requirement.where.at("node"), "the name of a node", diagnostics_);
      refuse(requirement.latency.has_value(), "latency", "stream");
      refuse(requirement.jitter.has_value(), "jitter", "stream");
      refuse(requirement.dropped.has_value(), "dropped", "stream");
      refuse(requirement.delivered.has_value(), "delivered", "stream");
      refuse(requirement.within.has_value(), "within", "reaction");
    } else {
      refuse(requirement.node.has_value(), "node", "sync");
    }
    refuse(!requirement.reaction && requirement.cause, "cause", "reaction");
    check_cause(requirement);
    const bool of_application = requirement.application.has_value();
    refuse(!of_application && requirement.thread, "thread", "application");
    refuse(!of_application && requirement.success, "success", "application");
    refuse(!of_application && requirement.buffered, "buffered", "application");
    refuse(!requirement.signal && requirement.irregular, "irregular", "signal");
    if (of_application || requirement.signal) {
      for (const auto& [present, key] : {std::pair(requirement.latency.has_value(), "latency"), std::pair(requirement.jitter.has_value(), "jitter"),
                                         std::pair(requirement.dropped.has_value(), "dropped"), std::pair(requirement.delivered.has_value(), "delivered")})
        refuse(present, key, "stream");
      refuse(requirement.within.has_value(), "within", "reaction");
      refuse(requirement.program.has_value(), "program", "reaction");
      check_application_requirement(r_, requirement, diagnostics_);
    }
    if (!requirement.stream) return;
    refuse(requirement.within.has_value(), "within", "reaction");
    refuse(requirement.program.has_value(), "program", "reaction");
    if (!requirement.latency && !requirement.jitter && !requirement.dropped && !requirement.delivered)
      diagnostics_.error(requirement.where.place(), "missing key", {"\"stream\" without a limit", "\"latency\", \"jitter\", \"dropped\" or \"delivered\""});
    if (!streams_.may_be(*requirement.stream))
      diagnostics_.error(requirement.where.at("stream"), "unknown stream", {json::quote(*requirement.stream), "the name of a stream", json::suggest(*requirement.stream, streams_.all())});
  }

 private:
  /// A cause that cannot be: a limit that nothing can ever fail is no requirement.
  void check_cause(const Requirement& requirement) {
    using handshake::Cause;
    if (!requirement.reaction || !requirement.cause || *requirement.cause == Cause::command || *requirement.reaction == Reaction::halt || diagnostics_.is_refused(requirement.where.at("reaction"))) return;
    const auto goes_on = [&](const Program& program) { return program.on_replacement == OnReplacement::restart || diagnostics_.is_refused(program.where.at("on_replacement")); };
    const bool may_go_on = *requirement.reaction == Reaction::start && (std::ranges::any_of(r_.scenario.programs, goes_on) || !are_all_named(r_.scenario.programs, r_.scenario.where.at("programs"), diagnostics_));
    if (!may_go_on && *requirement.cause != Cause::nested)
      diagnostics_.error(requirement.where.at("cause"), "a reaction that has no such cause", {json::quote(spelling(*requirement.reaction)) + " because of a " + json::quote(spelling(*requirement.cause)),
                         "\"halt\", or \"start\" of a program with \"on_replacement\": \"restart\""});
  }

  const Resolved& r_;
  json::Diagnostics& diagnostics_;
  StreamNames streams_;
};

}  // namespace

const Program* find_program(const Scenario& scenario, const std::string& name, const json::Place& place, json::Diagnostics& diagnostics) {
  std::vector<std::string_view> names;
  for (const Program& program : scenario.programs) {
    if (program.name == name) return &program;
    names.push_back(program.name);
  }
  diagnostics.error_unless(may_be_unread_program(scenario, diagnostics), place, "unknown program", {json::quote(name), "the name of a program", json::suggest(name, names)});
  return nullptr;
}

void resolve_requirements(const Resolved& resolved, json::Diagnostics& diagnostics) {
  Requirements requirements(resolved, diagnostics);
  for (const Requirement& requirement : resolved.scenario.require)
    if (requirement.where.is_known() || !diagnostics.has_errors()) requirements.check(requirement);
}

}  // namespace takt::scenario
