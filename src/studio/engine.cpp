#include "studio/engine.hpp"

#include <array>
#include <exception>
#include <utility>

#include "evaluation/evaluate.hpp"
#include "report/network_figure.hpp"
#include "results/result_json.hpp"
#include "scenario/resolve/resolve.hpp"
#include "scenario/run/run.hpp"
#include "studio/plant.hpp"
#include "verify/report.hpp"

namespace takt::studio {

const char* name_of(Stage stage) {
  constexpr std::array<const char*, 7> names = {"empty", "checking", "refused", "running", "proving", "searching", "done"};
  return names[static_cast<std::size_t>(stage)];
}

Engine::Engine(std::string file_name, Effort effort)
    : file_name_(std::move(file_name)), effort_(effort), worker_([this] {
        try {
          work();
        } catch (const std::exception&) {
          std::terminate();   // no lock is to be had
        }
      }) {}

void Engine::end() {
  const std::lock_guard lock(mutex_);
  ends_ = true;
  changed_.notify_all();
}

Engine::~Engine() {
  end();
  worker_.join();
}

void Engine::set_text(std::uint64_t revision, std::string text) {
  const std::lock_guard lock(mutex_);
  text_ = std::move(text);
  revision_ = revision;
  has_work_ = true;
  changed_.notify_all();
}

Findings Engine::wait_for_other(std::uint64_t version, std::chrono::milliseconds most) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, most, [&] { return findings_.version != version || ends_; });
  return findings_;
}

/// Changes what is known, unless a newer text has come.
template <class Change>
bool Engine::publish(std::uint64_t revision, const Change& change) {
  const std::lock_guard lock(mutex_);
  if (ends_ || revision != revision_) return false;
  change(findings_);
  findings_.revision = revision;
  ++findings_.version;
  changed_.notify_all();
  return true;
}

void Engine::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return has_work_ || ends_; });
    if (ends_) return;
    has_work_ = false;
    const std::uint64_t revision = revision_;
    const std::string text = text_;
    lock.unlock();
    try {
      work_at(revision, text);
    } catch (const std::exception& problem) {   // a broken invariant, or too little memory: the next text may do
      const std::string what = std::string("internal error, please report it with the scenario: ") + problem.what();
      publish(revision, [&](Findings& f) {
        f.stage = Stage::done;
        f.trouble = what;
      });
    }
    lock.lock();
  }
}

/// Those that took longer than the run as it is, or that fail.
void Engine::keep_worst(std::uint64_t revision, const verify::Verification& verification) {
  std::vector<std::shared_ptr<const scenario::Resolved>> worst;
  std::vector<results::RequirementResult> requirements;
  for (const verify::Line& line : verification.lines) {
    json::Diagnostics unused;
    requirements.push_back(line.requirement);
    if (line.adversarial) requirements.back().measured = line.adversarial;
    worst.push_back(line.adversarial ? scenario::resolve(line.longest.scenario(), unused) : nullptr);
  }
  const std::lock_guard lock(mutex_);
  if (revision != subject_.revision) return;
  subject_.worst = std::move(worst);
  subject_.requirements = std::move(requirements);
}

std::optional<Subject> Engine::subject(std::uint64_t revision) {
  const std::lock_guard lock(mutex_);
  if (ends_ || revision != revision_ || subject_.revision != revision || !subject_.resolved) return std::nullopt;
  return subject_;
}

bool Engine::is_current(std::uint64_t revision) {
  const std::lock_guard lock(mutex_);
  return !ends_ && revision == revision_;
}

void Engine::work_at(std::uint64_t revision, const std::string& text) {
  if (!publish(revision, [](Findings& f) { f.stage = Stage::checking; })) return;
  json::Diagnostics diagnostics;
  const std::shared_ptr<const scenario::Resolved> resolved = scenario::load_text(text, file_name_, {}, diagnostics);
  // Figures of an older text do not stand beside a newer one.
  const bool goes_on = publish(revision, [&](Findings& f) {
    f.stage = resolved ? Stage::running : Stage::refused;
    f.diagnostics = json::pretty(diagnostics.to_json());
    f.result.clear();
    f.proofs.clear();
    f.trouble.clear();
    subject_ = {revision, resolved};
    if (resolved) f.network = plant_json(report::network_figure(*resolved, nullptr));
  });
  if (!goes_on || !resolved) return;

  scenario::Run run(*resolved);
  constexpr std::uint64_t events_a_slice = 100'000;
  bool is_complete = false;
  while (!(is_complete = run.advance(events_a_slice)) && run.simulation().event_count() < effort_.run_events)
    if (!is_current(revision)) return;
  const results::RunResult result = evaluation::evaluate(run, !is_complete);
  if (!publish(revision, [&](Findings& f) {
        f.stage = Stage::proving;
        f.result = results::run_json(result);
        f.network = plant_json(report::network_figure(*resolved, &result));
      }))
    return;

  const auto verify_with = [&](std::uint64_t events) {
    verify::Options options;
    options.search.events = events;
    options.search.interrupted = [&] { return !is_current(revision); };
    options.proof.interrupted = options.search.interrupted;
    const verify::Verification verification = verify::verify(*resolved, options);
    keep_worst(revision, verification);
    return verify::json_report(resolved->scenario.name, verification, std::vector<std::string>(verification.lines.size()));
  };
  std::string proofs = verify_with(0);
  if (!publish(revision, [&](Findings& f) {
        f.stage = Stage::searching;
        f.proofs = std::move(proofs);
      }))
    return;
  proofs = verify_with(effort_.search_events);
  publish(revision, [&](Findings& f) {
    f.stage = Stage::done;
    f.proofs = std::move(proofs);
  });
}

}  // namespace takt::studio
