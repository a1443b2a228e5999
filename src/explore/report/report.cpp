#include "explore/report/report.hpp"

#include <cstdio>

#include "explore/report/chart.hpp"

namespace takt::explore {
namespace {

std::string variant_name(handshake::Variant variant) { return variant == handshake::Variant::Paper ? "paper" : "robust"; }

std::string fault_list(const Question& question, const char* before, const char* between, const char* after) {
  std::string text;
  for (std::size_t f = 0; f < fault_count; ++f) {
    const auto fault = static_cast<Fault>(f);
    if (question.faults.contains(fault)) text += (text.empty() ? "" : between) + std::string(before) + std::string(name_of(fault)) + after;
  }
  return text;
}

std::string fixed(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text;
}

const char* yes(bool value) { return value ? "true" : "false"; }

std::string verdict_line(const Answer& answer, std::size_t p) {
  std::string line = "  " + padded(std::string(property_names[p]), 20) + padded(std::string(name_of(answer.verdicts[p])), 10);
  if (answer.traces[p]) line += "after " + std::to_string(answer.traces[p]->actions.size()) + " steps from \"" + answer.beginnings[answer.traces[p]->beginning].name + "\"; ";
  return line + std::string(property_texts[p]) + "\n";
}

std::string counter_example(const Question& question, const Answer& answer, Property property, const Trace& trace) {
  const Beginning& beginning = answer.beginnings[trace.beginning];
  std::string text = "\n" + std::string(name_of(property)) + " is violated: " + std::string(property_texts[index_of(property)]) + "\n\n" +
                     chart(question, beginning, trace);
  if (property == Property::L1 || property == Property::F1) text += trace.cycle == 0 ? "      and nothing changes any more\n" : "      and so for ever\n";
  return text;
}

}  // namespace

std::string question_line(const Question& question) {
  const std::string faults = fault_list(question, "", ", ", "");
  const std::string network = question.network == Network::registers ? "" : ", channels of " + std::to_string(question.capacity);
  const std::string subscription = question.subscription == handshake::Subscription::Star ? "" : ", all-to-all";
  const std::string inner = !question.nested() ? "" : ", the last of them master of " + std::to_string(question.inner_slaves) + (question.inner_slaves == 1 ? " inner slave" : " inner slaves");
  const std::string joining = !question.joining ? "" : question.nested() ? ", the last inner slave joins" : ", the last slave joins";
  const std::string beginnings = question.beginnings == Beginnings::all ? "" : ", switched on";
  const std::string of = question.has_roles() ? " role" : " slave";
  const std::string candidates = !question.has_roles() ? "" : " for " + std::to_string(question.candidates) + (question.candidates == 1 ? " candidate" : " candidates") + (question.starts_again ? ", started again after a replacement" : "");
  return variant_name(question.variant) + ", 1 master and " + std::to_string(question.slaves) + of + (question.slaves == 1 ? "" : "s") + candidates + inner + joining + subscription + network + beginnings +
         "; in a run at most " +
         std::to_string(question.commands) + (question.has_roles() ? " calls, joins and leaves and " : " calls and ") +
         (faults.empty() ? "no fault" : std::to_string(question.fault_budget) + (question.fault_budget == 1 ? " fault of: " : " faults of: ") + faults);
}

std::string text_report(const Question& question, const Answer& answer, double cpu_s) {
  std::string text = question_line(question) + "\n";
  text += std::to_string(answer.states) + " states, " + std::to_string(answer.transitions) + " steps, depth " + std::to_string(answer.depth) + ", " +
          fixed(cpu_s, 2) + " s CPU, " + fixed(static_cast<double>(answer.octets) / static_cast<double>(answer.states), 1) + " octets a state, " +
          (answer.symmetry ? "slaves are equal" : "slaves are told apart") + "\n";
  text += answer.exhausted ? "The whole space was searched.\n"
                           : answer.interrupted ? "Interrupted: what was found until then.\n" : "Not the whole space was searched: the limit of states or depth was reached.\n";
  for (std::size_t p = 0; p < property_count; ++p)
    if (answer.verdicts[p] != Verdict::not_asked) text += verdict_line(answer, p);
  for (std::size_t p = 0; p < property_count; ++p)
    if (answer.verdicts[p] == Verdict::violated && answer.traces[p]) text += counter_example(question, answer, static_cast<Property>(p), *answer.traces[p]);
  const bool is_new = answer.chase && answer.traces[index_of(Property::L1)] && answer.traces[index_of(Property::L1)]->cycle == 0;
  if (is_new) text += counter_example(question, answer, Property::L1, *answer.chase);
  return text;
}

std::string json_report(const std::string& program, const Question& question, const Answer& answer, double cpu_s) {
  const auto quoted = [](std::string_view text) { return "\"" + std::string(text) + "\""; };
  const std::vector<std::pair<std::string, std::string>> members{
      {"variant", quoted(variant_name(question.variant))},
      {"slaves", std::to_string(question.slaves)},
      {"subscription", quoted(question.subscription == handshake::Subscription::Star ? "star" : "all-to-all")},
      {"nested", yes(question.nested())},
      {"inner_slaves", std::to_string(question.inner_slaves)},
      {"joining", yes(question.joining)},
      {"candidates", std::to_string(question.candidates)},
      {"network", quoted(question.network == Network::registers ? "registers" : "channels=" + std::to_string(question.capacity))},
      {"beginnings", quoted(question.beginnings == Beginnings::all ? "all" : "switched-on")},
      {"faults", "[" + fault_list(question, "\"", ", ", "\"") + "]"},
      {"fault_budget", std::to_string(question.fault_budget)},
      {"calls", std::to_string(question.commands)},
      {"states", std::to_string(answer.states)},
      {"steps", std::to_string(answer.transitions)},
      {"quiescent", std::to_string(answer.quiescent)},
      {"depth", std::to_string(answer.depth)},
      {"cpu_s", fixed(cpu_s, 3)},
      {"exhausted", yes(answer.exhausted)},
      {"interrupted", yes(answer.interrupted)},
      {"symmetry", yes(answer.symmetry)},
      {"octets", std::to_string(answer.octets)},
      {"octets_per_state", fixed(static_cast<double>(answer.octets) / static_cast<double>(answer.states), 1)}};
  std::string text = "{";
  if (!program.empty()) text += "\n  \"program\": " + quoted(program) + ",";
  for (const auto& [key, value] : members) text += "\n  " + quoted(key) + ": " + value + ",";
  text += "\n  \"properties\": {";
  bool first = true;
  for (std::size_t p = 0; p < property_count; ++p) {
    if (answer.verdicts[p] == Verdict::not_asked) continue;
    text += (first ? "\n    " : ",\n    ") + quoted(property_names[p]) + ": " + quoted(name_of(answer.verdicts[p]));
    first = false;
  }
  return text + "\n  }\n}";
}

}  // namespace takt::explore
