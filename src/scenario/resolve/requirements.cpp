#include "scenario/resolve/requirements.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "scenario/applications/resolve_applications.hpp"
#include "scenario/figures/requirement.hpp"
#include "scenario/json/quantity.hpp"
#include "scenario/json/suggest.hpp"

namespace takt::scenario {
namespace {

using sim::Duration;

class Requirements {
 public:
  Requirements(const Resolved& resolved, json::Diagnostics& diagnostics) : r_(resolved), diagnostics_(diagnostics) {
    for (const models::StreamPlan& stream : r_.plan.streams) stream_names_.insert(stream.name);
  }

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
    if (requirement.after && *requirement.after > r_.scenario.duration)
      diagnostics_.warning(requirement.where.at("after"), "nothing begins so late", {json::to_text(*requirement.after), "at most the duration, " + json::to_text(r_.scenario.duration)});
    if (requirement.reaction) {
      if (!requirement.within) diagnostics_.error(requirement.where.place(), "missing key", {"\"reaction\" without a limit", "\"within\""});
      if (r_.scenario.programs.empty()) diagnostics_.error(requirement.where.at("reaction"), "a reaction without a program", {"no programs", "\"programs\""});
      refuse(requirement.latency.has_value(), "latency", "stream");
      refuse(requirement.jitter.has_value(), "jitter", "stream");
      refuse(requirement.dropped.has_value(), "dropped", "stream");
      refuse(requirement.delivered.has_value(), "delivered", "stream");
    }
    if (requirement.sync) {
      if (!r_.scenario.clocks.gptp) diagnostics_.error(requirement.where.at("sync"), "synchronisation without gPTP", {"no \"gptp\" in \"clocks\"", "\"gptp\""});
      if (requirement.node && !r_.topology.find(*requirement.node))
        diagnostics_.error(requirement.where.at("node"), "unknown node", {json::quote(*requirement.node), "the name of a node", suggest_node(r_.topology, *requirement.node, diagnostics_)});
      refuse(requirement.latency.has_value(), "latency", "stream");
      refuse(requirement.jitter.has_value(), "jitter", "stream");
      refuse(requirement.dropped.has_value(), "dropped", "stream");
      refuse(requirement.delivered.has_value(), "delivered", "stream");
      refuse(requirement.within.has_value(), "within", "reaction");
    } else {
      refuse(requirement.node.has_value(), "node", "sync");
    }
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
    if (stream_names_.contains(*requirement.stream) || is_of_broken_program(*requirement.stream)) return;
    const std::vector<std::string_view> names(stream_names_.begin(), stream_names_.end());
    diagnostics_.error(requirement.where.at("stream"), "unknown stream", {json::quote(*requirement.stream), "the name of a stream", json::suggest(*requirement.stream, names)});
  }

 private:
  /// A Program with a mistake has no streams: that is said where the mistake is, not again of each of its streams.
  bool is_of_broken_program(std::string_view stream) const {
    if (!diagnostics_.has_errors()) return false;
    return std::ranges::any_of(r_.scenario.programs, [&](const Program& program) {
      const std::string prefix = program.name + "/";
      return stream.starts_with(prefix) && std::ranges::none_of(stream_names_, [&](std::string_view name) { return name.starts_with(prefix); });
    });
  }

  const Resolved& r_;
  json::Diagnostics& diagnostics_;
  std::set<std::string_view> stream_names_;
};

}  // namespace

const Program* find_program(const Scenario& scenario, const std::string& name, const json::Place& place, json::Diagnostics& diagnostics) {
  std::vector<std::string_view> names;
  for (const Program& program : scenario.programs) {
    if (program.name == name) return &program;
    names.push_back(program.name);
  }
  diagnostics.error(place, "unknown program", {json::quote(name), "the name of a program", json::suggest(name, names)});
  return nullptr;
}

void resolve_requirements(const Resolved& resolved, json::Diagnostics& diagnostics) {
  Requirements requirements(resolved, diagnostics);
  if (resolved.scenario.warm_up > resolved.scenario.duration)
    diagnostics.warning(resolved.scenario.where.at("warm_up"), "nothing begins so late", {json::to_text(resolved.scenario.warm_up), "at most the duration, " + json::to_text(resolved.scenario.duration)});
  for (const Requirement& requirement : resolved.scenario.require) requirements.check(requirement);
}

}  // namespace takt::scenario
