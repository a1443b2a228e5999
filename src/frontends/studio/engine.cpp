// SPDX-License-Identifier: Apache-2.0
#include "studio/engine.hpp"

#include <array>
#include <exception>
#include <utility>

#include "evaluation/evaluate.hpp"
#include "results/result_json.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "studio/document.hpp"
#include "studio/plant.hpp"
#include "verify/report.hpp"

namespace takt::studio {

const char* name_of(Stage stage) {
  constexpr std::array<const char*, 8> names = {"empty",   "checking",  "refused", "running",
                                                "proving", "searching", "done",    "sketched"};
  return names[static_cast<std::size_t>(stage)];
}

Engine::Engine(std::string file_name, Effort effort)
    : file_name_(std::move(file_name)), effort_(effort), worker_([this] {
        try {
          work();
        } catch (const std::exception&) {
          std::terminate();  // no lock is to be had
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

void Engine::set_text(std::uint64_t revision, std::string text, Pace pace) {
  const std::lock_guard lock(mutex_);
  if (revision_ != 0 && pace_ == Pace::exact && text_ == text) return;
  text_ = std::move(text);
  digest_ = Document::digest_of(text_);
  revision_ = revision;
  pace_ = pace;
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
    const Pace pace = pace_;
    lock.unlock();
    try {
      work_at(revision, text, pace);
    } catch (const std::exception& problem) {  // a broken invariant, or too little memory: the next text may do
      const std::string what = std::string("internal error, please report it with the scenario: ") + problem.what();
      publish(revision, [&](Findings& f) {
        f.stage = Stage::done;
        f.text = digest_;
        f.trouble = what;
      });
    }
    lock.lock();
  }
}

/// Those that took longer than the run as it is, or that fail.
void Engine::keep_worst(std::uint64_t revision, const verify::Verification& verification) {
  std::vector<verify::FoundRun> worst;
  std::vector<results::RequirementResult> requirements;
  for (const verify::Line& line : verification.lines) {
    requirements.push_back(line.requirement);
    if (line.adversarial) requirements.back().measured = line.adversarial;
    worst.push_back(line.adversarial ? line.longest : verify::FoundRun{});
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

void Engine::work_at(std::uint64_t revision, const std::string& text, Pace pace) {
  const bool is_coarse = pace == Pace::coarse;
  if (!is_coarse && !publish(revision, [](Findings& f) { f.stage = Stage::checking; })) return;
  json::Diagnostics diagnostics;
  const std::shared_ptr<const scenario::Resolved> resolved = scenario::load_text(text, file_name_, {}, diagnostics);
  // Figures of an older text do not stand beside a newer one.
  const auto begin = [&](Findings& f) {
    f.stage = resolved ? Stage::running : Stage::refused;
    f.text = digest_;
    f.diagnostics = json::pretty(diagnostics.to_json());
    f.result.clear();
    f.proofs.clear();
    f.trouble.clear();
    subject_ = {revision, resolved};
    if (resolved) f.network = plant_json(*resolved, nullptr);
  };
  // Under the hand they are replaced at once: a table that empties at each movement cannot be read.
  if ((!is_coarse || !resolved) && !publish(revision, begin)) return;
  if (!resolved) return;

  scenario::Run run(*resolved);
  constexpr std::uint64_t events_a_slice = 100'000;
  bool is_complete = false;
  const std::uint64_t most_events = is_coarse ? effort_.coarse_events : effort_.run_events;
  while (!(is_complete = run.advance(events_a_slice)) && run.simulation().event_count() < most_events)
    if (!is_current(revision)) return;
  const results::RunResult result = evaluation::evaluate(run, !is_complete);
  if (!publish(revision, [&](Findings& f) {
        if (is_coarse) begin(f);
        f.stage = Stage::proving;
        f.result = results::run_json(result);
        f.network = plant_json(*resolved, &result);
      }))
    return;

  const auto verify_with = [&](std::uint64_t events) {
    verify::Options options;
    options.search.events = events;
    const auto begun = std::chrono::steady_clock::now();
    const auto within = [&, begun](std::chrono::seconds most) {
      return [&, end = begun + most] { return !is_current(revision) || std::chrono::steady_clock::now() > end; };
    };
    options.search.interrupted = within(is_coarse ? effort_.coarse_search : effort_.longest_proof);
    options.proof.interrupted = within(effort_.longest_proof);
    const verify::Verification verification = verify::verify(*resolved, options);
    keep_worst(revision, verification);
    return verify::json_report(resolved->scenario.name, verification,
                               std::vector<std::string>(verification.lines.size()));
  };
  std::string proofs = verify_with(0);
  if (!publish(revision,
               [&](Findings& f) {
                 f.stage = is_coarse ? Stage::sketched : Stage::searching;
                 f.proofs = std::move(proofs);
               }) ||
      is_coarse)
    return;
  proofs = verify_with(effort_.search_events);
  publish(revision, [&](Findings& f) {
    f.stage = Stage::done;
    f.proofs = std::move(proofs);
  });
}

}  // namespace takt::studio
