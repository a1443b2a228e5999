// SPDX-License-Identifier: Apache-2.0
#include "verify/report_record.hpp"

#include "analysis/report_record.hpp"
#include "json/record.hpp"

namespace takt::verify {

using sim::Duration;

namespace {

std::optional<std::string> unless_empty(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(text);
}

std::string name_of_requirement(const ReportedLine& row) { return row.line->requirement.name; }
std::string text_of(const ReportedLine& row) { return row.line->requirement.text; }
std::optional<Duration> simulated(const ReportedLine& row) { return row.line->simulated; }
std::optional<Duration> adversarial(const ReportedLine& row) { return row.line->adversarial; }
std::optional<Duration> bound(const ReportedLine& row) { return row.line->bound; }
std::optional<Duration> limit(const ReportedLine& row) { return row.line->requirement.limit; }
std::string verdict(const ReportedLine& row) { return name_of(row.line->verdict); }
std::optional<double> tightness(const ReportedLine& row) { return row.line->tightness(); }
std::uint64_t runs(const ReportedLine& row) { return row.line->runs; }
std::string ended(const ReportedLine& row) { return name_of(row.line->ended); }
std::optional<std::uint64_t> violations(const ReportedLine& row) { return row.line->violations; }
bool is_exhaustive(const ReportedLine& row) { return row.line->exhaustive; }
std::optional<std::string> reason(const ReportedLine& row) { return unless_empty(row.line->reason); }
std::string provided(const ReportedLine& row) { return row.line->provided; }
std::optional<std::string> remark(const ReportedLine& row) { return unless_empty(row.line->remark); }
const std::vector<SlackPart>& slack(const ReportedLine& row) { return row.line->slack; }
const std::vector<WeightyPart>& weighty(const ReportedLine& row) { return row.line->weighty; }
const std::vector<Remedy>& remedies(const ReportedLine& row) { return row.line->remedies; }
std::vector<std::string> assumptions(const ReportedLine& row) { return analysis::names_of(row.line->assumptions); }

std::string witness_run(const ReportedContradiction& contradiction) { return contradiction.witnesses.run; }
std::string witness_bound(const ReportedContradiction& contradiction) { return contradiction.witnesses.bound; }

}  // namespace

const json::Record& describe(json::Type<ReportedVariable>) {
  static constexpr json::Output outputs[] = {
      json::output<&ReportedVariable::what>("what", "What the search chooses."),
      json::output<&ReportedVariable::range>("range_ps", "Within what; null where it is no time."),
  };
  static constexpr json::Record record{"variable", "Something that the scenario leaves open.", outputs};
  return record;
}

const json::Record& describe(json::Type<SlackPart>) {
  static constexpr json::Output outputs[] = {
      json::output<&SlackPart::where>("where", "A port, or a message's way."),
      json::output<&SlackPart::what>("what", "What the bound reckons with there."),
      json::output<&SlackPart::bound>("bound_ps", "What the bound takes for it."),
      json::output<&SlackPart::run>("run_ps", "What it took in the worst run."),
  };
  static constexpr json::Record record{"slack", "A part of a bound beside that of the worst run.", outputs};
  return record;
}

const json::Record& describe(json::Type<WeightyPart>) {
  static constexpr json::Output outputs[] = {
      json::output<&WeightyPart::where>("where", "A port, a node, or participants."),
      json::output<&WeightyPart::what>("what", "What takes time there."),
      json::output<&WeightyPart::takes>("takes_ps", "How long, all occurrences together."),
  };
  static constexpr json::Record record{"weighty_part", "A part of the worst run that was found.", outputs};
  return record;
}

const json::Record& describe(json::Type<Remedy>) {
  static constexpr json::Output outputs[] = {
      json::output<&Remedy::what>("what", "What would be another: \"payload of camera at most\"."),
      json::output<&Remedy::value>("value", "The value that is nearest to the present one."),
      json::output<&Remedy::bound>("bound_ps", "What no run exceeds then."),
      json::output_if_any<&Remedy::breaks>("breaks", "Requirements that are proved now, and not then.",
                                           "if there are some"),
  };
  static constexpr json::Record record{"remedy", "A change with which the requirement would be proved.", outputs};
  return record;
}

const json::Record& describe(json::Type<ReportedLine>) {
  static constexpr json::Output outputs[] = {
      json::output_if_any<&name_of_requirement>("name", "The name that the scenario gives it.", "where it gives one"),
      json::output<&text_of>("text", "What is required."),
      json::output<&simulated>("simulated_ps",
                               "The greatest in runs of the scenario as it is; null where it is no time."),
      json::output<&adversarial>("adversarial_ps", "The greatest that the search for the worst run found."),
      json::output<&bound>("bound_ps", "What no run exceeds; null: no bound, or one that does not stand."),
      json::output<&limit>("limit_ps", "What is asked; null where it is no time."),
      json::output<&verdict>("verdict",
                             "`pass` (proved), `refuted`, `undecided`, `contradiction` (a mistake of takt), `reported` "
                             "(violations are reported only, so nothing is proved and nothing fails), or `given` (a "
                             "data sheet promises it, and no run that was found shows more)."),
      json::output_if_any<&provided>("if", "The promises of data sheets that the proof rests on.",
                                     "of what is proved on such a condition"),
      json::output<&tightness>("tightness", "adversarial / bound; null without either."),
      json::output<&runs>("runs", "Of the search for this requirement."),
      json::output<&ended>(
          "ended",
          "Why there were no more: `bound_reached` (none can be worse), `all_meetings` (all phases at which frames "
          "meet were run), `all_instants` (all combinations of the critical instants that are known were run), "
          "`no_worse` (from several beginnings nothing worse was found), `as_it_is` (only the scenario as it is says "
          "anything of it), `nothing_free` (all runs are the same), `budget` or `interrupted`."),
      json::output<&is_exhaustive>(
          "exhaustive",
          "No run is worse than `adversarial_ps`: nothing but phases of periodic talkers is free, ports send the "
          "highest class first and nothing else, and all meetings were run; or all runs are the same."),
      json::output_if_any<&violations>("violations", "The most that a run had.", "of a Program's invariants"),
      json::output<&reason>("reason", "Why it is not proved; null: it is."),
      json::output<&remark>("remark", "How it is proved, where that is no bound."),
      json::output<&slack>("gives_away",
                           "Where the bound gives away what the worst run does not take; empty where it is tight."),
      json::output<&weighty>(
          "most",
          "Of what is not proved: what took most of the worst run, at most three parts; `takt explain` has them all."),
      json::output<&remedies>(
          "would_help",
          "Of what is not proved: changes to the scenario with each of which it would be, all else being as it is."),
      json::output<&assumptions>("assumptions", "Names of what the bound or proof rests on."),
      json::output<&ReportedLine::file>("file", "The scenario that replays the worst run; null: not written."),
  };
  static constexpr json::Record record{"requirement", "The three figures of a requirement and the limit.", outputs};
  return record;
}

const json::Record& describe(json::Type<ReportedAssumption>) {
  static constexpr json::Output outputs[] = {
      json::output<&ReportedAssumption::name>("name", "Its name."),
      json::spread<&ReportedAssumption::assessed>(),
  };
  static constexpr json::Record record{"named_assumption", "What becomes of an assumption in this scenario.", outputs};
  return record;
}

const json::Record& describe(json::Type<ReportedContradiction>) {
  static constexpr json::Output outputs[] = {
      json::output<&ReportedContradiction::text>("text", "What contradicts what."),
      json::output<&witness_run>("run", "The scenario that replays the run."),
      json::output<&witness_bound>("bound", "The scenario whose bound it is."),
  };
  static constexpr json::Record record{"contradiction", "A mistake of takt: nothing in the report is to be trusted.",
                                       outputs};
  return record;
}

const json::Record& describe(json::Type<Report>) {
  static constexpr json::Output outputs[] = {
      json::output<&Report::scenario>("scenario", "Its name."),
      json::output<&Report::verdict>("verdict",
                                     "Of all requirements: the worst; `reported` or `given` if there are only such; "
                                     "`nothing was required` without one."),
      json::output<&Report::runs>("runs", "In all."),
      json::output<&Report::partial>("partial", "It was interrupted."),
      json::output<&Report::free>("free", "What the search for the worst run chooses."),
      json::output<&Report::requirements>("requirements", "In the order of the scenario."),
      json::output<&Report::assumptions>("assumptions", "What bounds and proofs rest on."),
      json::output_if_any<&Report::contradiction>("contradiction", "A run that exceeds what was proved.",
                                                  "if there is one"),
  };
  static constexpr json::Record record{"verification", "What a verification says.", outputs};
  return record;
}

}  // namespace takt::verify
