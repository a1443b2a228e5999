// SPDX-License-Identifier: Apache-2.0
// Works at the latest text of a scenario, in the background: checked, run, bounded, searched for the worst. A newer
// text ends the work at an older one.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "results/run_result.hpp"
#include "scenario/resolved/resolved.hpp"
#include "verify/verification.hpp"

namespace takt::studio {

/// How far the work at a text has come.
enum class Stage : std::uint8_t {
  empty,      ///< no text yet
  checking,   ///< is it sound?
  refused,    ///< it is not; the diagnostics say why
  running,    ///< the scenario as it is
  proving,    ///< bounds of its requirements
  searching,  ///< for the worst runs
  done,
  sketched,  ///< of a text that still changes: run in part, bounded, not searched
};
/// A text that changes under the hand is worked at in part, so that its figures follow the hand.
enum class Pace : std::uint8_t { exact, coarse };
const char* name_of(Stage stage);

/// What is known of a text. Parts that are not there yet are empty.
struct Findings {
  std::uint64_t version = 0;   ///< another one after every change
  std::uint64_t revision = 0;  ///< of the text, as set_text said
  std::string text;            ///< digest of the text that the figures are of
  Stage stage = Stage::empty;
  std::string diagnostics;  ///< JSON, as of `takt check --format json`
  std::string network;      ///< JSON, see plant.hpp
  std::string result;       ///< JSON, as of `takt run --format json`
  std::string proofs;       ///< JSON, as of `takt verify --format json`, before or after the search
  std::string trouble;      ///< what went wrong beside mistakes of the text
};

/// What questions are asked of: a sound text, and the worst runs that have been found of it so far.
struct Subject {
  std::uint64_t revision = 0;
  std::shared_ptr<const scenario::Resolved> resolved;
  std::vector<verify::FoundRun> worst =
      {};  ///< by requirement, as the proofs list them; choices only: resolved they take megabytes
  std::vector<results::RequirementResult> requirements = {};  ///< likewise; `measured` is of the worst run
};

/// What the work at a text may cost.
struct Effort {
  std::uint64_t run_events = 200'000'000;
  std::uint64_t search_events = 20'000'000;
  std::uint64_t coarse_events = 200'000;   ///< of the run of a text that still changes
  std::chrono::seconds coarse_search{1};   ///< of that text: a run of days is not waited for
  std::chrono::seconds longest_proof{60};  ///< what is not proved by then is undecided; a search may take as long again
};

class Engine {
 public:
  /// `file_name` stands in diagnostics; files that a scenario names are looked for beside it.
  explicit Engine(std::string file_name, Effort effort = {});
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;
  ~Engine();

  /// The text from now on. One that is worked at already, or was, goes on as it is, under its own revision.
  void set_text(std::uint64_t revision, std::string text, Pace pace = Pace::exact);
  /// What is known now, or, if that is of `version` still, when something else is known, but after `most` at the
  /// latest.
  Findings wait_for_other(std::uint64_t version, std::chrono::milliseconds most);
  /// The text of that revision, if it is the present one and sound.
  std::optional<Subject> subject(std::uint64_t revision);
  /// All work ends, and nobody waits any more.
  void end();
  /// It is still the present one.
  bool is_current(std::uint64_t revision);

 private:
  void work();
  void work_at(std::uint64_t revision, const std::string& text, Pace pace);
  void keep_worst(std::uint64_t revision, const verify::Verification& verification);
  template <class Change>
  bool publish(std::uint64_t revision, const Change& change);

  const std::string file_name_;
  const Effort effort_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string text_;
  std::string digest_;  // of it
  std::uint64_t revision_ = 0;
  Pace pace_ = Pace::exact;
  bool has_work_ = false;
  bool ends_ = false;
  Findings findings_;
  Subject subject_;
  std::thread worker_;  // last: it uses all of the above
};

}  // namespace takt::studio
