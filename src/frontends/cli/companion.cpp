// SPDX-License-Identifier: Apache-2.0
#include "cli/companion.hpp"

#include <sys/auxv.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "results/behaviour.hpp"
#include "sim/check.hpp"

namespace takt::cli {

const Companion* find_companion(std::string_view command) {
  const auto found = std::ranges::find_if(companions, [&](const Companion& each) { return each.command == command; });
  return found == std::end(companions) ? nullptr : &*found;
}

const char* companion_help(std::string_view command) {
  const Companion* const companion = find_companion(command);
  TAKT_CHECK(companion != nullptr, "a sub-command of a companion is in its table");
  return companion->help;
}

namespace {

/// The running program. Where /proc is not mounted, as in a bare root, the path by which it was started.
std::filesystem::path path_of_this_program() {
  std::error_code error;
  const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) return path;
  const auto* const started = reinterpret_cast<const char*>(::getauxval(AT_EXECFN));
  if (started == nullptr) return {};
  return std::filesystem::weakly_canonical(std::filesystem::absolute(started, error), error);
}

}  // namespace

std::string path_of_program(std::string_view program) {
  const std::filesystem::path folder = path_of_this_program().parent_path();
  if (folder.empty()) return {};  // never the current folder, where anything may lie
  for (const std::filesystem::path& candidate :
       {folder / program, folder / "../libexec/takt" / program, folder / "../../bin" / program})
    if (::access(candidate.c_str(), X_OK) == 0) return candidate;
  return {};
}

namespace {

const char* missing_text(std::string_view program) {
  const auto companion =
      std::ranges::find_if(companions, [&](const Companion& each) { return each.program == program; });
  return companion == std::end(companions) ? companions[0].missing : companion->missing;
}

/// What takt tells a companion of itself: the number of behaviour.
constexpr const char* starter_variable = "TAKT_STARTED_BY_BEHAVIOUR";
void announce_behaviour() { ::setenv(starter_variable, std::to_string(results::behaviour()).c_str(), 1); }

/// As exec takes them; they point into `words`.
std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace

bool is_of_another_takt() {
  const char* const starter = std::getenv(starter_variable);
  return starter != nullptr && starter != std::to_string(results::behaviour());
}

ExitStatus become(std::string_view program, std::vector<std::string> words) {
  const std::string path = path_of_program(program);
  if (path.empty()) {
    std::fprintf(stderr,
                 "takt: %s is a program of its own, %s, which is neither beside takt nor in ../libexec/takt: %s\n",
                 words[1].c_str(), std::string(program).c_str(), missing_text(program));
    return ExitStatus::bad_input;
  }
  announce_behaviour();
  ::execv(path.c_str(), pointers_to(words).data());
  std::fprintf(stderr, "takt: cannot start %s: %s\n", path.c_str(), std::strerror(errno));
  return ExitStatus::internal_error;
}

std::optional<std::string> output_of(std::string_view program, std::vector<std::string> words) {
  const std::string path = path_of_program(program);
  const std::vector<char*> arguments = pointers_to(words);
  announce_behaviour();
  int ends[2];
  if (path.empty() || ::pipe(ends) != 0) return std::nullopt;
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(ends[1], STDOUT_FILENO);
    ::close(ends[0]);
    ::close(ends[1]);
    ::execv(path.c_str(), arguments.data());
    ::_exit(127);
  }
  ::close(ends[1]);
  std::string text;
  char block[4096];
  for (ssize_t got; child > 0 && ((got = ::read(ends[0], block, sizeof block)) > 0 || (got < 0 && errno == EINTR));)
    if (got > 0) text.append(block, static_cast<std::size_t>(got));
  ::close(ends[0]);
  int status = 1;
  while (child > 0 && ::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (child < 0 || status != 0) return std::nullopt;
  return text;
}

}  // namespace takt::cli
