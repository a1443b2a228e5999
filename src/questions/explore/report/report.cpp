// SPDX-License-Identifier: Apache-2.0
#include "explore/report/report.hpp"

#include <cstdio>

#include "explore/report/knowledge.hpp"

namespace takt::explore {
namespace {

std::string fault_list(const Query& query) {
  std::string text;
  for (const std::string_view fault : faults_of(query)) text += (text.empty() ? "" : ", ") + std::string(fault);
  return text;
}

std::string fixed(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string verdict_line(const SearchResult& result, std::size_t p) {
  std::string line =
      "  " + padded(std::string(property_names[p]), 20) + padded(std::string(name_of(result.verdicts[p])), 10);
  if (result.traces[p])
    line += "after " + std::to_string(result.traces[p]->actions.size()) + " steps from \"" +
            result.beginnings[result.traces[p]->beginning].name + "\"; ";
  return line + std::string(property_texts[p]) + "\n";
}

std::string counter_example(const Query& query, const SearchResult& result, Property property, const Trace& trace,
                            Detail detail) {
  const Chart chart = chart_of(query, result.beginnings[trace.beginning], trace);
  const Explanation explained = explanation(chart, property);
  std::string text = "\n" + explained.property + " is violated: " + explained.text + "\n\n" +
                     drawn(detail == Detail::knowledge ? with_knowledge(chart, explained) : chart);
  if (explained.ends != "violation")
    text += trace.cycle == 0 ? "      and nothing changes any more\n" : "      and so for ever\n";
  return text + why_text(explained);
}

}  // namespace

std::string_view variant_of(const Query& query) {
  return query.variant == handshake::Variant::paper ? "paper" : "robust";
}

std::vector<std::string_view> faults_of(const Query& query) {
  std::vector<std::string_view> names;
  for (std::size_t f = 0; f < fault_count; ++f)
    if (query.faults.contains(static_cast<Fault>(f))) names.push_back(name_of(static_cast<Fault>(f)));
  return names;
}

std::string query_line(const Query& query) {
  const std::string faults = fault_list(query);
  const std::string network =
      query.network == Network::registers ? "" : ", channels of " + std::to_string(query.capacity);
  const std::string subscription = query.subscription == handshake::Subscription::star ? "" : ", all-to-all";
  const std::string inner = !query.nested() ? ""
                                            : ", the last of them master of " + std::to_string(query.inner_slaves) +
                                                  (query.has_roles() ? " inner role" : " inner slave") +
                                                  (query.inner_slaves == 1 ? "" : "s");
  const std::string joining = !query.joining   ? ""
                              : query.nested() ? ", the last inner slave joins"
                                               : ", the last slave joins";
  const std::string beginnings = query.beginnings == Beginnings::all ? "" : ", switched on";
  const std::string keys = !query.is_signed         ? ""
                           : query.key_changes == 0 ? ", signed"
                           : query.key_changes == 1
                               ? ", signed, keys change once"
                               : ", signed, keys change " + std::to_string(query.key_changes) + " times";
  const std::string of = query.has_roles() && !query.nested() ? " role" : " slave";
  const std::string candidates = !query.has_roles()
                                     ? ""
                                     : " for " + std::to_string(query.candidates) +
                                           (query.candidates == 1 ? " candidate" : " candidates") +
                                           (query.starts_again ? ", started again after a replacement" : "");
  return std::string(variant_of(query)) + ", 1 master and " + std::to_string(query.slaves) + of +
         (query.slaves == 1 ? "" : "s") + inner + candidates + joining + subscription + network + keys + beginnings +
         "; in a run at most " + std::to_string(query.commands) +
         (query.has_roles() ? " calls, joins and leaves and " : " calls and ") +
         (faults.empty() ? "no fault"
                         : std::to_string(query.fault_budget) +
                               (query.fault_budget == 1 ? " fault of: " : " faults of: ") + faults);
}

std::string text_report(const Query& query, const SearchResult& result, double cpu_s, Detail detail) {
  std::string text = query_line(query) + "\n";
  text += std::to_string(result.states) + " states, " + std::to_string(result.transitions) + " steps, depth " +
          std::to_string(result.depth) + ", " + fixed(cpu_s, 2) + " s CPU, " +
          fixed(static_cast<double>(result.octets) / static_cast<double>(result.states), 1) + " octets a state, " +
          (result.symmetry ? "slaves are equal" : "slaves are told apart") + "\n";
  text += result.exhausted     ? "The whole space was searched.\n"
          : result.interrupted ? "Interrupted: what was found until then.\n"
                               : "Not the whole space was searched: the limit of states or depth was reached.\n";
  for (std::size_t p = 0; p < property_count; ++p)
    if (result.verdicts[p] != PropertyVerdict::not_asked) text += verdict_line(result, p);
  for (std::size_t p = 0; p < property_count; ++p)
    if (result.verdicts[p] == PropertyVerdict::violated && result.traces[p])
      text += counter_example(query, result, static_cast<Property>(p), *result.traces[p], detail);
  const bool is_new =
      result.livelock && result.traces[index_of(Property::L1)] && result.traces[index_of(Property::L1)]->cycle == 0;
  if (is_new) text += counter_example(query, result, Property::L1, *result.livelock, detail);
  return text;
}

std::string text_report(const Query& query, const AnyNumber& proof, double cpu_s) {
  Query one = query;
  one.slaves = 1;
  const std::string line = query_line(one);
  std::string text = "any number of slaves: " + line + "\n";
  text += std::to_string(proof.views) + " views of the master and one slave, " + std::to_string(proof.masters) +
          " states of the master, " + fixed(cpu_s, 2) + " s CPU\n";
  text += !proof.are_alike    ? "The handshake does not treat all slaves alike: nothing follows for more of them.\n"
          : proof.exhausted   ? "All views were found: what holds in them holds in a group of any size.\n"
          : proof.interrupted ? "Interrupted: nothing is proved.\n"
                              : "Not all views were found: the limit of states was reached, and nothing is proved.\n";
  for (std::size_t p = 0; p < property_count; ++p) {
    if (proof.verdicts[p] == PropertyVerdict::not_asked) continue;
    const bool is_violated = proof.verdicts[p] == PropertyVerdict::violated;
    text += "  " + padded(std::string(property_names[p]), 20) +
            padded(is_violated ? "not proved" : std::string(name_of(proof.verdicts[p])), 12) +
            std::string(property_texts[p]) + "\n";
  }
  return text;
}

}  // namespace takt::explore
