// SPDX-License-Identifier: Apache-2.0
#include "study/pool.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <new>

namespace takt::study {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool can_limit_memory = false;  // its shadow takes terabytes of addresses
#else
constexpr bool can_limit_memory = true;
#endif

/// What stands before the text of an answer.
struct Head {
  std::uint64_t size = 0;
  Answer::Kind kind = Answer::Kind::answered;
};

bool write_all(int channel, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::send(channel, at, size, MSG_NOSIGNAL);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

bool read_all(int channel, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t count = ::read(channel, at, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

/// Octets of addresses that this process has taken.
std::uint64_t address_space() {
  unsigned long pages = 0;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen("/proc/self/statm", "r"), &std::fclose);
  if (file == nullptr || std::fscanf(file.get(), "%lu", &pages) != 1) return 0;
  return std::uint64_t{pages} * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void limit_memory(std::uint64_t octets) {
  if (!can_limit_memory || octets == 0) return;
  rlimit limit{};
  ::getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, address_space() + octets);
  ::setrlimit(RLIMIT_AS, &limit);
}

/// SIGPROF ends the process when it has used so much more CPU time.
void limit_cpu(sim::Duration cpu) {
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(cpu.ps() / 1'000'000'000'000);
  timer.it_value.tv_usec = static_cast<suseconds_t>(cpu.ps() / 1'000'000 % 1'000'000);
  ::setitimer(ITIMER_PROF, &timer, nullptr);
}

}  // namespace

Pool::Pool(unsigned jobs, JobLimits limits, std::function<std::string(std::uint64_t)> work)
    : limits_(limits), work_(std::move(work)), workers_(jobs) {}

Pool::~Pool() {
  for (Worker& worker : workers_) stop(worker);
}

void Pool::serve(int channel) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::signal(SIGINT, SIG_IGN);  // Ctrl-C reaches the whole group; the first process decides what becomes of it
  std::signal(SIGTERM, SIG_DFL);
  std::signal(SIGPROF, SIG_DFL);
  std::uint64_t job = 0;
  while (read_all(channel, &job, sizeof job)) {
    Answer answer;
    limit_memory(limits_.octets);
    limit_cpu(limits_.cpu);
    try {
      answer.text = work_(job);
    } catch (const std::bad_alloc&) {
      answer.kind = Answer::Kind::too_large;
    } catch (const std::exception& error) {
      answer = {Answer::Kind::died, error.what()};
    }
    limit_cpu({});
    const Head head{answer.text.size(), answer.kind};
    if (!write_all(channel, &head, sizeof head) || !write_all(channel, answer.text.data(), answer.text.size())) break;
  }
  ::_exit(0);
}

bool Pool::start(Worker& worker) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return false;
  std::fflush(nullptr);  // else both processes write what is buffered
  const int process = ::fork();
  if (process == 0) {
    ::close(ends[0]);
    for (const Worker& other : workers_)
      if (other.channel >= 0) ::close(other.channel);
    serve(ends[1]);
  }
  ::close(ends[1]);
  if (process < 0) return ::close(ends[0]), false;
  worker = {process, ends[0], std::nullopt, {}};
  return true;
}

void Pool::stop(Worker& worker) {
  if (worker.process < 0) return;
  ::close(worker.channel);
  ::kill(worker.process, SIGKILL);
  while (::waitpid(worker.process, nullptr, 0) < 0 && errno == EINTR) {
  }
  worker = {};
}

bool Pool::send(Worker& worker, std::uint64_t job) {
  worker.job = job;
  return write_all(worker.channel, &job, sizeof job);
}

/// An answer if one is complete, or the worker is dead.
std::optional<Answer> Pool::receive(Worker& worker) {
  char buffer[1 << 16];
  const ssize_t count = ::read(worker.channel, buffer, sizeof buffer);
  if (count < 0 && (errno == EINTR || errno == EAGAIN)) return std::nullopt;
  if (count <= 0) return post_mortem(worker);
  worker.received.append(buffer, static_cast<std::size_t>(count));
  Head head;
  if (worker.received.size() < sizeof head) return std::nullopt;
  std::memcpy(&head, worker.received.data(), sizeof head);
  if (worker.received.size() < sizeof head + head.size) return std::nullopt;
  Answer answer{head.kind, worker.received.substr(sizeof head)};
  worker.received.clear();
  if (answer.kind == Answer::Kind::too_large)
    answer.text = fmt::format("it needs more than the {} MiB of memory that a point may take", limits_.octets >> 20);
  return answer;
}

Answer Pool::post_mortem(Worker& worker) {
  int status = 0;
  while (::waitpid(worker.process, &status, 0) < 0 && errno == EINTR) {
  }
  ::close(worker.channel);
  worker = {};
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF)
    return {Answer::Kind::too_long, fmt::format("it needs more than the {:g} s of CPU time that a point may take",
                                                static_cast<double>(limits_.cpu.ps()) * 1e-12)};
  if (WIFSIGNALED(status))
    return {Answer::Kind::died,
            fmt::format("its process was ended by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)))};
  return {Answer::Kind::died, fmt::format("its process ended with status {}", WEXITSTATUS(status))};
}

std::string Pool::run(const std::function<std::optional<std::uint64_t>()>& next,
                      const std::function<bool(std::uint64_t, const Answer&)>& on_answer,
                      const std::function<bool()>& idle) {
  bool is_more = true;
  for (;;) {
    std::vector<pollfd> watched;
    std::vector<Worker*> watched_workers;
    for (Worker& worker : workers_) {
      if (is_more && !worker.job) {
        const auto job = next();
        if (!job) {
          is_more = false;
        } else {
          if (worker.process < 0 && !start(worker))
            return fmt::format("cannot start a process: {}", std::strerror(errno));
          if (!send(worker, *job)) return "a worker process went away before it had a job";
        }
      }
      if (!worker.job) continue;
      watched.push_back({worker.channel, POLLIN, 0});
      watched_workers.push_back(&worker);
    }
    if (watched.empty()) return {};
    ::poll(watched.data(), watched.size(), 100);
    bool goes_on = idle();
    for (std::size_t i = 0; goes_on && i < watched.size(); ++i) {
      if (watched[i].revents == 0) continue;
      const std::uint64_t job = *watched_workers[i]->job;
      const auto answer = receive(*watched_workers[i]);
      if (!answer) continue;
      watched_workers[i]->job.reset();
      goes_on = on_answer(job, *answer);
    }
    if (goes_on) continue;
    for (Worker& worker : workers_) stop(worker);
    return {};
  }
}

}  // namespace takt::study
