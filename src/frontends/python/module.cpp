// SPDX-License-Identifier: Apache-2.0
// The extension module takt._takt: values of takt handed to Python. What people see is takt/__init__.py, which makes
// objects of them.
//
// Whatever takes long runs without the interpreter's lock; it asks `keep_going` ten times a second, which takes the
// lock for that moment, looks for Ctrl-C and tells how far things are.
#include <pybind11/numpy.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <memory>
#include <optional>

#include "analysis/bounds.hpp"
#include "analysis/report.hpp"
#include "chart/sequence_chart.hpp"
#include "chart/svg.hpp"
#include "evaluation/evaluate.hpp"
#include "explain/ask.hpp"
#include "json/quantity.hpp"
#include "json/record.hpp"
#include "output/frame_columns.hpp"
#include "output/playback.hpp"
#include "output/text_report.hpp"
#include "python/common.hpp"
#include "report/replay.hpp"
#include "report/run_page.hpp"
#include "results/behaviour.hpp"
#include "results/result_json.hpp"
#include "results/version.hpp"
#include "scenario/resolve.hpp"
#include "study/compare.hpp"
#include "study/content.hpp"
#include "study/point.hpp"
#include "study/report.hpp"
#include "study/report_charts.hpp"
#include "study/runner.hpp"
#include "study/store.hpp"
#include "verify/report.hpp"
#include "verify/verification.hpp"

namespace takt::python {
namespace {

/// A read-only NumPy array over a vector that somebody else owns.
template <class T, class Owner>
py::array column(const std::vector<T>& values, const std::shared_ptr<Owner>& owner) {
  auto* const kept = new std::shared_ptr<Owner>(owner);
  const py::capsule release(kept, [](void* pointer) { delete static_cast<std::shared_ptr<Owner>*>(pointer); });
  py::array_t<T> array(static_cast<py::ssize_t>(values.size()), values.data(), release);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

Scenario scenario_of(std::unique_ptr<scenario::Resolved> resolved, const json::Diagnostics& diagnostics) {
  if (!resolved) throw mistake_of(diagnostics);
  return {std::move(resolved), diagnostics.to_text()};
}

/// What a run leaves behind. It keeps no more of the run than was asked for.
struct Run {
  std::shared_ptr<scenario::Resolved> resolved;
  results::RunResult result;
  std::shared_ptr<output::FrameColumns> frames;
  std::vector<std::string> streams;  // names by index
  std::vector<std::string> nodes;
};

/// Columns of frames speak of a network that is gone after the run: what they need of it is copied before.
Run run(const Scenario& scenario, bool keep_frames, const Progress& progress) {
  Run done{scenario.resolved, {}, nullptr, {}, {}};
  Watch watch(progress);
  {
    const py::gil_scoped_release unlocked;
    scenario::Run live(*scenario.resolved);
    std::optional<output::Playback> playback;  // so that rows have the order that files have
    std::optional<output::Tape> tape;
    const auto told = [&] {
      if (playback) playback->play(live.simulation().now());
    };
    if (keep_frames) {
      done.frames = std::make_shared<output::FrameColumns>(live.network());
      playback.emplace(*done.frames);
      done.frames->look_at(playback->moment());
      tape.emplace(live.network(), 0,
                   output::TapeWants{
                       .kinds = output::TapeWants::bits_of({models::Occurrence::received, models::Occurrence::drop})});
      playback->add(*tape);
      live.simulation().set_trace(&*tape);
      for (const models::Stream& stream : live.network().traffic().streams()) done.streams.push_back(stream.name);
      for (const auto& node : live.network().plan().nodes) done.nodes.push_back(node.name);
    }
    const double wanted = static_cast<double>(live.end().since_start().ps());
    constexpr std::uint64_t events_a_slice = 100'000;
    bool is_complete = false;
    while (!(is_complete = live.advance(events_a_slice))) {
      told();
      if (!watch.keep_going(static_cast<double>(live.simulation().now().since_start().ps()) / wanted)) break;
    }
    told();
    if (is_complete && done.frames) done.frames->close();
    live.simulation().set_trace(nullptr);
    done.result = evaluation::evaluate(live, !is_complete);
  }
  watch.raise();
  return done;
}

py::dict frames_of(const Run& run) {
  if (!run.frames) throw Mistake("the frames were not kept: run(frames=True)");
  const output::FrameColumns& f = *run.frames;
  py::dict columns;
  columns["stream"] = column(f.stream, run.frames);
  columns["sequence"] = column(f.sequence, run.frames);
  columns["event"] = column(f.event, run.frames);
  columns["node"] = column(f.node, run.frames);
  columns["port"] = column(f.port, run.frames);
  columns["produced_ps"] = column(f.produced_ps, run.frames);
  columns["at_ps"] = column(f.at_ps, run.frames);
  columns["latency_ps"] = column(f.latency_ps, run.frames);
  columns["reason"] = column(f.reason, run.frames);
  return columns;
}

/// Edges and counts of a stream's latencies.
py::dict histogram_of(const Run& run, const std::string& name) {
  const auto found = std::find_if(run.result.streams.begin(), run.result.streams.end(),
                                  [&](const auto& stream) { return stream.name == name; });
  if (found == run.result.streams.end()) throw Mistake("no stream is called " + json::quote(name));
  struct Columns {
    std::vector<std::int64_t> from_ps, to_ps, count;
  };
  const auto columns = std::make_shared<Columns>();
  for (const results::HistogramBucket& bucket : found->histogram) {
    columns->from_ps.push_back(bucket.from.ps());
    columns->to_ps.push_back(bucket.to.ps());
    columns->count.push_back(static_cast<std::int64_t>(bucket.count));
  }
  py::dict dict;
  dict["from_ps"] = column(columns->from_ps, columns);
  dict["to_ps"] = column(columns->to_ps, columns);
  dict["count"] = column(columns->count, columns);
  return dict;
}

std::vector<std::string> reasons() {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < static_cast<std::size_t>(models::DropReason::count); ++i)
    names.emplace_back(models::name_of(static_cast<models::DropReason>(i)));
  return names;
}

/// The run once more, watched where it is shown.
std::unique_ptr<report::Replay> replay_of(const Run& run) {
  const Progress nobody;
  Watch watch(nobody);
  std::unique_ptr<report::Replay> replay;
  {
    const py::gil_scoped_release unlocked;
    replay = std::make_unique<report::Replay>(*run.resolved, run.result);
    replay->advance([&] { return !watch.keep_going(0); });
  }
  watch.raise();
  return replay;
}

/// Of each kind of reaction the slowest.
std::vector<std::string> timeline_of(const Run& run) {
  std::vector<std::string> pictures;
  for (const chart::SequenceChart& chart : replay_of(run)->sequences())
    pictures.push_back(chart::picture(chart::sequence_chart(chart)));
  return pictures;
}

std::string bounds_of(const Scenario& scenario, const std::string& clock_error) {
  analysis::BoundOptions how;
  const auto error = json::parse_duration(clock_error);
  if (!error) throw Mistake("clock_error: not a duration: " + json::quote(clock_error));
  how.clock_error = *error;
  const py::gil_scoped_release unlocked;
  return analysis::json_report(*scenario.resolved, analysis::bound(*scenario.resolved, how));
}

std::string verification_of(const Scenario& scenario, unsigned seeds, unsigned jobs, double budget,
                            const Progress& progress) {
  Watch watch(progress);
  std::string report;
  {
    const py::gil_scoped_release unlocked;
    verify::Options what;
    what.search.seeds = seeds;
    what.search.jobs = jobs;
    what.search.events = static_cast<std::uint64_t>(budget * 1e6);
    std::atomic<double> share = 0;
    what.search.progress = [&](std::uint64_t events, std::uint64_t of) {
      share = of == 0 ? 1 : static_cast<double>(events) / static_cast<double>(of);
    };
    what.search.interrupted = [&] { return !watch.keep_going(share); };
    what.proof.interrupted = what.search.interrupted;
    const verify::Verification found = verify::verify(*scenario.resolved, what);
    report = verify::json_report(scenario.resolved->scenario.name, found, std::vector<std::string>(found.lines.size()));
  }
  watch.raise();
  return report;
}

/// A frame of a stream by its number, the first that was lost, or the slowest; of any stream without a name.
std::string explanation_of(const Scenario& scenario, const std::optional<std::string>& stream,
                           std::optional<std::uint64_t> frame, bool lost, const Progress& progress) {
  using Which = explain::FrameQuestion::Which;
  if (frame && (lost || !stream))
    throw Mistake(lost ? "frame and lost: one of them" : "a frame of no stream: explain(stream, frame=...)");
  explain::FrameQuestion question;
  question.which = frame ? Which::number : lost ? Which::lost : Which::slowest;
  question.number = frame.value_or(0);
  if (stream && !(question.stream = explain::stream_named(*scenario.resolved, *stream)))
    throw Mistake("no stream is called " + json::quote(*stream));
  Watch watch(progress);
  explain::Explanation made;
  made.scenario = scenario.resolved->scenario.name;
  made.question = (stream ? "stream " + *stream : "all streams") + (frame  ? ": frame " + std::to_string(*frame)
                                                                    : lost ? ": the first frame that was lost"
                                                                           : ": the slowest frame");
  {
    const py::gil_scoped_release unlocked;
    made.frames = explain::explain_frame(*scenario.resolved, question, [&] { return !watch.keep_going(0); });
  }
  watch.raise();
  return json::write(made);
}

std::string comparison_of(const Scenario& a, const Scenario& b, std::uint32_t pairs, std::uint64_t seed, unsigned jobs,
                          const Progress& progress) {
  if (pairs == 0) throw Mistake("pairs: at least one");
  const auto plan_of = [&](const Scenario& scenario) {
    json::Diagnostics diagnostics;
    auto document =
        json::parse(json::encode(scenario.resolved->scenario), scenario.resolved->scenario.name, diagnostics);
    if (!document) throw mistake_of(diagnostics);
    return study::plain_plan(std::move(*document), pairs, seed);
  };
  const study::Plan plan_a = plan_of(a);
  const study::Plan plan_b = plan_of(b);
  Watch watch(progress);
  study::Comparison made;
  {
    const py::gil_scoped_release unlocked;
    study::RunOptions how;
    how.jobs = jobs;
    double share = 0;
    how.progress = [&](const char*, std::uint64_t done, std::uint64_t of) {
      share = of == 0 ? 1 : static_cast<double>(done) / static_cast<double>(of);
    };
    how.interrupted = [&] { return !watch.keep_going(share); };
    made = study::compare(plan_a, plan_b, how);
  }
  watch.raise();
  if (!made.problem.empty()) throw Mistake(made.problem);
  made.a = a.resolved->scenario.name;
  made.b = b.resolved->scenario.name;
  return json::write(made);
}

using PlanPointer = std::shared_ptr<study::Plan>;

PlanPointer load_plan(const std::string& path) {
  json::Diagnostics diagnostics;
  auto plan = study::load_plan(path, diagnostics);
  if (!plan) throw mistake_of(diagnostics);
  return plan;
}

/// Runs what is missing of a study into a store, as takt study does, with its worker processes. How many points it ran,
/// and the digest of the results.
py::tuple run_study(const PlanPointer& plan, const std::string& path, bool resume, unsigned jobs,
                    const Progress& progress) {
  Watch watch(progress);
  study::RunSummary summary;
  std::uint64_t digest = 0;
  std::uint64_t count = 0;
  std::string problem;
  {
    const py::gil_scoped_release unlocked;
    study::RunOptions how;
    how.jobs = jobs;
    double share = 0;
    how.progress = [&](const char*, std::uint64_t done, std::uint64_t of) {
      share = of == 0 ? 1 : static_cast<double>(done) / static_cast<double>(of);
    };
    how.interrupted = [&] { return !watch.keep_going(share); };
    std::unique_ptr<study::Store> store;
    std::vector<bool> finished(plan->points(), false);
    if (resume) store = study::Store::open(path, problem);
    if (store) problem = study::why_not_resumed(store->header(), *plan, path);
    if (store && problem.empty()) problem = store->finished(finished);
    if (problem.empty()) problem = study::validate(*plan, how, finished);
    if (problem.empty() && !resume) store = study::Store::create(path, *plan, problem);
    if (problem.empty()) summary = study::run_study(*plan, *store, how, finished);
    if (problem.empty()) problem = summary.problem;
    if (problem.empty()) problem = store->results_digest(digest, count);
    if (store) store->tidy();
  }
  watch.raise();
  if (!problem.empty()) throw Mistake(problem);
  return py::make_tuple(summary.ran, count, digest);
}

/// A point here and now, without a process of its own.
py::dict run_point(const PlanPointer& plan, std::uint64_t point) {
  if (point >= plan->points()) throw Mistake("the study has points 0 to " + std::to_string(plan->points() - 1));
  study::Outcome outcome;
  {
    const py::gil_scoped_release unlocked;
    outcome = study::run_point(*plan, point);
  }
  py::dict dict;
  dict["status"] = std::string(study::name_of(outcome.status));
  dict["error"] = outcome.error;
  dict["passes"] = outcome.passes;
  dict["verdict"] = outcome.verdict;
  dict["digest"] = outcome.digest;
  dict["events"] = outcome.events;
  dict["values"] = outcome.values;
  return dict;
}

using ContentPointer = std::shared_ptr<study::Content>;

ContentPointer read_store(const std::string& path) {
  std::string problem;
  ContentPointer content = study::read_store(path, problem);
  if (!content) throw Mistake(problem);
  return content;
}

std::size_t number_of(const auto& list, const std::string& name, const char* what) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const auto& each) { return each.name == name; });
  if (found == list.end()) throw Mistake(std::string("no ") + what + " is called " + json::quote(name));
  return static_cast<std::size_t>(found - list.begin());
}

/// The levels of a factor, one a row, as indices into `texts`.
py::dict factor_of(const ContentPointer& content, const std::string& name) {
  const std::size_t factor = number_of(content->factors, name, "factor");
  const auto levels = std::make_shared<std::vector<std::int32_t>>();
  for (const std::uint32_t variant : content->variant)
    levels->push_back(static_cast<std::int32_t>(content->variants[variant][factor]));
  py::dict dict;
  dict["level"] = column(*levels, levels);
  dict["texts"] = content->factors[factor].texts;
  dict["numbers"] = column(content->factors[factor].numbers, content);
  dict["unit"] = content->factors[factor].unit;
  return dict;
}

std::string figure(std::string chart) {
  if (chart.empty()) throw Mistake("there is nothing to draw of these");
  return chart::picture(std::move(chart));
}

}  // namespace
}  // namespace takt::python

PYBIND11_MODULE(_takt, m) {
  using namespace takt;
  using namespace takt::python;
  m.doc() = "What takt/__init__.py is made of; use that.";
  m.attr("version") = results::version;
  m.attr("behaviour") = results::behaviour();
  m.attr("reasons") = reasons();
  static PyObject* const mistake = PyErr_NewExceptionWithDoc(
      "takt.Mistake",
      "Something is wrong with what takt was given. The text names places; `diagnostics` has the same as a list.",
      PyExc_ValueError, nullptr);
  m.attr("Mistake") = py::reinterpret_borrow<py::object>(mistake);
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const Mistake& found) {
      const py::object value = py::reinterpret_borrow<py::object>(mistake)(found.text);
      value.attr("diagnostics") = found.json.empty()
                                      ? py::object(py::list())
                                      : py::module_::import("json").attr("loads")(found.json)["diagnostics"];
      PyErr_SetObject(mistake, value.ptr());
    }
  });

  py::class_<Scenario>(m, "Scenario")
      .def_property_readonly("name", [](const Scenario& s) { return s.resolved->scenario.name; })
      .def_readonly("warnings", &Scenario::warnings)
      .def("to_json", [](const Scenario& s) { return json::encode(s.resolved->scenario); })
      .def("check", [](const Scenario& s) { return output::check_report(*s.resolved); });
  m.def("load_file", [](const std::string& path, const std::vector<std::string>& overrides) {
    json::Diagnostics diagnostics;
    auto resolved = scenario::load_file(path, overrides, diagnostics);
    return scenario_of(std::move(resolved), diagnostics);
  });
  m.def("load_text", [](const std::string& text, const std::string& name, const std::vector<std::string>& overrides) {
    json::Diagnostics diagnostics;
    auto resolved = scenario::load_text(text, name, overrides, diagnostics);
    return scenario_of(std::move(resolved), diagnostics);
  });

  py::class_<Run>(m, "Run")
      .def("to_json", [](const Run& r) { return results::run_json(r.result); })
      .def("report", [](const Run& r) { return output::run_report(r.result); })
      .def("frames", &frames_of)
      .def_readonly("streams", &Run::streams)
      .def_readonly("nodes", &Run::nodes)
      .def("histogram", &histogram_of)
      .def("timeline", &timeline_of)
      .def("page", [](const Run& r) { return report::run_page(*r.resolved, r.result, *replay_of(r)); });
  m.def("run", &run);
  m.def("bound", &bounds_of);
  m.def("verify", &verification_of);
  m.def("explain", &explanation_of);
  m.def("compare", &comparison_of);
  add_questions(m);

  py::class_<study::Plan, PlanPointer>(m, "Plan")
      .def_property_readonly("name", [](const study::Plan& p) { return p.study.name; })
      .def_property_readonly("points", &study::Plan::points)
      .def("variant", [](const study::Plan& p, std::uint64_t point) {
        return study::name_of(p, p.variants.at(p.variant_of(point)));
      });
  m.def("load_plan", &load_plan);
  m.def("run_study", &run_study);
  m.def("run_point", &run_point);

  py::class_<study::Content, ContentPointer>(m, "Content")
      .def_property_readonly("name", [](const study::Content& c) { return c.header.name; })
      .def_property_readonly("behaviour", [](const study::Content& c) { return c.header.maker.behaviour; })
      .def("difference", [](const study::Content& c,
                            const std::string& path) { return results::difference_to(c.header.maker, path); })
      .def_property_readonly("factors",
                             [](const study::Content& c) {
                               std::vector<std::string> names;
                               for (const auto& f : c.factors) names.push_back(f.name);
                               return names;
                             })
      .def_property_readonly("measures",
                             [](const study::Content& c) {
                               std::vector<std::string> names;
                               for (const auto& f : c.measures) names.push_back(f.name);
                               return names;
                             })
      .def_property_readonly("passes", [](const study::Content& c) { return c.passes; })
      .def_property_readonly("status",
                             [](const study::Content& c) {
                               std::vector<std::string> names;
                               for (const auto s : c.status) names.emplace_back(study::name_of(s));
                               return names;
                             })
      .def("replication", [](const ContentPointer& c) { return column(c->replication, c); })
      .def("factor", &factor_of)
      .def("measure",
           [](const ContentPointer& c, const std::string& name) {
             return column(c->measures[number_of(c->measures, name, "measure")].values, c);
           })
      .def("unit", [](const study::Content& c,
                      const std::string& name) { return c.measures[number_of(c.measures, name, "measure")].unit; })
      .def("summary", [](const study::Content& c) { return study::text_summary(c); })
      .def("report", [](const study::Content& c) { return study::html_report(c); })
      .def(
          "heatmap",
          [](const study::Content& c, const std::string& rows, const std::string& columns, const std::string& measure) {
            return figure(study::heat_map_chart(c, number_of(c.factors, rows, "factor"),
                                                number_of(c.factors, columns, "factor"),
                                                number_of(c.measures, measure, "measure")));
          })
      .def("effect",
           [](const study::Content& c, const std::string& factor, const std::string& measure) {
             return figure(study::main_effect_chart(c, number_of(c.factors, factor, "factor"),
                                                    number_of(c.measures, measure, "measure")));
           })
      .def("pareto", [](const study::Content& c, const std::string& a, const std::string& b) {
        return figure(study::pareto_chart(c, number_of(c.measures, a, "measure"), number_of(c.measures, b, "measure")));
      });
  m.def("read_store", &read_store);
}
