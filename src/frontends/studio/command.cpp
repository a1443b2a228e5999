// SPDX-License-Identifier: Apache-2.0
#include "studio/command.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <exception>

namespace takt::studio {
namespace {

constexpr std::size_t most_output = 64'000'000;  // octets; more is no page
constexpr std::size_t most_errors = 100'000;

/// Reads what is there. False at the end.
bool read_some(int file, std::string& text, std::size_t most) {
  std::array<char, 65536> octets;
  const ssize_t got = ::read(file, octets.data(), octets.size());
  if (got < 0) return errno == EINTR || errno == EAGAIN;
  if (got == 0) return false;
  text.append(octets.data(), std::min(static_cast<std::size_t>(got), most - std::min(most, text.size())));
  return true;
}

}  // namespace

std::unique_ptr<Command> Command::start(const std::string& program, const std::vector<std::string>& arguments,
                                        std::vector<std::shared_ptr<const std::string>> keeps) {
  std::array<int, 2> output{};
  std::array<int, 2> errors{};
  if (::pipe2(output.data(), O_CLOEXEC) != 0) return nullptr;
  if (::pipe2(errors.data(), O_CLOEXEC) != 0) {
    ::close(output[0]);
    ::close(output[1]);
    return nullptr;
  }
  std::vector<char*> words;
  words.push_back(const_cast<char*>(program.c_str()));
  for (const std::string& each : arguments) words.push_back(const_cast<char*>(each.c_str()));
  words.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t process = ::fork();
  if (process == 0) {  // between fork and exec only what signals may do, too: other threads may have held locks
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(127);
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, 0);
    ::dup2(output[1], 1);
    ::dup2(errors[1], 2);
    ::execv(words[0], words.data());
    ::_exit(127);
  }
  ::close(output[1]);
  ::close(errors[1]);
  if (process > 0) return std::unique_ptr<Command>(new Command(process, output[0], errors[0], std::move(keeps)));
  ::close(output[0]);
  ::close(errors[0]);
  return nullptr;
}

Command::Command(pid_t process, int output, int errors, std::vector<std::shared_ptr<const std::string>> keeps)
    : process_(process), keeps_(std::move(keeps)), listener_([this, output, errors] {
        try {
          listen(output, errors);
        } catch (const std::exception&) {
          std::terminate();  // no memory is to be had
        }
      }) {}

void Command::listen(int output, int errors) {
  std::array<pollfd, 2> files = {pollfd{output, POLLIN, 0}, pollfd{errors, POLLIN, 0}};
  while (files[0].fd >= 0 || files[1].fd >= 0) {
    if (::poll(files.data(), files.size(), -1) < 0 && errno != EINTR) break;
    const std::lock_guard lock(mutex_);
    if (files[0].revents != 0 && !read_some(output, state_.output, most_output)) files[0].fd = -1;
    if (files[1].revents != 0 && !read_some(errors, state_.errors, most_errors)) files[1].fd = -1;
  }
  ::close(output);
  ::close(errors);
  // Waited for without being taken away: as long as the number is its own, the group may be signalled.
  siginfo_t ended{};
  while (::waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOWAIT) != 0 && errno == EINTR) {
  }
  const std::lock_guard lock(mutex_);
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  state_.is_running = false;
  state_.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  keeps_.clear();
}

Command::State Command::state() {
  const std::lock_guard lock(mutex_);
  return state_;
}

Command::~Command() {
  {
    const std::lock_guard lock(mutex_);
    if (state_.is_running) ::kill(-process_, SIGKILL);
  }
  listener_.join();
}

}  // namespace takt::studio
