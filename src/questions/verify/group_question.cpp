// SPDX-License-Identifier: Apache-2.0
#include "verify/group_question.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "explore/model/recording.hpp"
#include "json/node.hpp"
#include "scenario/resolved/resolved.hpp"
#include "verify/roles_query.hpp"

namespace takt::verify {
namespace {

/// Numbers and words that no exploration takes; empty if there are none.
std::string out_of_range(const GroupQuestion& question) {
  const auto between = [](const char* what, std::uint64_t found, std::uint64_t least, std::uint64_t most) {
    return found >= least && found <= most ? std::string()
                                           : fmt::format("{}: found {}, expected {} to {}", what, found, least, most);
  };
  const auto one_of = [](const char* what, const std::string& found, std::initializer_list<std::string_view> choices) {
    return std::ranges::find(choices, found) != choices.end()
               ? std::string()
               : fmt::format("{}: found {}, expected {}", what, json::quote(found), fmt::join(choices, " or "));
  };
  std::vector<std::string> wrong = {
      between("slaves", question.slaves.value_or(1), 1, explore::most_equal_slaves),
      between("inner slaves", question.inner_slaves.value_or(1), 1, explore::most_inner_slaves),
      between("candidates", question.candidates.value_or(1), 1, explore::most_explored_candidates),
      between("key changes", question.key_changes.value_or(0), 0, explore::most_key_changes),
      between("calls", question.calls.value_or(0), 0, explore::most_commands),
      between("fault budget", question.query.fault_budget, 0, explore::most_faults),
      between("budget", question.query.states, 1, explore::most_states),
      one_of("variant", question.variant.value_or("robust"), {"paper", "robust"}),
      one_of("subscription", question.subscription.value_or("star"), {"star", "all-to-all"}),
      one_of("beginnings", question.beginnings, {"all", "switched-on"}),
  };
  for (const std::string& each : question.faults)
    if (std::ranges::find(explore::fault_names, each) == explore::fault_names.end())
      wrong.push_back(
          fmt::format("faults: found {}, expected {}", json::quote(each), fmt::join(explore::fault_names, ", ")));
  for (const std::string& each : wrong)
    if (!each.empty()) return each;
  return {};
}

/// Runs that end in a minute or so: fewer calls where there are more slaves.
std::uint32_t usual_calls(unsigned slaves) { return slaves == 1 ? 4 : slaves == 2 ? 2 : 1; }

/// What is asked for with --nested or --joining and cannot be explored; empty if all can.
std::string not_in_trees(const explore::Query& query, const GroupQuestion& question,
                         const scenario::Resolved* scenario) {
  std::string wrong;
  const auto refuse = [&wrong](bool is_wrong, const std::string& what) {
    if (is_wrong) wrong += (wrong.empty() ? "" : "; ") + what;
  };
  refuse(question.nested && scenario != nullptr,
         "--nested goes with --slaves N; of a scenario nested Programs are explored together by themselves");
  refuse(question.inner_slaves.has_value() && !question.nested,
         "--inner-slaves says the size of the inner group of --nested");
  if (!query.is_tree()) return wrong;
  refuse(query.variant != handshake::Variant::robust, "paper knows neither nested groups nor joining slaves");
  refuse(query.subscription != handshake::Subscription::star, "nested groups and joining slaves are explored in stars");
  refuse(query.network != explore::Network::registers, "nested groups and joining slaves are explored on registers");
  refuse(query.faults.contains(explore::Fault::duplicate) || query.faults.contains(explore::Fault::reorder),
         "nested groups and joining slaves are explored with loss, crash, restart, timeout and forge");
  refuse(query.nested() && query.slaves > explore::most_outer_slaves,
         "nested groups have at most " + std::to_string(explore::most_outer_slaves) + " outer slaves");
  refuse(question.writes_scenarios,
         "findings with nested groups or joining slaves are drawn as charts, not written as scenarios (--out)");
  return wrong;
}

/// The same with roles.
std::string not_with_roles(const explore::Query& query, const GroupQuestion& question) {
  std::string wrong;
  const auto refuse = [&wrong](bool is_wrong, const std::string& what) {
    if (is_wrong) wrong += (wrong.empty() ? "" : "; ") + what;
  };
  refuse(question.starts_again && !query.has_roles(),
         "--starts-again says what happens when the node of a role was replaced: give --candidates, too");
  if (!query.has_roles()) return wrong;
  refuse(query.variant != handshake::Variant::robust, "paper knows no roles");
  refuse(query.joining, "candidates join by themselves, without --joining");
  refuse(query.nested() && query.slaves > explore::most_outer_slaves,
         "nested groups have at most " + std::to_string(explore::most_outer_slaves) + " outer slaves");
  refuse(query.nested() && query.candidates > explore::most_inner_candidates,
         "nested groups are explored with at most " + std::to_string(explore::most_inner_candidates) + " candidates");
  refuse(query.nested() && query.starts_again,
         "a nested group is started by the one outside, so --starts-again does not go with --nested");
  refuse(query.subscription != handshake::Subscription::star, "roles are explored in stars");
  refuse(query.network != explore::Network::registers, "roles are explored on registers");
  refuse(query.faults.contains(explore::Fault::duplicate) || query.faults.contains(explore::Fault::reorder) ||
             query.faults.contains(explore::Fault::forge),
         "roles are explored with loss, crash, restart and timeout");
  refuse(query.roles() > explore::most_explored_roles,
         "at most " + std::to_string(explore::most_explored_roles) + " roles can be explored");
  refuse(question.writes_scenarios, "findings with roles are drawn as charts, not written as scenarios (--out)");
  return wrong;
}

/// The same with a stranger who replays.
std::string not_with_recordings(const explore::Query& query, const GroupQuestion& question) {
  std::string wrong;
  const auto refuse = [&wrong](bool is_wrong, const std::string& what) {
    if (is_wrong) wrong += (wrong.empty() ? "" : "; ") + what;
  };
  refuse(question.is_signed && !query.has_recordings(),
         "--signed says what becomes of messages that are replayed: give --faults replay, too");
  refuse(question.key_changes.has_value() && !question.is_signed, "--key-changes are those of --signed");
  if (!query.has_recordings()) return wrong;
  refuse(query.variant != handshake::Variant::robust,
         "replay is explored with robust; paper cannot tell an old word from a new one");
  refuse(query.network != explore::Network::registers, "replay is explored on registers");
  refuse(query.is_tree() || query.has_roles(), "replay is explored in one group with fixed slaves");
  refuse(query.faults.contains(explore::Fault::duplicate) || query.faults.contains(explore::Fault::reorder),
         "a replay is a duplicate that comes at any time: leave duplicate and reorder out");
  refuse(query.faults.contains(explore::Fault::forge),
         question.is_signed ? "nobody without the key forges signed words: leave forge out"
                            : "forge and replay are two questions: ask them one by one");
  refuse(question.writes_scenarios, "findings with replays are drawn as charts, not written as scenarios (--out)");
  return wrong;
}

}  // namespace

std::string set_network(const std::string& text, explore::Query& query) {
  if (text == "registers") return {};
  constexpr std::string_view channels = "channels";
  if (!text.starts_with(channels)) return "expected registers or channels=N, found " + text;
  query.network = explore::Network::channels;
  if (text.size() == channels.size()) return {};
  const std::string capacity = text.substr(channels.size());
  if (capacity.size() != 2 || capacity[0] != '=' || capacity[1] < '1' || capacity[1] > '0' + explore::most_capacity)
    return "expected channels=1 to channels=" + std::to_string(explore::most_capacity) + ", found " + text;
  query.capacity = static_cast<std::uint8_t>(capacity[1] - '0');
  return {};
}

Groups groups_of(const GroupQuestion& question, const scenario::Resolved* scenario) {
  Groups made;
  const auto mistake = [&made](std::string text) {
    made.mistake = std::move(text);
    made.groups.clear();
    return made;
  };
  if (std::string wrong = out_of_range(question); !wrong.empty()) return mistake(std::move(wrong));
  explore::Query query = question.query;
  query.symmetry = !question.no_symmetry;
  query.finishes = !question.no_finish;
  for (std::size_t f = 0; f < explore::fault_count; ++f)
    for (const std::string& each : question.faults)
      if (each == explore::fault_names[f]) query.faults.insert(static_cast<explore::Fault>(f));
  const auto variant_of = [&](handshake::Variant otherwise) {
    if (!question.variant) return otherwise;
    return *question.variant == "paper" ? handshake::Variant::paper : handshake::Variant::robust;
  };
  if (std::string wrong = set_network(question.network, query); !wrong.empty()) return mistake("network: " + wrong);
  if (question.beginnings == "switched-on") query.beginnings = explore::Beginnings::switched_on;
  const auto add = [&](const std::string& name, std::size_t slaves, handshake::Variant variant, bool all_to_all) {
    query.slaves = static_cast<std::uint8_t>(slaves);
    if (question.subscription) all_to_all = *question.subscription == "all-to-all";
    query.subscription = all_to_all ? handshake::Subscription::all_to_all : handshake::Subscription::star;
    query.variant = variant_of(variant);
    const std::size_t most = all_to_all               ? explore::most_slaves_all_to_all
                             : query.can_have_parts() ? explore::most_equal_slaves
                                                      : explore::most_slaves;
    if (slaves == 0 || (slaves > most && !question.any_number)) {
      made.mistake = fmt::format(
          "{} has {} slaves{}; at most {} can be explored{}: give --slaves N to explore a smaller group with its "
          "variant",
          name, slaves, all_to_all ? " with all-to-all subscription" : "", most,
          all_to_all || query.can_have_parts() ? "" : " with this variant, network and these faults");
      return false;
    }
    if (question.nested) query.inner_slaves = static_cast<std::uint8_t>(question.inner_slaves.value_or(1));
    if (question.candidates) query.candidates = static_cast<std::uint8_t>(*question.candidates);
    if (question.starts_again) query.starts_again = true;
    const unsigned nodes = query.has_roles() ? query.slaves + query.inner_slaves + query.candidates - 1U
                           : query.nested()  ? query.slaves + query.inner_slaves
                                             : query.slaves;
    query.commands = question.calls.value_or(usual_calls(nodes));
    query.is_signed = question.is_signed;
    query.key_changes =
        question.is_signed ? static_cast<std::uint8_t>(question.key_changes.value_or(1)) : std::uint8_t{0};
    std::string wrong;
    if (query.variant == handshake::Variant::paper && query.faults.contains(explore::Fault::forge))
      wrong =
          "forge is explored with robust; a word of paper is a state and nothing more, and whoever forges it is "
          "believed";
    if (wrong.empty()) wrong = not_in_trees(query, question, scenario);
    if (wrong.empty()) wrong = not_with_roles(query, question);
    if (wrong.empty()) wrong = not_with_recordings(query, question);
    if (wrong.empty() && question.any_number && !query.can_have_parts())
      wrong =
          "every number of slaves is proved of robust in a star on registers, without roles, nested groups, joining "
          "slaves, forge and replay";
    if (wrong.empty())
      made.groups.push_back({name, query});
    else
      made.mistake = name + ": " + wrong;
    return wrong.empty();
  };
  if (scenario == nullptr) {
    if (!question.slaves && !question.any_number)
      return mistake("explore needs a scenario, --slaves N or --any-number");
    add("group", question.slaves.value_or(1), handshake::Variant::robust, false);
    return made;
  }
  for (std::uint32_t number = 0; number < scenario->programs.size(); ++number) {
    const scenario::ResolvedProgram& each = scenario->programs[number];
    const scenario::Program& program = *each.description;
    query.inner_slaves = 0;
    if (const std::vector<std::uint32_t> tree = tree_of(*scenario, number); tree.size() > 1 && !question.slaves) {
      const auto wrong = set_tree(*scenario, tree, query);
      if (!wrong && tree[0] != number) continue;  // explored with the one outside
      if (!wrong) {
        if (!add(program.name + " and " + scenario->programs[tree[1]].name + " within", query.slaves, program.variant,
                 false))
          return mistake(made.mistake);
        continue;
      }
      if (tree[0] == number)
        made.notes.push_back(program.name + " and what is within is explored one by one: " + *wrong);
      query.inner_slaves = 0;
    }
    const std::size_t slaves =
        question.slaves.value_or(static_cast<unsigned>(program.slaves.size() + program.roles.size()));
    query.candidates = 0;
    if (each.has_roles() && question.slaves)
      return mistake(program.name + " has roles, so --slaves does not go with it");
    if (each.has_roles())
      if (const auto wrong = set_roles(each, query))
        return mistake(program.name + ": " + *wrong + ": give --slaves and --candidates instead of the scenario");
    if (!add(program.name, slaves, program.variant, program.subscription == scenario::Subscription::all_to_all))
      return mistake(made.mistake);
  }
  if (made.groups.empty()) return mistake("the scenario has no Programs to explore");
  return made;
}

}  // namespace takt::verify
