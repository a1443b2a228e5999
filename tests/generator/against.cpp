// SPDX-License-Identifier: Apache-2.0
#include "tests/generator/against.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "cli/status_line.hpp"
#include "evaluation/evaluate.hpp"
#include "output/recording.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "sim/check.hpp"
#include "study/pool.hpp"
#include "tests/generator/generated.hpp"
#include "tests/generator/shrink.hpp"

namespace takt::generator {
namespace {

namespace fs = std::filesystem;

constexpr std::array recorded = {"frames.csv", "hops.csv"};
/// A scenario that takes longer is a finding.
constexpr study::JobLimits limits = {sim::Duration::from_ps(60'000'000'000'000), std::uint64_t{4} << 30};

/// A folder of this process that goes away with it, beside which the traces of the generator are.
class Scratch {
 public:
  explicit Scratch(const fs::path& file) {
    std::string name = (fs::temp_directory_path() / "takt-against-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for scenarios: " + name);
    path_ = name;
    if (!fs::is_directory(file.parent_path())) return;
    for (const fs::directory_entry& each : fs::directory_iterator(file.parent_path()))
      if (each.path().filename() != file.filename())
        fs::create_symlink(fs::absolute(each.path()), path_ / each.path().filename());
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

std::string quoted(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

struct Ended {
  int status = 0;
  std::string printed;  ///< on standard output
};

Ended run_program(const std::vector<std::string>& words) {
  std::string line = "timeout 60";
  for (const std::string& word : words) line += " " + quoted(word);
  std::FILE* const pipe = ::popen((line + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot be run: " + line);
  Ended ended;
  std::array<char, 4096> octets{};
  for (std::size_t n = 0; (n = std::fread(octets.data(), 1, octets.size(), pipe)) > 0;)
    ended.printed.append(octets.data(), n);
  const int status = ::pclose(pipe);
  ended.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + (WIFSIGNALED(status) ? WTERMSIG(status) : 0);
  return ended;
}

/// "NAME: pass, digest 0123456789abcdef", or of takt_digest "0123456789abcdef 1000".
std::string digest_in(const std::string& printed, bool is_digest) {
  constexpr std::size_t digits = 16;
  constexpr std::string_view before = "digest ";
  const std::size_t at = is_digest ? 0 : printed.rfind(before);
  if (at == std::string::npos) return {};
  const std::string digest = printed.substr(at + (is_digest ? 0 : before.size()), digits);
  return digest.size() == digits && digest.find_first_not_of("0123456789abcdef") == std::string::npos ? digest
                                                                                                      : std::string();
}

/// The rows of a table by the instant and the node in them, and whatever else they say.
std::vector<std::string> sorted_rows(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + " is missing");
  std::string head, row;
  std::getline(file, head);
  std::vector<std::string> columns;
  for (std::istringstream names(head); std::getline(names, row, ',');) columns.push_back(row);
  const auto column = [&](const char* name) {
    return static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name) - columns.begin());
  };
  const std::size_t time = std::min(column("at_ps"), column("came_ps"));
  const std::size_t node = column("node");
  std::vector<std::tuple<long long, std::string, std::string>> keyed;
  while (std::getline(file, row)) {
    // Names of random scenarios have no commas.
    std::vector<std::string> fields;
    std::string field;
    for (std::istringstream text(row); std::getline(text, field, ',');) fields.push_back(field);
    keyed.emplace_back(time < fields.size() ? std::atoll(fields[time].c_str()) : 0,
                       node < fields.size() ? fields[node] : "", row);
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::string> rows = {head};
  for (auto& [at, where, text] : keyed) rows.push_back(std::move(text));
  return rows;
}

std::string first_difference(const std::string& name, const std::vector<std::string>& here,
                             const std::vector<std::string>& there) {
  const auto [mine, other] = std::mismatch(here.begin(), here.end(), there.begin(), there.end());
  if (mine == here.end() && other == there.end()) return {};
  return fmt::format("{} of {} and {} rows: after {} that are the same\n  here:  {}\n  there: {}\n", name, here.size(),
                     there.size(), mine - here.begin(), mine == here.end() ? "nothing" : *mine,
                     other == there.end() ? "nothing" : *other);
}

std::string digest_here(const scenario::Resolved& resolved, const std::string& folder) {
  scenario::Run run(resolved);
  std::optional<output::Recording> recording;
  if (!folder.empty()) {
    output::RecordingOptions options;
    options.frames = true;
    json::Diagnostics diagnostics;
    recording.emplace(options, folder, run, diagnostics);
    if (std::string problem = recording->open(); !problem.empty()) throw std::runtime_error(problem);
  }
  constexpr std::uint64_t events_a_slice = 100'000;
  while (!run.advance(events_a_slice))
    if (recording) recording->write_until(run.simulation().now());
  if (recording)
    if (std::string problem = recording->close(); !problem.empty()) throw std::runtime_error(problem);
  return fmt::format("{:016x}", evaluation::evaluate(run, false).digest);
}

void write_text(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

}  // namespace

OtherBuild::OtherBuild(std::string program, bool recordings)
    : program_(std::move(program)),
      recordings_(recordings),
      is_digest_(fs::path(program_).filename().string().starts_with("takt_digest")) {
  if (::access(program_.c_str(), X_OK) != 0)
    throw std::invalid_argument("--against " + program_ + ": expected a program, takt or takt_digest of another build");
  if (is_digest_ && recordings_)
    throw std::invalid_argument("--recordings: expected takt of another build, not its takt_digest");
  program_ = fs::absolute(program_).string();
}

Compared OtherBuild::compare(const std::string& text, const std::string& file) const {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text, file, {}, diagnostics);
  if (!resolved) return {true, {}};
  const Scratch scratch(file);
  write_text(scratch / "scenario.json", text);
  std::vector<std::string> words = {program_};
  if (is_digest_)
    words.insert(words.end(), {scratch / "scenario.json", std::to_string(resolved->scenario.duration.ps()) + "ps",
                               std::to_string(resolved->scenario.seed)});
  else
    words.insert(words.end(), {"run", scratch / "scenario.json", "--quiet"});
  if (recordings_) words.insert(words.end(), {"--frames", "--out", scratch / "there"});
  const Ended other = run_program(words);
  constexpr int bad_input = 2;
  if (other.status == bad_input) return {true, {}};
  const std::string there = digest_in(other.printed, is_digest_);
  const bool is_broken_there = other.status > 1 || there.empty();
  std::string here;
  try {
    here = digest_here(*resolved, recordings_ ? scratch / "here" : std::string());
  } catch (const sim::InvariantBroken& broken) {
    // Broken in both, it is no difference.
    return {false, is_broken_there ? std::string() : fmt::format("here: {}", broken.what())};
  }
  if (is_broken_there)
    return {false, fmt::format("there: ends with status {}: {}", other.status, other.printed.substr(0, 2000))};
  if (!recordings_)
    return {false, here == there ? std::string() : fmt::format("digest here {}, there {}", here, there)};
  std::string difference;
  for (const char* const name : recorded)
    difference += first_difference(name, sorted_rows(scratch / ("here/" + std::string(name))),
                                   sorted_rows(scratch / ("there/" + std::string(name))));
  return {false, difference};
}

namespace {

/// In a process of its own, so that a crash of this build is an answer.
class Against {
 public:
  Against(const AgainstOptions& options, const volatile std::sig_atomic_t& interrupted)
      : options_(options), other_(options.program, options.recordings), interrupted_(interrupted) {}

  int run() {
    std::vector<std::pair<std::uint64_t, std::string>> found;
    std::uint64_t next = options_.first;
    std::uint64_t done = 0, refused = 0;
    {
      cli::StatusLine line(true);
      study::Pool pool(options_.jobs, limits, [this](std::uint64_t number) { return answer(generate(number).text); });
      const std::string problem = pool.run(
          [&]() -> std::optional<std::uint64_t> {
            if (next == options_.first + options_.count || interrupted_ != 0 || line.seconds() > options_.hours * 3600)
              return std::nullopt;
            return next++;
          },
          [&](std::uint64_t number, const study::Answer& came) {
            ++done;
            if (came.kind == study::Answer::Kind::answered && came.text == refused_mark)
              ++refused;
            else if (came.kind != study::Answer::Kind::answered || !came.text.empty())
              found.emplace_back(number, came.text);
            return true;
          },
          [&] {
            if (line.is_due())
              line.show("", static_cast<double>(done) / static_cast<double>(options_.count),
                        fmt::format("{} scenarios, {:.1f} a second, {} differ", done,
                                    static_cast<double>(done) / line.seconds(), found.size()));
            return interrupted_ == 0;
          });
      if (!problem.empty()) throw std::runtime_error(problem);
      constexpr std::size_t enough = 3;  // what is found often is the same
      for (std::size_t i = 0; i < found.size() && interrupted_ == 0; ++i)
        write_finding(found[i].first, found[i].second, i < enough, line);
    }
    std::fputs(fmt::format("{} scenarios, {} of them refused by one of the builds, {} differ{}\n", done, refused,
                           found.size(), found.empty() ? "" : ": " + options_.folder)
                   .c_str(),
               stdout);
    if (interrupted_ != 0) return 130;
    return found.empty() ? 0 : 1;
  }

 private:
  static constexpr const char* refused_mark = "refused";
  static constexpr unsigned most_questions = 300;

  std::string answer(const std::string& text) const {
    const Compared compared = other_.compare(text, file_name());
    return compared.is_refused ? refused_mark : compared.difference;
  }

  std::string answer_apart(const std::string& text) const {
    std::string said;
    bool is_asked = false;
    study::Pool pool(1, limits, [&](std::uint64_t) { return answer(text); });
    pool.run(
        [&]() -> std::optional<std::uint64_t> {
          return std::exchange(is_asked, true) ? std::nullopt : std::optional<std::uint64_t>(0);
        },
        [&](std::uint64_t, const study::Answer& came) {
          said = came.text == refused_mark ? std::string() : came.text;
          return true;
        },
        [&] { return interrupted_ == 0; });
    return said;
  }

  void write_finding(std::uint64_t number, std::string message, bool is_shrunk, cli::StatusLine& line) const {
    const std::string name = fmt::format("{}/against-{}", options_.folder, number);
    std::string text = generate(number).text;
    if (is_shrunk) {
      line.show("shrinking " + name);
      text = shrink(
          text,
          [&](const std::string& candidate) {
            std::string said = interrupted_ == 0 ? answer_apart(candidate) : std::string();
            if (said.empty()) return false;
            message = std::move(said);
            return true;
          },
          most_questions);
    }
    write_text(name + ".json", text);
    write_text(name + ".txt", message + "\n");
  }

  const AgainstOptions& options_;
  OtherBuild other_;
  const volatile std::sig_atomic_t& interrupted_;
};

}  // namespace

int soak_against(const AgainstOptions& options, const volatile std::sig_atomic_t& interrupted) {
  fs::create_directories(options.folder);
  return Against(options, interrupted).run();
}

}  // namespace takt::generator
