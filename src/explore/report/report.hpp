// What an exploration says: a page for people, and JSON.
#pragma once

#include <string>

#include "explore/model/question.hpp"
#include "explore/search/search.hpp"

namespace takt::explore {

/// The question in one line: who, which calls, which faults.
std::string question_line(const Question& question);
/// Sizes, verdicts and, for each violated property, its chart. `cpu_s` was measured by whoever asked.
std::string text_report(const Question& question, const Answer& answer, double cpu_s);
/// One object: variant, slaves, faults, states, depth, cpu_s, exhausted, properties and some more figures.
/// One object; without the member "program" if that is empty. A property that is not asked is left out.
std::string json_report(const std::string& program, const Question& question, const Answer& answer, double cpu_s);

}  // namespace takt::explore
