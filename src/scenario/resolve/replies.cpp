#include "scenario/resolve/replies.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "scenario/json/suggest.hpp"
#include "scenario/resolve/os_profiles.hpp"

namespace takt::scenario {
namespace {

class Replies {
 public:
  Replies(ResolvedProgram& program, json::Diagnostics& diagnostics) : program_(program), diagnostics_(diagnostics) {}

  void run() {
    for (const Reply& reply : program_.description->replies) add(reply);
    std::set<std::uint8_t> answers;
    for (std::size_t i = 0; i < program_.replies.size(); ++i) {
      const Reply& reply = program_.description->replies[i];
      if (!answers.insert(program_.replies[i].with).second)
        diagnostics_.error(reply.where.at("with"), "a reply to two things", {json::quote(reply.with), "each reply for one data set"});
    }
    for (std::size_t i = 0; i < program_.replies.size(); ++i)
      if (answers.contains(program_.replies[i].to))
        diagnostics_.error(program_.description->replies[i].where.at("to"), "a reply to a reply",
                           {json::quote(program_.description->replies[i].to) + " is a reply itself", "process data that is published every cycle"});
  }

 private:
  std::optional<std::uint8_t> data_set(const std::string& name, const json::Place& place) {
    std::vector<std::string_view> names;
    for (std::size_t d = 0; d < program_.process_data.size(); ++d) {
      if (program_.process_data[d].name == name) return static_cast<std::uint8_t>(d);
      names.push_back(program_.process_data[d].name);
    }
    diagnostics_.error(place, "unknown process data", {json::quote(name), "process data of " + json::quote(program_.name), json::suggest(name, names)});
    return std::nullopt;
  }

  void add(const Reply& reply) {
    const auto to = data_set(reply.to, reply.where.at("to"));
    const auto with = data_set(reply.with, reply.where.at("with"));
    // A stand-in keeps replies and descriptions side by side; nothing runs after an error.
    const ResolvedReply made{to.value_or(0), with.value_or(0)};
    program_.replies.push_back(made);
    if (!to || !with) return;
    const std::uint8_t asker = program_.process_data[made.to].from;
    const std::uint8_t replier = program_.process_data[made.with].from;
    if (asker == replier)
      diagnostics_.error(reply.where.at("with"), "a reply to oneself", {json::quote(reply.with) + " comes from where " + json::quote(reply.to) + " comes from",
                                                                        "process data of another participant"});
    else if (asker != 0 && replier != 0 && program_.description->subscription == Subscription::star)
      diagnostics_.error(reply.where.at("with"), "a reply to somebody who is not heard", {"two slaves in a star", "the master on one side, or \"subscription\": \"all-to-all\""});
  }

  ResolvedProgram& program_;
  json::Diagnostics& diagnostics_;
};

ResolvedProcessing processing_of(const HostNode& host, json::Diagnostics& diagnostics) {
  ResolvedProcessing made;
  if (host.processing && host.processing->per_message) made.per_message = distribution_of(*host.processing->per_message, diagnostics);
  if (host.processing && host.processing->per_field) made.per_field = distribution_of(*host.processing->per_field, diagnostics);
  return made;
}

}  // namespace

void check_processing(const Topology& topology, json::Diagnostics& diagnostics) {
  for (const TopologyNode& node : topology.nodes)
    if (const auto* const host = std::get_if<HostNode>(&node.description)) processing_of(*host, diagnostics);
}

void resolve_replies(const Topology& topology, ResolvedProgram& program, json::Diagnostics& diagnostics) {
  if (program.description->replies.empty()) return;
  if (program.process_data.size() != program.description->process_data.size()) return;  // one was refused: numbers would not fit
  Replies(program, diagnostics).run();
  json::Diagnostics reported;   // by check_processing
  for (const models::NodeIndex node : program.participants)
    program.processing.push_back(processing_of(std::get<HostNode>(topology.nodes[node.value].description), reported));
}

}  // namespace takt::scenario
