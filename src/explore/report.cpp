#include "explore/report.hpp"

#include <cstdio>

#include "explore/chart.hpp"
#include "explore/replay.hpp"

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
  std::string text = "\n" + std::string(name_of(property)) + " is violated: " + std::string(property_texts[index_of(property)]) + "\n\n" +
                     chart(question, replay(question, answer.beginnings[trace.beginning], trace));
  if (property == Property::L1 || property == Property::F1) text += trace.cycle == 0 ? "      and nothing changes any more\n" : "      and so for ever\n";
  return text;
}

}  // namespace

std::string question_line(const Question& question) {
  const std::string faults = fault_list(question, "", ", ", "");
  return variant_name(question.variant) + ", 1 master and " + std::to_string(question.slaves) + (question.slaves == 1 ? " slave" : " slaves") + "; in a run at most " +
         std::to_string(question.commands) + " calls and " +
         (faults.empty() ? "no fault" : std::to_string(question.fault_budget) + (question.fault_budget == 1 ? " fault of: " : " faults of: ") + faults);
}

std::string text_report(const Question& question, const Answer& answer, double cpu_s) {
  std::string text = question_line(question) + "\n";
  text += std::to_string(answer.states) + " states, " + std::to_string(answer.transitions) + " steps, depth " + std::to_string(answer.depth) + ", " +
          fixed(cpu_s, 2) + " s CPU, " + fixed(static_cast<double>(answer.octets) / static_cast<double>(answer.states), 1) + " octets a state, " +
          (answer.symmetry ? "slaves are equal" : "slaves are told apart") + "\n";
  text += answer.exhausted ? "The whole space was searched.\n"
                           : answer.interrupted ? "Interrupted: what was found until then.\n" : "Not the whole space was searched: the limit of states or depth was reached.\n";
  for (std::size_t p = 0; p < property_count; ++p) text += verdict_line(answer, p);
  for (std::size_t p = 0; p < property_count; ++p)
    if (answer.verdicts[p] == Verdict::violated && answer.traces[p]) text += counter_example(question, answer, static_cast<Property>(p), *answer.traces[p]);
  const bool is_new = answer.chase && answer.traces[index_of(Property::L1)] && answer.traces[index_of(Property::L1)]->cycle == 0;
  if (is_new) text += counter_example(question, answer, Property::L1, *answer.chase);
  return text;
}

std::string json_report(const Question& question, const Answer& answer, double cpu_s) {
  std::string text = "{\n  \"variant\": \"" + variant_name(question.variant) + "\",\n  \"slaves\": " + std::to_string(question.slaves) + ",\n  \"faults\": [" +
                     fault_list(question, "\"", ", ", "\"") + "],\n  \"fault_budget\": " + std::to_string(question.fault_budget) + ",\n  \"calls\": " +
                     std::to_string(question.commands) + ",\n  \"states\": " + std::to_string(answer.states) + ",\n  \"steps\": " + std::to_string(answer.transitions) +
                     ",\n  \"depth\": " + std::to_string(answer.depth) + ",\n  \"cpu_s\": " + fixed(cpu_s, 3) + ",\n  \"exhausted\": " + yes(answer.exhausted) +
                     ",\n  \"interrupted\": " + yes(answer.interrupted) + ",\n  \"symmetry\": " + yes(answer.symmetry) + ",\n  \"octets\": " + std::to_string(answer.octets) +
                     ",\n  \"properties\": {";
  for (std::size_t p = 0; p < property_count; ++p)
    text += (p == 0 ? "\n    \"" : ",\n    \"") + std::string(property_names[p]) + "\": \"" + std::string(name_of(answer.verdicts[p])) + "\"";
  return text + "\n  }\n}\n";
}

}  // namespace takt::explore
