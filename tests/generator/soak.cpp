// SPDX-License-Identifier: Apache-2.0
// Random scenarios by the thousand, each in a process of its own: see usage().
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "cli/status_line.hpp"
#include "json/document.hpp"
#include "study/pool.hpp"
#include "tests/generator/against.hpp"
#include "tests/generator/check_scenario.hpp"
#include "tests/generator/coverage.hpp"
#include "tests/generator/generated.hpp"
#include "tests/generator/shrink.hpp"

namespace takt::generator {
namespace {

namespace fs = std::filesystem;

constexpr const char* usage =
    "Makes random scenarios of every feature, runs and verifies each, and shrinks what is wrong to a small scenario.\n"
    "\n"
    "  takt_soak [--hours H] [--count N] [--first N] [--jobs N] [--folder DIR] [--build NAME] [--only CHECK]\n"
    "  takt_soak --against PROGRAM [--recordings] [--hours H] [--count N] [--first N] [--jobs N] [--folder DIR]\n"
    "                                    runs each (2,000) by this build and by another one, whose takt or takt_digest "
    "PROGRAM is, and\n"
    "                                    compares digests, or with --recordings frames.csv and hops.csv, sorted by "
    "time and node\n"
    "  takt_soak --show N                the scenario of this number\n"
    "  takt_soak --check FILE...         these scenarios instead\n"
    "  takt_soak --shrink CHECK FILE     the least of a scenario that still fails this check, on standard output\n"
    "\n"
    "It ends after so many hours (1) or scenarios, whichever is first, and goes on where it was stopped: "
    "DIR/state.json knows how far it\n"
    "has come. Another build begins anew, with other numbers. What is found stands in DIR/CHECK-NUMBER.json, with the "
    "message in .txt.\n"
    "Exit status: 0 nothing was found, 1 something was, 2 bad input, 130 interrupted.\n";

volatile std::sig_atomic_t interrupted = 0;

struct Options {
  double hours = 1;
  std::uint64_t count = ~0ULL;
  std::optional<std::uint64_t> first;
  unsigned jobs = 1;
  std::string folder = "soak";
  std::string build = "unknown";
  std::optional<std::uint64_t> show;
  std::string shrink;
  std::string against;
  std::string only;  // a check
  bool recordings = false;
  std::vector<std::string> files;
};

/// What is known when the program starts again.
struct State {
  std::string build;
  std::uint64_t next = 0;  ///< number of a scenario
  std::uint64_t done = 0;
  std::uint64_t repaired = 0;  ///< of them the loader refused as they were drawn
  std::uint64_t found = 0;
  std::map<std::string, std::uint64_t> by_check;
};

std::string content(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

void write(const std::string& path, const std::string& text) {
  const std::string part = path + ".part";
  std::ofstream(part) << text;
  fs::rename(part, path);
}

std::string state_text(const State& state) {
  json::Node node = json::Node::object();
  node.add("build", json::Node::of_string(state.build));
  node.add("next", json::Node::of_integer(state.next));
  node.add("done", json::Node::of_integer(state.done));
  node.add("repaired", json::Node::of_integer(state.repaired));
  node.add("found", json::Node::of_integer(state.found));
  json::Node& checks = node.add("checks", json::Node::object());
  for (const auto& [name, count] : state.by_check) checks.add(name, json::Node::of_integer(count));
  return json::pretty(node);
}

State state_of(const std::string& path) {
  State state;
  json::Diagnostics diagnostics;
  const auto document = json::parse(content(path), path, diagnostics);
  if (!document) return state;
  const auto integer = [&](const char* key) -> std::uint64_t {
    const json::Node* const found = document->root().find(key);
    return found == nullptr ? 0 : static_cast<std::uint64_t>(json::integer_of(*found).value_or(0));
  };
  if (const json::Node* const build = document->root().find("build")) state.build = build->text;
  state.next = integer("next");
  state.done = integer("done");
  state.repaired = integer("repaired");
  state.found = integer("found");
  if (const json::Node* const checks = document->root().find("checks"))
    for (const json::Member& each : checks->members)
      state.by_check[each.key] = static_cast<std::uint64_t>(json::integer_of(each.value).value_or(0));
  return state;
}

constexpr char separator = '\x1f';

/// "repaired", then check and message of each finding.
std::string answer_of(const Checked& checked, bool repaired, const std::string& problem) {
  std::string text = repaired ? "repaired" : "";
  if (!problem.empty()) text += separator + std::string("generator") + separator + problem;
  for (const Finding& each : checked.findings) text += separator + each.check + separator + each.message;
  return text;
}

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

/// A scenario in a process of its own; the findings, of which a crash is one.
constexpr study::JobLimits limits = {sim::Duration::from_ps(20'000'000'000'000), std::uint64_t{2} << 30};

std::string name_of(study::Answer::Kind kind) {
  switch (kind) {
    case study::Answer::Kind::too_long:
      return "hang";
    case study::Answer::Kind::too_large:
      return "memory";
    default:
      return "crash";
  }
}

std::vector<Finding> findings_of(const study::Answer& answer, bool* repaired = nullptr) {
  if (answer.kind != study::Answer::Kind::answered) return {{name_of(answer.kind), answer.text}};
  const std::vector<std::string> parts = parts_of(answer.text);
  if (repaired != nullptr) *repaired = parts[0] == "repaired";
  std::vector<Finding> findings;
  for (std::size_t i = 1; i + 1 < parts.size(); i += 2) findings.push_back({parts[i], parts[i + 1]});
  return findings;
}

/// Checks a text in a process of its own.
std::vector<Finding> check_apart(const std::string& text, const std::string& file, const std::string& only = {}) {
  std::vector<Finding> findings;
  bool is_asked = false;
  study::Pool pool(1, limits,
                   [&](std::uint64_t) { return answer_of(check_scenario(text, file, {.only = only}), false, {}); });
  pool.run(
      [&]() -> std::optional<std::uint64_t> {
        return std::exchange(is_asked, true) ? std::nullopt : std::optional<std::uint64_t>(0);
      },
      [&](std::uint64_t, const study::Answer& answer) {
        findings = findings_of(answer);
        return true;
      },
      [] { return interrupted == 0; });
  return findings;
}

/// The least text that fails the check, and what it says then.
std::pair<std::string, std::string> shrunk(const std::string& text, const std::string& file, const std::string& check) {
  std::string message;
  constexpr std::array of_all = {"load", "generator", "crash", "hang", "memory"};
  const std::string alone = std::ranges::count(of_all, check) > 0 ? "" : check;
  const std::string least = shrink(text, [&](const std::string& candidate) {
    if (interrupted != 0) return false;
    for (const Finding& each : check_apart(candidate, file, alone)) {
      if (each.check != check) continue;
      message = each.message;
      return true;
    }
    return false;
  });
  return {least, message};
}

class Soak {
 public:
  Soak(Options options, State state)
      : options_(std::move(options)), state_(std::move(state)), begin_(std::chrono::steady_clock::now()) {}

  int run() {
    const std::uint64_t end = state_.done + options_.count;
    std::uint64_t handed_out = state_.done;
    study::Pool pool(options_.jobs, limits, [this](std::uint64_t number) {
      const Generated made = generate(number);
      return answer_of(made.resolved ? check_scenario(made.text, file_name(), {.only = options_.only}) : Checked(),
                       !made.first_refusal.empty(), made.problem);
    });
    const std::string problem = pool.run(
        [&]() -> std::optional<std::uint64_t> {
          if (handed_out >= end || interrupted != 0 || seconds() > options_.hours * 3600) return std::nullopt;
          ++handed_out;
          open_.push_back(state_.next++);
          return open_.back();
        },
        [&](std::uint64_t number, const study::Answer& answer) {
          std::erase(open_, number);
          ++state_.done;
          bool repaired = false;
          const std::vector<Finding> findings = findings_of(answer, &repaired);
          state_.repaired += repaired ? 1 : 0;
          for (const Finding& each : findings) note(number, each);
          return true;
        },
        [&] {
          tell();
          return interrupted == 0;
        });
    if (!problem.empty()) std::fprintf(stderr, "takt_soak: %s\n", problem.c_str());
    keep();
    for (const auto& [number, finding] : todo_) shrink_finding(number, finding);
    line_.clear();
    std::printf("%llu scenarios, %.1f %% of them repaired, %llu findings in %s\n",
                static_cast<unsigned long long>(state_.done), share(), static_cast<unsigned long long>(state_.found),
                options_.folder.c_str());
    for (const auto& [name, count] : state_.by_check)
      std::printf("  %s: %llu\n", name.c_str(), static_cast<unsigned long long>(count));
    if (interrupted != 0) return 130;
    return state_.found > 0 ? 1 : 0;
  }

 private:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }
  double share() const {
    return state_.done == 0 ? 0 : 100.0 * static_cast<double>(state_.repaired) / static_cast<double>(state_.done);
  }

  void note(std::uint64_t number, const Finding& finding) {
    ++state_.found;
    const std::uint64_t count = ++state_.by_check[finding.check];
    const std::string name = fmt::format("{}/{}-{}", options_.folder, finding.check, number);
    write(name + ".json", generate(number).text);
    write(name + ".txt", finding.message + "\n");
    // What is found often is the same: some are enough to understand it.
    if (count <= 10) todo_.emplace_back(number, finding);
  }

  void shrink_finding(std::uint64_t number, const Finding& finding) {
    if (interrupted != 0) return;
    const std::string name = fmt::format("{}/{}-{}", options_.folder, finding.check, number);
    line_.show("shrinking " + name);
    const auto [least, message] = shrunk(generate(number).text, file_name(), finding.check);
    write(name + ".json", least);
    write(name + ".txt", (message.empty() ? finding.message : message) + "\n");
  }

  void tell() {
    if (seconds() < last_told_ + (options_.jobs > 0 ? 1 : 0)) return;
    last_told_ = seconds();
    keep();
    line_.show(fmt::format("{} scenarios, {:.1f} a second, {:.1f} % repaired, {} findings", state_.done,
                           static_cast<double>(state_.done - at_begin_) / seconds(), share(), state_.found));
  }
  void keep() {
    // Those under way are begun again.
    State kept = state_;
    for (const std::uint64_t number : open_) kept.next = std::min(kept.next, number);
    write(options_.folder + "/state.json", state_text(kept));
  }

  Options options_;
  State state_;
  std::vector<std::uint64_t> open_;
  std::deque<std::pair<std::uint64_t, Finding>> todo_;
  std::uint64_t at_begin_ = state_.done;
  std::chrono::steady_clock::time_point begin_;
  double last_told_ = 0;
  cli::StatusLine line_{true};
};

int check_files(const std::vector<std::string>& files) {
  int status = 0;
  for (const std::string& file : files) {
    for (const Finding& each : check_apart(content(file), fs::absolute(file).string())) {
      std::printf("%s: %s: %s\n", file.c_str(), each.check.c_str(), each.message.c_str());
      status = 1;
    }
  }
  return status;
}

int shrink_file(const std::string& check, const std::string& file) {
  const auto [least, message] = shrunk(content(file), file_name(), check);
  std::printf("%s", least.c_str());
  std::fprintf(stderr, "%s\n", message.c_str());
  return 0;
}

int show(std::uint64_t number) {
  const Generated made = generate(number);
  std::string asked;
  for (const Feature feature : made.asked) asked += " " + std::string(entry_of(feature).name);
  std::printf("// %llu:%s; %u repairs\n%s", static_cast<unsigned long long>(number), asked.c_str(), made.repairs,
              made.text.c_str());
  std::fputs(made.first_refusal.c_str(), stderr);
  std::fputs(made.problem.c_str(), stderr);
  return 0;
}

void catch_signals() {
  for (const int number : {SIGINT, SIGTERM}) std::signal(number, [](int) { interrupted = 1; });
}

int run(const std::vector<std::string>& arguments) {
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& key = arguments[i];
    if (key == "-h" || key == "--help") {
      std::fputs(usage, stdout);
      return 0;
    }
    if (!key.starts_with("--")) {
      options.files.push_back(key);
      continue;
    }
    if (key == "--check") continue;
    if (key == "--recordings") {
      options.recordings = true;
      continue;
    }
    if (i + 1 == arguments.size()) throw std::invalid_argument(key + " without a value");
    const std::string& value = arguments[++i];
    if (key == "--hours")
      options.hours = std::stod(value);
    else if (key == "--count")
      options.count = std::stoull(value);
    else if (key == "--first")
      options.first = std::stoull(value);
    else if (key == "--jobs")
      options.jobs = std::max(1U, static_cast<unsigned>(std::stoul(value)));
    else if (key == "--folder")
      options.folder = value;
    else if (key == "--build")
      options.build = value;
    else if (key == "--against")
      options.against = value;
    else if (key == "--only")
      options.only = value;
    else if (key == "--shrink")
      options.shrink = value;
    else if (key == "--show")
      options.show = std::stoull(value);
    else
      throw std::invalid_argument("unknown option " + key);
  }
  if (options.show) return show(*options.show);
  if (!options.shrink.empty()) return shrink_file(options.shrink, options.files.at(0));
  if (!options.files.empty()) return check_files(options.files);
  if (!options.against.empty()) {
    AgainstOptions how{.program = options.against,
                       .recordings = options.recordings,
                       .hours = options.hours,
                       .first = options.first.value_or(0),
                       .jobs = options.jobs,
                       .folder = options.folder};
    if (options.count != Options().count) how.count = options.count;
    catch_signals();
    return soak_against(how, interrupted);
  }
  fs::create_directories(options.folder);
  State state = state_of(options.folder + "/state.json");
  if (state.build != options.build || options.first) {
    const std::uint64_t next = state.next;
    state = State();
    state.build = options.build;
    state.next = options.first.value_or(next);
  }
  catch_signals();
  return Soak(options, state).run();
}

}  // namespace
}  // namespace takt::generator

int main(int count, char** values) {
  try {
    return takt::generator::run(std::vector<std::string>(values + 1, values + count));
  } catch (const std::exception& broken) {
    std::fprintf(stderr, "takt_soak: %s\n", broken.what());
    return 2;
  }
}
