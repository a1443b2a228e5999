// SPDX-License-Identifier: Apache-2.0
// takt explain: why was it late?
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "analysis/bounds.hpp"
#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/load.hpp"
#include "cli/terminal.hpp"
#include "evaluation/evaluate.hpp"
#include "explain/ask.hpp"
#include "json/quantity.hpp"
#include "json/record.hpp"
#include "verify/adversary.hpp"
#include "verify/slack.hpp"

namespace takt::cli {
namespace {

using results::RequirementKind;
using results::RequirementResult;

struct ExplainOptions {
  ScenarioOptions scenario;
  std::optional<std::string> stream;
  std::optional<std::string> reaction;
  std::optional<std::uint32_t> requirement;
  std::optional<std::string> frame;
  bool worst = false;
  bool lost = false;
  bool adversarial = false;
  bool bound = false;
  verify::SearchOptions search;
  double budget = static_cast<double>(verify::default_events) / 1e6;  // millions of events
};

constexpr sim::Duration no_limit = sim::Duration::from_ps(3'600'000'000'000'000);

/// What is asked about, as a requirement: with a limit that nothing exceeds if the scenario requires nothing of it.
scenario::Requirement about_stream(const std::string& name) {
  scenario::Requirement made;
  made.stream = name;
  made.latency.emplace().at_most = no_limit;
  return made;
}

class Asking {
 public:
  Asking(const ExplainOptions& options, const scenario::Resolved& resolved) : options_(options), resolved_(resolved) {}

  ExitStatus answer() {
    explanation_.scenario = resolved_.scenario.name;
    if (!find_subject()) return refuse();
    if (options_.frame || options_.lost) return answer_frame();
    return answer_figure();
  }

 private:
  ExitStatus refuse() {
    if (options_.scenario.is_json())
      std::fputs(json::pretty(diagnostics_.to_json()).c_str(), stdout);
    else
      std::fputs(diagnostics_.to_text().c_str(), stderr);
    return ExitStatus::bad_input;
  }
  bool mistake(const char* where, std::string message, std::string found, std::string expected) {
    diagnostics_.error({where, 0, 0, ""}, std::move(message), {std::move(found), std::move(expected)});
    return false;
  }

  bool find_subject() {
    if (const int asked = (options_.stream ? 1 : 0) + (options_.reaction ? 1 : 0) + (options_.requirement ? 1 : 0);
        asked > 1)
      return mistake("command line", "more than one question", "several of --stream, --reaction and --requirement",
                     "one of them");
    if (options_.stream) {
      if (!stream_of(*options_.stream))
        return mistake("--stream", "no such stream", json::quote(*options_.stream), names_of_streams());
      subject_ = about_stream(*options_.stream);
    } else if (options_.reaction) {
      if (!ask_reaction(*options_.reaction)) return false;
    } else if (options_.requirement) {
      if (*options_.requirement < 1 || *options_.requirement > resolved_.scenario.require.size())
        return mistake("--requirement", "no such requirement", std::to_string(*options_.requirement),
                       fmt::format("1 to {}, as the scenario lists them", resolved_.scenario.require.size()));
      subject_ = resolved_.scenario.require[*options_.requirement - 1];
    }
    if (options_.frame || options_.lost) {
      if (options_.frame && !frame_number())
        return mistake("--frame", "no frame", json::quote(*options_.frame), "its number in the stream, from 0");
      if (!stream() && options_.frame)
        return mistake("--frame", "a frame of no stream",
                       options_.requirement ? "a requirement of no single stream" : "no --stream", "--stream NAME");
      if (options_.adversarial || options_.bound)
        return mistake("command line", "a frame of another run", "--frame or --lost with --adversarial or --bound",
                       "one of them");
    }
    return true;
  }

  std::optional<models::StreamIndex> stream_of(const std::string& name) const {
    return explain::stream_named(resolved_, name);
  }
  std::string names_of_streams() const {
    std::string names;
    for (const auto& stream : resolved_.plan.streams) {
      if (names.size() > 300) return names + ", ...";
      names += (names.empty() ? "one of " : ", ") + json::quote(stream.name);
    }
    return names.empty() ? "a scenario with streams" : names;
  }
  /// "start" or "trajectory/start".
  bool ask_reaction(const std::string& text) {
    const std::size_t slash = text.rfind('/');
    scenario::Requirement made;
    for (const scenario::Reaction kind :
         {scenario::Reaction::start, scenario::Reaction::halt, scenario::Reaction::suspend, scenario::Reaction::resume,
          scenario::Reaction::reset})
      if (scenario::spelling(kind) == (slash == std::string::npos ? text : text.substr(slash + 1)))
        made.reaction = kind;
    if (!made.reaction)
      return mistake("--reaction", "no such reaction", json::quote(text),
                     "start, halt, suspend, resume or reset, behind PROGRAM/ if there are several");
    if (slash != std::string::npos) {
      made.program = text.substr(0, slash);
      if (std::ranges::none_of(resolved_.programs, [&](const auto& each) { return each.name == *made.program; }))
        return mistake("--reaction", "no such Program", json::quote(*made.program), "the name of a Program");
    } else if (resolved_.programs.empty()) {
      return mistake("--reaction", "a scenario without Programs", json::quote(text), "\"programs\"");
    }
    made.within.emplace().time = no_limit;
    subject_ = made;
    return true;
  }
  std::optional<std::uint64_t> frame_number() const {
    const std::string& text = *options_.frame;
    if (text.empty() || text.size() > 18 ||
        !std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; }))
      return std::nullopt;
    return std::stoull(text);
  }
  std::optional<models::StreamIndex> stream() const {
    return subject_ && subject_->stream ? stream_of(*subject_->stream) : std::nullopt;
  }

  ExitStatus answer_frame() {
    explain::FrameQuestion question{.stream = stream()};
    question.which = options_.lost ? explain::FrameQuestion::Which::lost : explain::FrameQuestion::Which::number;
    if (options_.frame) question.number = *frame_number();
    const std::string whose =
        question.stream ? "stream " + resolved_.plan.streams[question.stream->value].name : "all streams";
    explanation_.question =
        whose + (options_.lost ? ": the first frame that was lost" : fmt::format(": frame {}", question.number));
    explanation_.frames = explain::explain_frame(resolved_, question, [&] { return interrupt_.requested(); });
    if (explanation_.frames.empty() && !interrupt_.requested())
      explanation_.question += options_.lost ? "; none was" : "; there was none";
    return print();
  }

  /// The scenario with the one requirement that is asked about: of none, that which comes nearest to its limit, or the
  /// slowest stream.
  ExitStatus answer_figure() {
    scenario::Scenario asked = resolved_.scenario;
    if (subject_) asked.require = {*subject_};
    auto resolved = scenario::resolve(asked, diagnostics_);
    if (!resolved) return refuse();
    std::optional<RequirementResult> result = nearest_to_limit(*resolved);
    if (interrupt_.requested()) return ExitStatus::interrupted;
    if (!result) {
      explanation_.question = "all streams: the slowest frame";
      explanation_.frames = explain::explain_frame(*resolved, {}, [&] { return interrupt_.requested(); });
      return print();
    }
    if (!has_time(*result) && !options_.adversarial && !options_.bound && stream()) {  // of losses
      explanation_.question = result->text;
      explanation_.frames =
          explain::explain_frame(*resolved, {.stream = stream(), .which = explain::FrameQuestion::Which::lost},
                                 [&] { return interrupt_.requested(); });
      if (explanation_.frames.empty()) explanation_.question += ": none was lost";
      return print();
    }
    if (!has_time(*result)) {
      mistake("command line", "nothing that takes time", result->text, "a requirement of a latency or a reaction");
      return refuse();
    }
    if (!subject_ && result->requirement) {
      const scenario::RequiredFigure& required = resolved->requirements[*result->requirement];
      result->requirement = required.part;  // of those that are left
      asked.require = {resolved_.scenario.require[required.entry]};
      resolved = scenario::resolve(asked, diagnostics_);
      if (!resolved) return refuse();
    }
    return explain_result(*resolved, std::move(*result));
  }

  static bool has_time(const RequirementResult& result) {
    return result.taken_as == RequirementKind::latency || result.taken_as == RequirementKind::jitter ||
           result.taken_as == RequirementKind::reaction;
  }

  std::optional<RequirementResult> nearest_to_limit(const scenario::Resolved& resolved) const {
    scenario::Run run(resolved);
    while (!run.advance(100'000))
      if (interrupt_.requested()) return std::nullopt;
    const results::RunResult all = evaluation::evaluate(run, false);
    std::optional<RequirementResult> nearest;
    double share = -1;
    for (const RequirementResult& each : all.requirements) {
      if (!each.requirement) continue;
      if (subject_) return each;
      if (!has_time(each) || !each.limit || !each.measured) continue;
      const double its =
          static_cast<double>(each.measured->ps()) / static_cast<double>(std::max<std::int64_t>(each.limit->ps(), 1));
      if (its <= share) continue;
      share = its;
      nearest = each;
    }
    return nearest;
  }

  ExitStatus explain_result(const scenario::Resolved& resolved, RequirementResult result) {
    std::optional<analysis::Bounds> bounds;
    if (options_.adversarial || options_.bound)
      bounds = analysis::bound(resolved, {.interrupted = [&] { return interrupt_.requested(); }});
    scenario::Scenario run = resolved.scenario;
    std::unique_ptr<scenario::Resolved> worst;
    verify::Search found;
    if (options_.adversarial) {
      verify::SearchOptions search = options_.search;
      search.events = static_cast<std::uint64_t>(options_.budget * 1e6);
      search.interrupted = [&] { return interrupt_.requested(); };
      found = verify::search(resolved, *bounds, search);
      const auto of_it = std::ranges::find_if(found.findings, [&](const verify::Finding& each) {
        return each.requirement.requirement == result.requirement;
      });
      if (of_it != found.findings.end() && of_it->longest.measured) {
        run = of_it->longest.run.scenario();
        result.measured = of_it->longest.measured;
      }
      worst = scenario::resolve(run, diagnostics_);
      if (!worst) return refuse();
    }
    const scenario::Resolved& looked_at = worst ? *worst : resolved;
    const bool is_required = !result.limit || *result.limit != no_limit;
    explanation_.question = (is_required       ? results::titled(result)
                             : options_.stream ? "stream " + *options_.stream
                                               : "reaction " + options_.reaction.value_or("")) +
                            (options_.adversarial ? ": the worst run that was found" : ": the run as it is");
    if (!result.measured)
      explanation_.question += "; there was none";
    else
      explain::explain_measured(looked_at, result, explanation_, [&] { return interrupt_.requested(); });
    if (options_.bound) add_bound(*bounds, result, run);
    return print();
  }

  void add_bound(const analysis::Bounds& bounds, const RequirementResult& result, const scenario::Scenario& run) {
    const analysis::RequirementBound& bound = bounds.requirements[*result.requirement];
    if (!bound.duration) {
      explanation_.question += "; no bound: " + bound.reason;
      return;
    }
    explanation_.bound = bound.duration;
    if (!result.measured) return;
    for (const verify::SlackPart& part : verify::parts_in_order({result, *result.measured, *bound.duration, run},
                                                                bounds, [&] { return interrupt_.requested(); }))
      explanation_.shares.push_back({part.where, part.what, part.bound, part.run});
  }

  ExitStatus print() const {
    if (interrupt_.requested()) return ExitStatus::interrupted;
    const std::string page =
        options_.scenario.is_json()
            ? json::pretty(json::write_record(describe(json::Type<explain::Explanation>{}), &explanation_))
            : explain::text_of(explanation_);
    cli::print(page);
    return ExitStatus::pass;
  }

  const ExplainOptions& options_;
  const scenario::Resolved& resolved_;
  InterruptGuard interrupt_;
  json::Diagnostics diagnostics_;
  std::optional<scenario::Requirement> subject_;
  explain::Explanation explanation_;
};

ExitStatus run(const ExplainOptions& options) {
  const auto resolved = load(options.scenario);
  if (!resolved) return ExitStatus::bad_input;
  return Asking(options, *resolved).answer();
}

}  // namespace

void add_explain_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("explain", "Say why a frame or a reaction was late, part by part");
  const auto options = std::make_shared<ExplainOptions>();
  add_scenario_options(command, options->scenario);
  command.add_option("--stream", options->stream, "About this stream: its slowest frame").type_name("NAME");
  command.add_option("--reaction", options->reaction, "About the longest such reaction: start, or PROGRAM/start")
      .type_name("KIND");
  command
      .add_option("--requirement", options->requirement,
                  "About what requirement number N of the scenario asks, from 1; without any of the three: about what "
                  "comes nearest to its limit")
      .type_name("N");
  command.add_flag("--worst", options->worst, "The slowest of the run (as without this option)");
  command
      .add_option("--frame", options->frame,
                  "Frame number K of the stream, from 0, to each of its ends, also if it was lost")
      .type_name("K");
  command.add_flag("--lost", options->lost, "The first frame that was lost: where and why");
  command.add_flag("--adversarial", options->adversarial,
                   "In the worst run that the scenario allows, as far as takt verify finds it");
  command.add_flag("--bound", options->bound, "The bound as well, part by part beside the run");
  command.add_option("--seeds", options->search.seeds, "With --adversarial: runs of the scenario as it is")
      .between(1u, 100'000u)
      .type_name("N");
  command.add_option("--budget", options->budget, "With --adversarial: what the search may cost, in millions of events")
      .between(0.0, 1e6)
      .type_name("M");
  command.footer(
      "Examples:\n"
      "  takt explain scenarios/robot-arm.json                              what comes nearest to its limit\n"
      "  takt explain scenarios/robot-arm.json --stream camera              the slowest frame of a stream, hop by hop\n"
      "  takt explain scenarios/robot-arm.json --reaction start --bound     the critical path of a reaction, and the "
      "bound beside it\n"
      "  takt explain scenarios/robot-arm.json --requirement 6 --adversarial --format json\n"
      "Exit status: 0, 2 bad input, 3 internal error, 130 interrupted.");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace takt::cli
