// SPDX-License-Identifier: Apache-2.0
#include "tests/generator/check_scenario.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <set>

#include "analysis/bounds.hpp"
#include "analysis/report.hpp"
#include "analysis/thread_bound.hpp"
#include "evaluation/evaluate.hpp"
#include "explain/ask.hpp"
#include "json/document.hpp"
#include "json/quantity.hpp"
#include "output/text_report.hpp"
#include "results/result_json.hpp"
#include "scenario/resolve.hpp"
#include "scenario/division/divided_run.hpp"
#include "scenario/run/run.hpp"
#include "study/phases.hpp"
#include "tests/simulation/explain/checked_ways.hpp"
#include "tests/generator/check_outputs.hpp"
#include "tests/generator/schema_validation.hpp"
#include "tests/experiments/property/twins.hpp"
#include "tests/wire_checker/checked_run.hpp"
#include "verify/monitor.hpp"
#include "verify/report.hpp"

namespace takt::generator {
namespace {

using json::to_text;

std::string took(sim::Duration time) { return to_text(time); }

/// Remembers every frame that a trace names.
class Handles final : public sim::TraceSink {
 public:
  void record(const sim::TraceRecord& record) override {
    if (record.kind == static_cast<std::uint32_t>(models::Occurrence::produced))
      handles.insert(static_cast<std::uint32_t>(record.what));
  }
  std::set<std::uint32_t> handles;
};

class Checks {
 public:
  Checks(const scenario::Resolved& resolved, std::string file, const CheckOptions& options, Checked& checked)
      : r_(resolved), file_(std::move(file)), options_(options), checked_(checked) {}

  void all(const std::string& text) {
    check("run", [&] { plain_run(); });
    if (!result_) return;
    check("load", [&] { copy(text); });
    check("digest", [&] { digests(); });
    constexpr std::array parts = {2U, 3U, 4U, 8U};
    const scenario::Division division = scenario::divide_at_random(r_, parts[digest_ % parts.size()], digest_);
    if (division.is_divided()) check("threads", [&] { threads(division); });
    if (is_ideal()) check("wire", [&] { wire(); });
    check("frames", [&] { frames(); });
    check("ways", [&] { ways(); });
    if (r_.scenario.clocks.gptp) check("clocks", [&] { clocks(); });
    check("lost", [&] { lost(); });
    check("outputs", [&] {
      const std::string mistake = mistake_in_outputs(r_, *result_);
      expect(mistake.empty(), [&] { return mistake; });
    });
    if (r_.applications.empty()) {
      check("bound", [&] { bounds(); });
      if (text.find("\"auto\"") == std::string::npos)
        check("order", [&] { orders(text); });  // what takt chooses may rest on the order
      check("phases", [&] { phases(); });
      if (options_.verify_events > 0) check("verify", [&] { verification(); });
    }
  }

 private:
  void check(const char* name, const std::function<void()>& what) {
    if (!options_.only.empty() && options_.only != name && std::string_view(name) != "run") return;
    checked_.done.emplace_back(name);
    present_ = name;
    try {
      what();
    } catch (const std::exception& broken) {
      wrong(broken.what());
    }
  }
  /// Of each check the first.
  void wrong(std::string message) {
    if (std::ranges::none_of(checked_.findings, [&](const Finding& each) { return each.check == present_; }))
      checked_.findings.push_back({present_, std::move(message)});
  }
  void expect(bool holds, const std::function<std::string()>& message) {
    if (!holds) wrong(message());
  }

  bool is_ideal() const {
    if (r_.scenario.clocks.gptp || r_.scenario.clocks.all || !r_.scenario.clocks.nodes.empty() ||
        r_.scenario.clocks.model != scenario::ClockModel::ideal)
      return false;
    // Nor are frames over the bypass of a station.
    if (std::ranges::any_of(r_.script, [](const scenario::ResolvedAction& action) {
          return std::holds_alternative<scenario::ResolvedBypass>(action.what);
        }))
      return false;
    // Nor is a station that forwards with jitter and whose host eliminates copies: they end when their random times are
    // over, not when they come.
    for (const models::HostRecoveryPlan& recovery : r_.plan.host_recoveries)
      if (r_.plan.nodes[recovery.host.value].forwarding_jitter) return false;
    // A bridge that cuts through frames that a link may double is not followed (tests/wire_checker/README.md).
    const bool cuts = std::ranges::any_of(r_.plan.port_configs,
                                          [](const models::PortConfig& config) { return config.cut_through != 0; });
    const bool doubles = std::ranges::any_of(r_.scenario.faults, [](const scenario::Fault& fault) {
      const auto* const errors = std::get_if<scenario::FrameErrors>(&fault);
      return errors != nullptr && errors->duplication.has_value();
    });
    return !(cuts && doubles);
  }

  void plain_run() {
    scenario::Run run(r_);
    run.advance();
    checked_.events = run.simulation().event_count();
    digest_ = run.simulation().digest().value();
    result_ = std::make_unique<results::RunResult>(evaluation::evaluate(run, false));
    static_cast<void>(output::run_report(*result_));
    static_cast<void>(output::check_report(r_));
    json::Diagnostics diagnostics;
    expect(json::parse(results::run_json(*result_), "result.json", diagnostics).has_value(),
           [&] { return "result.json: " + diagnostics.to_text(); });
  }

  void copy(const std::string& text) {
    expect(refused_by_schema(text).empty(),
           [&] { return "the schema refuses what the loader takes: " + refused_by_schema(text); });
    const std::string written = json::encode(r_.scenario);
    expect(refused_by_schema(written).empty(),
           [&] { return "the schema refuses the resolved copy: " + refused_by_schema(written); });
    json::Diagnostics diagnostics;
    const auto again = scenario::load_text(written, file_, {}, diagnostics);
    if (!again) return wrong("the resolved copy is refused: " + diagnostics.to_text());
    expect(json::encode(again->scenario) == written,
           [] { return std::string("the copy of the resolved copy differs from it"); });
    expect(digest_of(*again, 0) == digest_, [] { return std::string("the resolved copy has another digest"); });
  }

  static std::uint64_t digest_of(const scenario::Resolved& resolved, std::uint64_t shuffle) {
    scenario::Run run(resolved, shuffle);
    run.advance();
    return run.simulation().digest().value();
  }

  void digests() {
    for (const std::uint64_t key : {1ULL, 0xDEAD'BEEFULL})
      expect(digest_of(r_, key) == digest_,
             [&] { return "the digest depends on the order of equal events (key " + std::to_string(key) + ")"; });
    // In steps of some events it is the same run.
    scenario::Run run(r_);
    while (!run.advance(997)) continue;
    expect(run.simulation().digest().value() == digest_,
           [] { return std::string("the digest of a run in steps differs"); });
    expect(results::run_json(evaluation::evaluate(run, false)) == results::run_json(*result_),
           [] { return std::string("the result of a run in steps differs"); });
  }

  void threads(const scenario::Division& division) {
    scenario::DividedRun run(r_, division);
    while (run.now() < run.end()) run.advance(run.now() + sim::Duration::from_ps(run.end().ps() / 3 + 1));
    expect(results::run_json(evaluation::evaluate(run.gathered(), false)) == results::run_json(*result_),
           [&] { return "the result of a run in " + std::to_string(division.parts) + " parts differs"; });
  }

  void wire() {
    wire_checker::CheckedRun run(r_);
    const std::string found = run.to_the_end().all();
    expect(found.empty(), [&] { return found; });
    expect(run.run.simulation().digest().value() == digest_,
           [] { return std::string("the digest with a recorder differs"); });
  }

  void frames() {
    scenario::Run run(r_);
    Handles handles;
    run.simulation().set_trace(&handles);
    run.advance();
    expect(run.simulation().digest().value() == digest_,
           [] { return std::string("the digest with a recorder differs"); });
    const models::Traffic& traffic = run.network().traffic();
    std::uint64_t in_flight = 0;
    for (const models::Stream& stream : traffic.streams()) {
      expect(stream.delivered + stream.dropped_in_all() <= stream.sent + stream.copies, [&] {
        return "more frames of a stream came or were lost than there were: " + std::to_string(stream.sent) + " sent, " +
               std::to_string(stream.copies) + " copies, " + std::to_string(stream.delivered) + " delivered, " +
               std::to_string(stream.dropped_in_all()) + " dropped";
      });
      in_flight += stream.in_flight();
    }
    expect(traffic.live_frames() <= in_flight, [&] {
      return std::to_string(traffic.live_frames()) + " frames live, " + std::to_string(in_flight) + " are on their way";
    });
    std::uint64_t references = 0;
    for (const std::uint32_t handle : handles.handles) references += traffic.frame({handle}).references;
    expect(references <= in_flight, [&] {
      return std::to_string(references) + " references of live frames, " + std::to_string(in_flight) +
             " frames on their way";
    });
    for (const results::StreamResult& stream : result_->streams)
      expect(stream.sent + stream.copies == stream.delivered + stream.dropped_in_all() + stream.in_flight,
             [&] { return stream.name + ": its frames do not add up"; });
  }

  void ways() {
    scenario::Run run(r_);
    wire_checker::WireChecker checker(
        r_.plan, wire_checker::changes_of(r_), wire_checker::directory_of(run.network()),
        [&run](models::FrameIndex handle) -> const models::Frame& { return run.network().traffic().frame(handle); });
    explain::CheckedWays ways(run, is_ideal() ? &checker : nullptr);
    run.advance();
    const std::string found = ways.finish();
    expect(found.empty(), [&] { return found; });
    expect(run.simulation().digest().value() == digest_,
           [] { return std::string("the digest of a run that is explained differs"); });
    if (!is_ideal()) return;
    checker.finish(run.end().ps());
    expect(checker.violations().all().empty(), [&] { return checker.violations().all(); });
  }

  /// By what the clocks themselves show, not by what is made of it.
  void clocks() {
    struct Looks final : scenario::ClockSampleSink {
      void sample(const scenario::ClockSample& sample) override {
        if (all.empty() || all.back().at != sample.time)
          all.push_back({sample.time, sample.true_offset, sample.true_offset});
        all.back().least = std::min(all.back().least, sample.true_offset);
        all.back().greatest = std::max(all.back().greatest, sample.true_offset);
      }
      struct Look {
        sim::TrueTime at;
        sim::Duration least, greatest;  // from true time
      };
      std::vector<Look> all;
    };
    scenario::Run run(r_);
    Looks looks;
    run.set_clock_sink(&looks);
    run.advance();
    expect(run.simulation().digest().value() == digest_,
           [] { return std::string("the digest of a run whose clocks are looked at differs"); });
    for (const results::RequirementResult& each : result_->requirements) {
      const bool is_of_all = each.subject.empty() || each.subject == scenario::all_clocks;
      if ((each.kind != results::RequirementKind::sync && each.kind != results::RequirementKind::clocks) ||
          !is_of_all || each.verdict != results::Verdict::pass)
        continue;
      // Two clocks near a third one are twice as far from each other at most.
      const sim::Duration limit = each.kind == results::RequirementKind::sync ? *each.limit * 2 : *each.limit;
      for (const Looks::Look& look : looks.all)
        if (look.at.since_start() >= each.from)
          expect(look.greatest - look.least <= limit, [&] {
            return each.text + " passes, and two clocks are " + took(look.greatest - look.least) + " apart at " +
                   took(look.at.since_start());
          });
      const bool is_for_all = each.kind == results::RequirementKind::sync;
      expect(!is_for_all || grandmasters(run) < 2,
             [&] { return each.text + " passes, and there are two grandmasters at the end"; });
    }
    gates_of_gptp();
  }

  /// At the end, of nodes that are up.
  std::size_t grandmasters(const scenario::Run& run) const {
    std::set<std::uint32_t> found;
    for (std::uint32_t n = 0; n < r_.plan.nodes.size(); ++n) {
      const models::gptp::Station* const station = run.network().station(models::NodeIndex{n});
      if (station != nullptr && station->is_up() && station->active_is_grandmaster() && !station->standby())
        found.insert(n);
    }
    return found.size();
  }

  /// A list that never opens the class of gPTP keeps the clocks behind it from following anybody. Where a list begins
  /// late, or is exchanged, the first one may do otherwise.
  void gates_of_gptp() {
    if (std::ranges::any_of(r_.script, [](const scenario::ResolvedAction& action) {
          return std::holds_alternative<scenario::ResolvedGates>(action.what) ||
                 std::holds_alternative<scenario::ResolvedStuckGate>(action.what);
        }))
      return;
    for (const models::LinkPlan& link : r_.plan.links)
      for (const models::LinkPlan::End* const end : {&link.a, &link.b}) {
        const models::PortConfig& config =
            r_.plan.port_configs[end->port_config.value_or(r_.plan.nodes[end->node.value].port_config)];
        const auto& gates = config.shaping.gates;
        if (!r_.plan.gptp[link.a.node.value] || !r_.plan.gptp[link.b.node.value] || !gates ||
            gates->admin_control_list.empty() || gates->admin_base_time > sim::LocalTime())
          continue;
        const bool opens = std::ranges::any_of(gates->admin_control_list, [&](const models::GateControlEntry& entry) {
          return models::contains(entry.gate_states, config.traffic_class_of_priority[7]);
        });
        expect(opens,
               [&] { return "the gates of " + r_.plan.nodes[end->node.value].name + " never open the class of gPTP"; });
      }
  }

  void bounds() {
    analysis::Bounds bounds = analysis::bound(r_);
    static_cast<void>(analysis::text_report(r_, bounds));
    json::Diagnostics diagnostics;
    expect(json::parse(analysis::json_report(r_, bounds), "bounds.json", diagnostics).has_value(),
           [&] { return "the report of bounds: " + diagnostics.to_text(); });
    scenario::Run run(r_);
    run.advance();
    keeps(run, *result_, std::move(bounds));
  }

  /// The run of a study, with phases that the seed draws where nobody gives them: the bounds of the scenario are for
  /// it, too.
  void phases() {
    json::Diagnostics diagnostics;
    const auto drawn = scenario::resolve(study::with_drawn_phases(r_.scenario), diagnostics);
    if (!drawn) return wrong("refused with drawn phases: " + diagnostics.to_text());
    scenario::Run run(*drawn);
    run.advance();
    keeps(run, evaluation::evaluate(run, false), analysis::bound(r_));
  }

  /// No figure of the run exceeds its bound.
  void keeps(const scenario::Run& run, const results::RunResult& result, analysis::Bounds bounds) {
    // What the run itself breaks is no premise of a bound.
    for (const verify::Violation& violation : verify::violations_in(run, result))
      bounds.ledger.violate(violation.assumption, violation.witness);
    const auto stands = [&](const analysis::Assumptions& assumptions) {
      return bounds.ledger.objection(assumptions, r_.scenario.warm_up).empty();
    };
    for (std::size_t s = 0; s < bounds.streams.size(); ++s) {
      const analysis::StreamBound& bound = bounds.streams[s];
      const results::StreamResult& stream = result.streams[s];
      expect(bound.latency || !bound.reason.empty(), [&] { return bound.name + " has neither a bound nor a reason"; });
      if (!stands(bound.assumptions) || !stream.latency) continue;
      expect(stream.latency->min >= bound.least,
             [&] { return bound.name + " took " + took(stream.latency->min) + ", the least is " + took(bound.least); });
      if (bound.latency)
        expect(stream.latency->max <= *bound.latency, [&] {
          return bound.name + " took " + took(stream.latency->max) + ", the bound is " + took(*bound.latency);
        });
      if (bound.reaches_all && bound.latency)
        expect(stream.lost == 0,
               [&] { return bound.name + " loses nothing, but " + std::to_string(stream.lost) + " frames"; });
    }
    for (const analysis::ReactionBound& bound : bounds.reactions)
      if (bound.cause == handshake::Cause::command && bound.bound && stands(bound.assumptions))
        reactions(bound, result);
    for (std::size_t a = 0; a < r_.applications.size(); ++a)
      for (std::size_t t = 0; t < r_.applications[a].threads.size(); ++t) {
        const analysis::ThreadBound bound = analysis::thread_bound(r_, bounds, a, t, r_.scenario.warm_up);
        if (stands(bound.assumptions))
          thread(bound, r_.applications[a].threads[t], result.applications[a].threads[t], result.applications[a].name);
      }
  }

  /// A scenario with another path, since several are as short, is another one.
  void orders(const std::string& text) {
    const std::map<std::string, Ordered> wanted = ordered_bounds(r_);
    for (const property::Twin& twin :
         {property::with_other_streams(text, digest_), property::with_other_nodes(text, digest_),
          property::with_other_links(text, digest_)}) {
      json::Diagnostics diagnostics;
      const auto other = twin.text.empty() ? nullptr : scenario::load_text(twin.text, file_, {}, diagnostics);
      if (other == nullptr) continue;
      const std::map<std::string, Ordered> found = ordered_bounds(*other);
      if (std::ranges::any_of(wanted, [&](const auto& each) {
            return !found.contains(each.first) || found.at(each.first).paths != each.second.paths;
          }))
        continue;
      for (const auto& each : wanted) {  // clang 14 captures no structured binding
        const Ordered& again = found.at(each.first);
        expect(again.latency == each.second.latency, [&] {
          return each.first + ": the bound is " + words_of(each.second.latency) +
                 ", and with another order in the file " + words_of(again.latency);
        });
      }
    }
  }
  struct Ordered {
    std::optional<sim::Duration> latency;
    std::vector<std::string> paths;
  };
  static std::map<std::string, Ordered> ordered_bounds(const scenario::Resolved& resolved) {
    std::map<std::string, Ordered> all;
    for (const analysis::StreamBound& bound : analysis::bound(resolved).streams) {
      Ordered& made = all[bound.name];
      made.latency = bound.latency;
      made.paths = property::passed_by(resolved, resolved.streams[bound.index.value]);
    }
    return all;
  }
  static std::string words_of(const std::optional<sim::Duration>& latency) {
    return latency ? took(*latency) : "unbounded";
  }

  void thread(const analysis::ThreadBound& bound, const scenario::ResolvedThread& thread,
              const results::ThreadResult& found, const std::string& application) {
    const std::string name = application + "/" + found.name;
    if (found.response)
      expect(found.response->min >= bound.least_response && found.response->max <= bound.greatest_response, [&] {
        return name + " responds after " + took(found.response->min) + " to " + took(found.response->max) +
               ", the bounds are " + took(bound.least_response) + " and " + took(bound.greatest_response);
      });
    expect(!bound.is_always_done || (found.missed == 0 && found.response),
           [&] { return name + " misses " + std::to_string(found.missed) + " calls of none"; });
    expect(!bound.is_tested || found.calls.percent == 100.0, [&] { return name + " is done in fewer calls than all"; });
    expect(!bound.loses_nothing || found.lost == 0,
           [&] { return name + " loses " + std::to_string(found.lost) + " values of none"; });
    expect(!bound.most_found || *bound.most_found > thread.buffer || found.overwritten == 0,
           [&] { return name + " overwrites " + std::to_string(found.overwritten) + " values of none"; });
  }

  /// Those to a call that nothing else came across.
  void reactions(const analysis::ReactionBound& bound, const results::RunResult& result) {
    const results::ProgramResult& program = result.programs[bound.program];
    const std::vector<results::ReactionResult>& all = bound.of_tree ? program.tree_reactions : program.reactions;
    const auto kind = scenario::spelling(bound.kind);
    for (const results::ReactionResult& reaction : all) {
      if (reaction.kind != kind || reaction.superseded || !reaction.completed || reaction.cause != "command") continue;
      bool is_alone = true;
      for (const results::ProgramResult& other : result.programs) {
        for (const auto* const list : {&other.reactions, &other.tree_reactions})
          for (const results::ReactionResult& each : *list)
            if (&each != &reaction && each.began <= *reaction.completed &&
                (!each.completed || *each.completed >= reaction.began || each.superseded) &&
                !(each.kind == reaction.kind && each.began == reaction.began))
              is_alone = false;
      }
      if (is_alone)
        expect(*reaction.duration() <= *bound.bound, [&] {
          return program.name + ": " + reaction.kind + " took " + took(*reaction.duration()) + ", the bound is " +
                 took(*bound.bound);
        });
    }
  }

  void verification() {
    verify::Options options;
    options.search.seeds = 2;
    options.search.events = options_.verify_events;
    options.proof.states = options_.most_states;
    options.helps = true;
    const verify::Verification found = verify::verify(r_, options);
    static_cast<void>(verify::text_report(r_.scenario.name, found, std::vector<std::string>(found.lines.size())));
    static_cast<void>(verify::json_report(r_.scenario.name, found, std::vector<std::string>(found.lines.size())));
    expect(!found.contradiction, [&] { return "a contradiction: " + found.contradiction->text; });
    expect(found.lines.size() == result_->requirements.size(),
           [] { return std::string("another number of requirements than in the run"); });
    for (std::size_t i = 0; i < std::min(found.lines.size(), result_->requirements.size()); ++i) {
      const verify::Line& line = found.lines[i];
      const results::RequirementResult& run = result_->requirements[i];
      expect(line.verdict != verify::Conclusion::contradiction, [&] { return run.text + ": a contradiction"; });
      if (run.verdict == results::Verdict::fail)
        expect(line.verdict == verify::Conclusion::refuted,
               [&] { return run.text + ": a run fails it, verify says " + verify::name_of(line.verdict); });
      if (run.measured && line.simulated)
        expect(*run.measured <= *line.simulated || run.kind == results::RequirementKind::sync ||
                   run.kind == results::RequirementKind::clocks,
               [&] {
                 return run.text + ": a run measured " + took(*run.measured) + ", verify at most " +
                        took(*line.simulated);
               });
      if (line.verdict == verify::Conclusion::refuted) replay(i, line);
      for (const verify::Remedy& remedy : line.remedies) try_remedy(line, remedy);
      if (const std::string full = "a full queue may drop frames at "; line.reason.starts_with(full))
        expect(has_limited_queue(line.reason.substr(full.size())),
               [&] { return run.text + ": " + line.reason + ", which has no limit"; });
    }
  }

  /// What is said to help is proved if it is done.
  void try_remedy(const verify::Line& line, const verify::Remedy& remedy) {
    scenario::Scenario changed = r_.scenario;
    remedy.apply(changed);
    json::Diagnostics diagnostics;
    const auto again = scenario::resolve(std::move(changed), diagnostics);
    if (!again) return wrong(remedy.what + " " + remedy.value + " is refused: " + diagnostics.to_text());
    verify::Options options;
    options.search.seeds = 2;
    options.search.events = options_.verify_events;
    const verify::Verification found = verify::verify(*again, options);
    expect(found.lines[*line.requirement.requirement].verdict == verify::Conclusion::pass, [&] {
      return line.requirement.text + ": with " + remedy.what + " " + remedy.value + " it is " +
             verify::name_of(found.lines[*line.requirement.requirement].verdict);
    });
  }

  /// "sw:1"
  bool has_limited_queue(const std::string& place) const {
    const std::size_t colon = place.rfind(':');
    for (const models::LinkPlan& link : r_.plan.links)
      for (const models::LinkPlan::End* const end : {&link.a, &link.b}) {
        const models::NodePlan& node = r_.plan.nodes[end->node.value];
        if (node.name != place.substr(0, colon) || std::to_string(end->port) != place.substr(colon + 1)) continue;
        return std::ranges::any_of(r_.plan.port_configs[end->port_config.value_or(node.port_config)].queue_limits,
                                   &models::QueueLimit::is_finite);
      }
    return false;
  }

  /// A frame is said to be lost if some stream has lost one, and then of such a stream; where copies are told apart,
  /// one that a listener misses.
  void lost() {
    const std::vector<explain::ExplainedFrame> frames =
        explain::explain_frame(r_, {.which = explain::FrameQuestion::Which::lost});
    const auto has_lost = [](const results::StreamResult& stream) { return stream.lost > 0; };
    if (frames.empty())
      return expect(r_.scenario.warm_up > sim::Duration() || std::ranges::none_of(result_->streams, has_lost),
                    [] { return std::string("a stream has lost frames, and none is explained"); });
    const auto stream = std::ranges::find(result_->streams, frames.front().stream, &results::StreamResult::name);
    if (r_.scenario.warm_up > sim::Duration() || stream == result_->streams.end()) return;
    expect(has_lost(*stream), [&] {
      return "frame " + std::to_string(frames.front().sequence) + " of " + stream->name +
             " is said to be lost, and nothing of it is";
    });
  }

  void replay(std::size_t number, const verify::Line& line) {
    json::Diagnostics diagnostics;
    if (!line.worst) return wrong(line.requirement.text + ": refuted without a run");
    const auto again = scenario::load_text(json::encode(line.worst.scenario()), file_, {}, diagnostics);
    if (!again) return wrong(line.requirement.text + ": its worst run is refused: " + diagnostics.to_text());
    scenario::Run run(*again);
    run.advance();
    const results::RunResult result = evaluation::evaluate(run, false);
    expect(number < result.requirements.size() && result.requirements[number].verdict == results::Verdict::fail,
           [&] { return line.requirement.text + ": refuted, but its worst run passes"; });
  }

  const scenario::Resolved& r_;
  const std::string file_;
  const CheckOptions& options_;
  Checked& checked_;
  std::string present_;
  std::uint64_t digest_ = 0;
  std::unique_ptr<results::RunResult> result_;
};

}  // namespace

Checked check_scenario(const std::string& text, const std::string& file, const CheckOptions& options) {
  Checked checked;
  json::Diagnostics diagnostics;
  std::unique_ptr<scenario::Resolved> resolved;
  try {
    resolved = scenario::load_text(text, file, {}, diagnostics);
  } catch (const std::exception& broken) {
    checked.findings.push_back({"load", broken.what()});
    return checked;
  }
  if (!resolved) {
    checked.refusal = diagnostics.to_text();
    if (!diagnostics.has_errors()) checked.findings.push_back({"load", "refused without a reason"});
    return checked;
  }
  checked.is_sound = true;
  Checks(*resolved, file, options, checked).all(text);
  return checked;
}

}  // namespace takt::generator
