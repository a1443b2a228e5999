// SPDX-License-Identifier: Apache-2.0
#include "node/log.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>

namespace takt::node {
namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

std::int64_t monotonic_ns() {
  timespec time = {};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<std::int64_t>(time.tv_sec) * second_ns + time.tv_nsec;
}

bool reads_some(int file, int milliseconds) {
  pollfd waiting{file, POLLOUT, 0};
  return ::poll(&waiting, 1, milliseconds) == 1;
}

}  // namespace

Log::Log(std::FILE* file, const LogLimits& limits)
    : file_(::fileno(file)), limits_(limits), credit_(limits.octets_at_once), credited_ns_(monotonic_ns()) {
  std::fflush(file);
  struct stat status = {};
  is_socket_ = ::fstat(file_, &status) == 0 && S_ISSOCK(status.st_mode);  // a service's, at the journal
  waiting_.reserve(limits.octets_waiting);
}

bool Log::admit(std::size_t octets, std::int64_t now_ns) {
  const auto elapsed_us =
      static_cast<std::uint64_t>(std::clamp<std::int64_t>(now_ns - credited_ns_, 0, 3600 * second_ns) / 1000);
  if (const std::uint64_t earned = elapsed_us * limits_.octets_per_second / 1'000'000; earned > 0) {
    credit_ = std::min<std::uint64_t>(credit_ + earned, limits_.octets_at_once);
    credited_ns_ = now_ns;
  }
  if (octets > credit_ || waiting_.size() - handed_ + octets > limits_.octets_waiting) return false;
  credit_ -= octets;
  return true;
}

std::string Log::note() const {
  const std::uint64_t lines = left_out_ - told_;
  return limits_.left_out == Notes::json ? fmt::format("{{\"event\": \"left out\", \"lines\": {}}}\n", lines)
                                         : fmt::format("takt: {} lines were left out\n", lines);
}

void Log::write(std::string_view line) {
  if (is_closed_) return;
  const std::int64_t now = monotonic_ns();
  if (left_out_ != told_) log_left_out(now);
  if (left_out_ == told_ && admit(line.size(), now))
    waiting_ += line;
  else
    ++left_out_;
  flush();
}

/// Once half a second of credit is there again: not a note for each line.
void Log::log_left_out(std::int64_t now_ns) {
  const std::string note = this->note();
  const std::size_t wanted = std::min(limits_.octets_per_second, limits_.octets_at_once) / 2;
  if (!admit(0, now_ns) || credit_ < std::max(wanted, note.size()) || !admit(note.size(), now_ns)) return;
  waiting_ += note;
  told_ = left_out_;
}

void Log::flush() {
  if (is_closed_) return;
  if (left_out_ != told_) log_left_out(monotonic_ns());
  while (!is_idle() && hand_on()) {
  }
}

/// A pipe takes PIPE_BUF octets without waiting if poll says that it takes any; a socket can be asked not to wait; a
/// file has no reader to wait for.
bool Log::hand_on() {
  if (!reads_some(file_, 0)) return false;
  const std::size_t size = std::min<std::size_t>(waiting_.size() - handed_, PIPE_BUF);
  const char* const from = waiting_.data() + handed_;
  const ssize_t taken =
      is_socket_ ? ::send(file_, from, size, MSG_DONTWAIT | MSG_NOSIGNAL) : ::write(file_, from, size);
  if (taken < 0 && (errno == EAGAIN || errno == EINTR)) return false;
  if (taken < 0) {
    is_closed_ = true;
    waiting_.clear();
    handed_ = 0;
    return false;
  }
  handed_ += static_cast<std::size_t>(taken);
  if (is_idle() || handed_ > limits_.octets_waiting / 2) {
    waiting_.erase(0, handed_);
    handed_ = 0;
  }
  return taken > 0;
}

void Log::wait_until_taken(std::int64_t until_ns) {
  while (!is_closed_ && !is_idle()) {
    const std::int64_t left = until_ns - monotonic_ns();
    if (left <= 0) return;
    if (reads_some(file_, static_cast<int>(left / 1'000'000 + 1))) hand_on();
  }
}

void Log::finish(std::string_view line, std::int64_t most_ns) {
  const std::int64_t until = monotonic_ns() + most_ns;
  wait_until_taken(until);
  if (is_closed_ || !is_idle()) return;  // a line behind half of another would be none
  if (left_out_ != told_) waiting_ += note();
  told_ = left_out_;
  waiting_ += line;
  wait_until_taken(until);
}

}  // namespace takt::node
