// SPDX-License-Identifier: Apache-2.0
#include "papers/validation/measure.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

#include "analysis/bounds.hpp"
#include "analysis/server_network_file.hpp"
#include "evaluation/evaluate.hpp"
#include "results/result_json.hpp"
#include "scenario/figures/figure.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "verify/adversary.hpp"

namespace takt::papers::validation {
namespace {

using json::Node;

enum class Way { run, bound, search, servers };

Way way_of(const FigureText& text) {
  return text.figure ? Way::run : text.worst ? Way::search : text.flow ? Way::servers : Way::bound;
}

double in_unit(sim::Duration value, const std::string& unit) {
  const double ps = static_cast<double>(value.ps());
  return unit == "ps" ? ps : unit == "ns" ? ps / 1e3 : unit == "us" ? ps / 1e6 : unit == "ms" ? ps / 1e9 : ps / 1e12;
}

/// One scenario, and all figures that are read off it.
struct Job {
  Way way{};
  const json::Document* scenario = nullptr;
  std::string stream;  // that is searched for
  double budget = 0;
  std::vector<std::size_t> figures;
  json::Diagnostics diagnostics;
};

class Worker {
 public:
  Worker(const Entries& entries, Job& job, std::vector<Measured>& made) : entries_(entries), job_(job), made_(made) {}

  void work() {
    if (job_.way == Way::servers) return servers();
    scenario::Scenario scenario;
    json::decode(*job_.scenario, scenario, job_.diagnostics);
    if (job_.diagnostics.has_errors()) return;
    if (job_.way == Way::search) {
      scenario::Requirement required;
      required.stream = job_.stream;
      required.latency.emplace().at_most = sim::Duration::from_ps(3'600'000'000'000'000);
      scenario.require = {required};
    }
    const auto resolved = scenario::resolve(std::move(scenario), job_.diagnostics);
    if (!resolved) return;
    if (job_.way == Way::run) run(*resolved);
    if (job_.way == Way::bound) bound(*resolved);
    if (job_.way == Way::search) search(*resolved);
  }

 private:
  const FigureText& text(std::size_t figure) const { return entries_.figures[figure].text; }

  void run(const scenario::Resolved& resolved) {
    scenario::Run run(resolved);
    run.advance();
    const Node result = results::run_node(evaluation::evaluate(run, false));
    for (const std::size_t f : job_.figures) {
      const std::optional<double> value = value_of(f, "figure", *text(f).figure, result);
      const std::optional<double> less = text(f).less ? value_of(f, "less", *text(f).less, result) : 0;
      if (value && less) made_[f].value = (*value - *less) * text(f).times;
    }
  }
  std::optional<double> value_of(std::size_t f, const char* key, const std::string& name, const Node& result) {
    const auto figure =
        scenario::read_figure({text(f).where, key, name, text(f).only, {}, text(f).unit}, job_.diagnostics);
    if (!figure) return std::nullopt;
    const std::optional<double> value = scenario::value_of(*figure, result);
    if (!value) made_[f].reason = "the run has no such figure";
    return value;
  }

  void bound(const scenario::Resolved& resolved) {
    const analysis::Bounds bounds = analysis::bound(resolved);
    for (const std::size_t f : job_.figures) {
      const std::string& name = text(f).bound ? *text(f).bound : *text(f).fastest;
      const auto stream = std::find_if(bounds.streams.begin(), bounds.streams.end(),
                                       [&](const auto& each) { return each.name == name; });
      if (stream == bounds.streams.end()) {
        job_.diagnostics.error(text(f).where.place(), "unknown stream",
                               {json::quote(name), "a stream of the scenario"});
        continue;
      }
      if (!text(f).bound)
        made_[f].value = in_unit(stream->least, text(f).unit);
      else if (stream->latency)
        made_[f].value = in_unit(*stream->latency, text(f).unit);
      else
        made_[f].reason = stream->reason;
    }
  }

  void search(const scenario::Resolved& resolved) {
    verify::SearchOptions options;
    options.seeds = 2;
    options.events = static_cast<std::uint64_t>(job_.budget * 1e6);
    const verify::Search found = verify::search(resolved, analysis::bound(resolved), options);
    for (const std::size_t f : job_.figures) {
      if (found.contradiction)
        made_[f].reason = found.contradiction->text;  // takt is wrong: that is no figure
      else if (!found.findings.empty() && found.findings.front().longest.measured)
        made_[f].value = in_unit(*found.findings.front().longest.measured, text(f).unit);
      else
        made_[f].reason = "no run delivers a frame";
    }
  }

  void servers() {
    const auto file = analysis::read_server_network(*job_.scenario, job_.diagnostics);
    if (!file) return;
    const std::vector<analysis::FlowBound> tfa = analysis::total_flow_analysis(file->network);
    const std::vector<analysis::FlowBound> sfa = analysis::separated_flow_analysis(file->network);
    for (const std::size_t f : job_.figures) {
      const auto& flows = file->network.flows;
      const auto flow =
          std::find_if(flows.begin(), flows.end(), [&](const auto& each) { return each.name == *text(f).flow; });
      if (flow == flows.end()) {
        job_.diagnostics.error(text(f).where.place(), "unknown flow",
                               {json::quote(*text(f).flow), "a flow of the network"});
        continue;
      }
      const analysis::FlowBound& bound =
          (text(f).analysis == Analysis::tfa ? tfa : sfa)[static_cast<std::size_t>(flow - flows.begin())];
      const auto& value = text(f).of == Bound::delay ? bound.delay : bound.backlog;
      if (!value) {
        made_[f].reason = "unbounded";
        continue;
      }
      made_[f].value = value->to_double();
      made_[f].exact = value->to_text();
    }
  }

  const Entries& entries_;
  Job& job_;
  std::vector<Measured>& made_;
};

std::vector<Job> jobs_of(const Entries& entries) {
  std::vector<Job> jobs;
  std::map<std::string, std::size_t> known;
  for (std::size_t f = 0; f < entries.figures.size(); ++f) {
    const Entry& entry = entries.figures[f];
    const Way way = way_of(entry.text);
    const std::string stream = entry.text.worst.value_or("");
    const auto [place, is_new] = known.try_emplace(
        std::to_string(static_cast<int>(way)) + stream + "\n" + json::compact(entry.scenario.root()), jobs.size());
    if (is_new)
      jobs.push_back({way, &entry.scenario, stream, entries.sources[entry.source].budget, {}, json::Diagnostics()});
    jobs[place->second].figures.push_back(f);
  }
  return jobs;
}

}  // namespace

std::vector<Measured> measure(const Entries& entries, const MeasureOptions& options, json::Diagnostics& diagnostics) {
  std::vector<Measured> made(entries.figures.size());
  std::vector<Job> jobs = jobs_of(entries);
  std::atomic<std::size_t> next{0};
  std::mutex telling;
  std::size_t done = 0;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t j = next++; j < jobs.size(); j = next++) {
      std::exception_ptr thrown;
      try {
        Worker(entries, jobs[j], made).work();
      } catch (...) {
        thrown = std::current_exception();
      }
      const std::lock_guard guard(telling);
      if (thrown && !failure) failure = thrown;
      ++done;
      if (options.progress) options.progress(done, jobs.size());
    }
  };
  {
    std::vector<std::jthread> threads;
    for (unsigned t = 1; t < options.jobs; ++t) threads.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
  for (const Job& job : jobs)
    for (const json::Diagnostic& diagnostic : job.diagnostics.kept())
      if (diagnostic.severity == json::Severity::error)
        diagnostics.error(diagnostic.place, diagnostic.message, diagnostic.details);
  return made;
}

}  // namespace takt::papers::validation
