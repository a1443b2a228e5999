// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/replies.hpp"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "json/suggest.hpp"
#include "scenario/resolve/known_names.hpp"
#include "scenario/resolve/os_profiles.hpp"

namespace takt::scenario {
namespace {

class Replies {
 public:
  Replies(const Program& program, json::Diagnostics& diagnostics) : program_(program), diagnostics_(diagnostics) {}

  /// The numbers of the data sets; a stand-in for what is refused, since nothing runs after an error.
  std::vector<ResolvedReply> run() {
    for (const Reply& reply : program_.replies) add(reply);
    std::set<std::string_view> answers;
    for (const Reply& reply : program_.replies)
      if (!reply.with.empty() && !answers.insert(reply.with).second)
        diagnostics_.error(reply.where.at("with"), "a reply to two things",
                           {json::quote(reply.with), "each reply for one data set"});
    for (const Reply& reply : program_.replies)
      if (!reply.to.empty() && answers.contains(reply.to))
        diagnostics_.error(
            reply.where.at("to"), "a reply to a reply",
            {json::quote(reply.to) + " is a reply itself", "process data that is published every cycle"});
    return std::move(made_);
  }

 private:
  std::optional<std::uint8_t> data_set(const std::string& name, const json::Place& place) {
    std::vector<std::string_view> names;
    for (std::size_t d = 0; d < program_.process_data.size(); ++d) {
      if (program_.process_data[d].name == name) return static_cast<std::uint8_t>(d);
      names.push_back(program_.process_data[d].name);
    }
    diagnostics_.error_unless(
        !are_all_named(program_.process_data, program_.where.at("process_data"), diagnostics_), place,
        "unknown process data",
        {json::quote(name), "process data of " + json::quote(program_.name), json::suggest(name, names)});
    return std::nullopt;
  }

  void add(const Reply& reply) {
    if (!reply.where.is_known() && diagnostics_.has_errors()) return;
    const auto to = data_set(reply.to, reply.where.at("to"));
    const auto with = data_set(reply.with, reply.where.at("with"));
    made_.push_back({to.value_or(0), with.value_or(0)});
    if (!to || !with) return;
    const ProcessData& asked = program_.process_data[*to];
    const ProcessData& answer = program_.process_data[*with];
    if (diagnostics_.is_refused(asked.where.at("from")) || diagnostics_.is_refused(answer.where.at("from"))) return;
    if (asked.from == answer.from)
      diagnostics_.error(reply.where.at("with"), "a reply to oneself",
                         {json::quote(reply.with) + " comes from where " + json::quote(reply.to) + " comes from",
                          "process data of another participant"});
    else if (asked.from != program_.master && answer.from != program_.master &&
             program_.subscription == Subscription::star && !diagnostics_.is_refused(program_.where.at("master")) &&
             !diagnostics_.is_refused(program_.where.at("subscription")))
      diagnostics_.error(reply.where.at("with"), "a reply to somebody who is not heard",
                         {"two slaves in a star", "the master on one side, or \"subscription\": \"all-to-all\""});
  }

  const Program& program_;
  json::Diagnostics& diagnostics_;
  std::vector<ResolvedReply> made_;
};

ResolvedProcessing processing_of(const EndStation& host, json::Diagnostics& diagnostics) {
  ResolvedProcessing made;
  if (host.processing && host.processing->per_message)
    made.per_message = distribution_of(*host.processing->per_message, diagnostics);
  if (host.processing && host.processing->per_field)
    made.per_field = distribution_of(*host.processing->per_field, diagnostics);
  return made;
}

}  // namespace

void check_processing(const Topology& topology, json::Diagnostics& diagnostics) {
  for (const TopologyNode& node : topology.nodes)
    if (const EndStation* const host = end_station_of(node.description)) processing_of(*host, diagnostics);
}

void check_replies(const Program& program, json::Diagnostics& diagnostics) { Replies(program, diagnostics).run(); }

void resolve_replies(const Topology& topology, ResolvedProgram& program) {
  if (program.description->replies.empty()) return;
  json::Diagnostics reported;  // by check_replies and check_processing
  program.replies = Replies(*program.description, reported).run();
  for (const ResolvedMember& each : program.members)
    program.processing.push_back(processing_of(*end_station_of(topology.nodes[each.node.value].description), reported));
}

}  // namespace takt::scenario
