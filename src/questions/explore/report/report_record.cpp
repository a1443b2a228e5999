// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include "explore/report/knowledge.hpp"
#include "explore/report/report.hpp"
#include "json/record.hpp"

namespace takt::explore {

namespace {

std::string_view variant(const Exploration& made) { return variant_of(made.query); }
std::uint64_t slaves(const Exploration& made) { return made.query.slaves; }
std::string_view subscription(const Exploration& made) {
  return made.query.subscription == handshake::Subscription::star ? "star" : "all-to-all";
}
bool is_nested(const Exploration& made) { return made.query.nested(); }
std::uint64_t inner_slaves(const Exploration& made) { return made.query.inner_slaves; }
bool is_joining(const Exploration& made) { return made.query.joining; }
std::uint64_t candidates(const Exploration& made) { return made.query.candidates; }
std::string network(const Exploration& made) {
  return made.query.network == Network::registers ? "registers" : "channels=" + std::to_string(made.query.capacity);
}
bool is_signed(const Exploration& made) { return made.query.is_signed; }
std::uint64_t key_changes(const Exploration& made) { return made.query.key_changes; }
std::string_view beginnings(const Exploration& made) {
  return made.query.beginnings == Beginnings::all ? "all" : "switched-on";
}
std::vector<std::string_view> faults(const Exploration& made) { return faults_of(made.query); }
std::uint64_t fault_budget(const Exploration& made) { return made.query.fault_budget; }
std::uint64_t calls(const Exploration& made) { return made.query.commands; }
std::uint64_t states(const Exploration& made) { return made.result.states; }
std::uint64_t steps(const Exploration& made) { return made.result.transitions; }
std::uint64_t quiescent(const Exploration& made) { return made.result.quiescent; }
std::uint32_t depth(const Exploration& made) { return made.result.depth; }
double cpu_s(const Exploration& made) { return std::round(made.cpu_s * 1e3) / 1e3; }
bool is_exhausted(const Exploration& made) { return made.result.exhausted; }
bool is_interrupted(const Exploration& made) { return made.result.interrupted; }
bool has_symmetry(const Exploration& made) { return made.result.symmetry; }
std::uint64_t octets(const Exploration& made) { return made.result.octets; }
double octets_per_state(const Exploration& made) {
  return std::round(10 * static_cast<double>(made.result.octets) / static_cast<double>(made.result.states)) / 10;
}
std::vector<std::pair<std::string, std::string_view>> properties(const Exploration& made) {
  std::vector<std::pair<std::string, std::string_view>> asked;
  for (std::size_t p = 0; p < property_count; ++p)
    if (made.result.verdicts[p] != PropertyVerdict::not_asked)
      asked.emplace_back(property_names[p], name_of(made.result.verdicts[p]));
  return asked;
}

std::vector<Explanation> violations(const Exploration& made) { return explanations(made.query, made.result); }

}  // namespace

const json::Record& describe(json::Type<Exploration>) {
  static constexpr json::Output outputs[] = {
      json::output_if_any<&Exploration::program>("program", "The scenario's Program.", "of a scenario"),
      json::output<&variant>("variant", "The handshake: `robust` or `paper`."),
      json::output<&slaves>("slaves", "Of the group; with candidates, its roles."),
      json::output<&subscription>("subscription", "`star` or `all-to-all`."),
      json::output<&is_nested>("nested", "The last slave is the master of an inner group."),
      json::output<&inner_slaves>("inner_slaves", "Of that group."),
      json::output<&is_joining>("joining", "The last slave comes up late."),
      json::output<&candidates>("candidates", "Nodes for the roles; 0: participants are fixed."),
      json::output<&network>("network", "`registers` (the last word) or `channels=N` (up to N words under way)."),
      json::output<&is_signed>("signed", "Messages are signed: none is taken twice, nor behind a newer one."),
      json::output<&key_changes>("key_changes", "How often the key of each participant may change."),
      json::output<&beginnings>("beginnings", "`all` states at rest, or `switched-on` only."),
      json::output<&faults>("faults", "Which may happen."),
      json::output<&fault_budget>("fault_budget", "How many in a run, at most."),
      json::output<&calls>("calls", "How many in a run, at most."),
      json::output<&states>("states", "That were found."),
      json::output<&steps>("steps", "That change something."),
      json::output<&quiescent>("quiescent", "States in which nothing changes any more by itself."),
      json::output<&depth>("depth", "Steps to the deepest state."),
      json::output<&cpu_s>("cpu_s", "What the search took.", {.unit = "s of CPU"}),
      json::output<&is_exhausted>("exhausted", "Every state within the budgets was seen."),
      json::output<&is_interrupted>("interrupted", "It was stopped; what was found until then."),
      json::output<&has_symmetry>("symmetry", "Slaves were taken for equal."),
      json::output<&octets>("octets", "Of the stored states and their table.", {.unit = "octets"}),
      json::output<&octets_per_state>("octets_per_state", "Of them for each state.", {.unit = "octets"}),
      json::output<&properties>("properties", "`holds`, `violated`, `reached` ... of each property that is asked.",
                                {.keys = "property"}),
      json::output<&violations>(
          "violations",
          "For each violated property a shortest run, explained; L1 also by one that never comes to rest."),
  };
  static constexpr json::Record record{
      "exploration", "What was found about a group. With several Programs in a scenario, a list of these.", outputs};
  return record;
}

}  // namespace takt::explore
