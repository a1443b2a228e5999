// SPDX-License-Identifier: Apache-2.0
#include "emulate/child.hpp"

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace takt::emulate {
namespace {

constexpr int status_of_failed_start = 127;

[[noreturn]] void fail_in_child(const char* what) {
  const int error = errno;
  std::fprintf(stderr, "takt: %s: %s\n", what, std::strerror(error));
  ::_exit(status_of_failed_start);
}

void redirect(const std::string& file, int to, bool append) {
  if (file.empty()) return;
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | (append ? O_APPEND : O_TRUNC) | O_CLOEXEC, 0600);
  if (fd < 0 || ::dup2(fd, to) < 0) fail_in_child(file.c_str());
}

[[noreturn]] void become(const Child::Settings& settings, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(status_of_failed_start);  // it died before
  // Ctrl-C at a terminal goes to the parent alone, which ends its children in order.
  ::setpgid(0, 0);
  ::signal(SIGINT, SIG_DFL);
  ::signal(SIGTERM, SIG_DFL);
  redirect(settings.output, STDOUT_FILENO, settings.append);
  redirect(settings.errors, STDERR_FILENO, settings.append);
  if (!settings.network_namespace.empty()) {
    const std::string path = "/run/netns/" + settings.network_namespace;
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0 || ::setns(fd, CLONE_NEWNET) != 0) fail_in_child(path.c_str());
  }
  std::vector<char*> arguments;
  for (const std::string& each : settings.command) arguments.push_back(const_cast<char*>(each.c_str()));
  arguments.push_back(nullptr);
  ::execvp(arguments[0], arguments.data());
  fail_in_child(arguments[0]);
}

void sleep_ms(int milliseconds) {
  const timespec time = {milliseconds / 1000, (milliseconds % 1000) * 1'000'000L};
  ::nanosleep(&time, nullptr);
}

}  // namespace

Child::Child(const Settings& settings) : pid_(-1) {
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) become(settings, parent);
  if (pid_ < 0) status_ = status_of_failed_start;
}

Child::~Child() {
  if (pid_ < 0 || status_) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

bool Child::is_running() { return !wait(0); }

void Child::send(int signal) {
  if (pid_ >= 0 && !status_) ::kill(pid_, signal);
}

std::optional<int> Child::wait(int milliseconds) {
  constexpr int step = 5;
  for (int waited = 0; !status_; waited += step) {
    int status = 0;
    if (const pid_t ended = ::waitpid(pid_, &status, WNOHANG); ended == pid_)
      status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    else if (ended < 0 && errno != EINTR)
      status_ = status_of_failed_start;
    else if (waited >= milliseconds)
      return std::nullopt;
    else
      sleep_ms(std::min(step, milliseconds - waited));
  }
  return status_;
}

std::string run_command(const std::vector<std::string>& command) {
  std::array<char, 32> name{"/tmp/takt-said-XXXXXX"};
  const int fd = ::mkstemp(name.data());
  Child::Settings settings;
  settings.command = command;
  settings.output = "/dev/null";
  settings.errors = fd < 0 ? "" : name.data();
  Child child(settings);
  const auto status = child.wait(30'000);
  std::string said(4096, '\0');
  const ssize_t size = fd < 0 ? 0 : ::pread(fd, said.data(), said.size(), 0);
  said.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  if (fd >= 0) {
    ::close(fd);
    ::unlink(name.data());
  }
  if (status == 0) return {};
  while (said.ends_with('\n')) said.pop_back();
  std::string text;
  for (const std::string& each : command) text += (text.empty() ? "" : " ") + each;
  return text + ": " + (said.empty() ? status ? "status " + std::to_string(*status) : "no end" : said);
}

std::string node_program() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).replace_filename("takt-node").string();
}

}  // namespace takt::emulate
