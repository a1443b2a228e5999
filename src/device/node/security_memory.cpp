// SPDX-License-Identifier: Apache-2.0
#include "node/security_memory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>

namespace takt::node {
namespace {

constexpr std::uint64_t magic = 0x3130'6D65'6D74'6B74;  // "tktmem01"

std::string folder() {
  const auto of = [](const char* variable) -> std::string {
    const char* const value = std::getenv(variable);
    return value != nullptr && *value == '/' ? value : "";
  };
  if (const std::string service = of("STATE_DIRECTORY"); !service.empty()) return service.substr(0, service.find(':'));
  if (::geteuid() == 0) return "/var/lib/takt";
  if (const std::string state = of("XDG_STATE_HOME"); !state.empty()) return state + "/takt";
  return of("HOME") + "/.local/state/takt";
}

void make_folders(const std::string& path) {
  for (std::size_t slash = path.find('/', 1); slash != std::string::npos; slash = path.find('/', slash + 1))
    ::mkdir(path.substr(0, slash).c_str(), 0700);
}

/// A key is used for three lifetimes at most, and lives are in the order of serial numbers of 16 bits: so many units
/// are half of them.
constexpr std::int64_t units_of_three_lifetimes = 1 << 15;
/// Nothing begins anew so quickly.
constexpr std::int64_t shortest_unit_ns = 50'000'000;

std::int64_t time_of_day_ns() {
  timespec time = {};
  ::clock_gettime(CLOCK_REALTIME, &time);
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

/// 32 bits, of which messages have 16.
std::uint32_t life_at(std::int64_t now_ns, std::int64_t unit_ns) {
  return static_cast<std::uint32_t>(now_ns / unit_ns);
}
bool is_later_life(std::uint32_t life, std::uint32_t other) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(life - other)) > 0;
}

void wait_ns(std::int64_t length_ns) {
  timespec left = {static_cast<time_t>(length_ns / 1'000'000'000), static_cast<long>(length_ns % 1'000'000'000)};
  while (::nanosleep(&left, &left) != 0 && errno == EINTR) {
  }
}

}  // namespace

struct SecurityMemory::Contents {
  std::uint64_t kind;
  std::uint32_t life;
  std::uint32_t reserved;
  std::array<security::StoredWindow, security::ReplayMemory::most_streams> windows;
};

std::string default_memory_path(std::string_view node) {
  std::string name;
  for (const char c : node)
    name += (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ? c : '_';
  return folder() + "/" + name + ".memory";
}

std::unique_ptr<SecurityMemory> SecurityMemory::open(const std::string& path, sim::Duration key_lifetime,
                                                     std::string& problem) {
  const auto fail = [&](const std::string& what) {
    problem = what + " (the memory of what was signed and heard, " + path + ")";
    return nullptr;
  };
  make_folders(path);
  FileDescriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!file.is_open()) return fail(what_failed("no file"));
  struct stat status = {};
  if (::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode) || status.st_uid != ::geteuid() ||
      (status.st_mode & 077) != 0)
    return fail("not a file of this user with mode 0600");
  if (::flock(file.number(), LOCK_EX | LOCK_NB) != 0) return fail("another node has it");
  const bool is_empty = status.st_size == 0;
  if (!is_empty && static_cast<std::size_t>(status.st_size) != sizeof(Contents))
    return fail("a file of something else");
  // All of it is there before it is mapped: a disk that is full later does not end the process when it writes into a
  // hole.
  if (const int error = ::posix_fallocate(file.number(), 0, sizeof(Contents)); error != 0) {
    if (is_empty) static_cast<void>(!::ftruncate(file.number(), 0));
    errno = error;
    return fail(what_failed("no room"));
  }
  void* const mapped = ::mmap(nullptr, sizeof(Contents), PROT_READ | PROT_WRITE, MAP_SHARED, file.number(), 0);
  if (mapped == MAP_FAILED) return fail(what_failed("not mapped"));
  auto& contents = *static_cast<Contents*>(mapped);
  std::unique_ptr<SecurityMemory> memory(new SecurityMemory(std::move(file), contents));
  const std::int64_t unit_ns = std::max(key_lifetime.ps() / 1000 * 3 / units_of_three_lifetimes, shortest_unit_ns);
  const bool is_new = contents.kind == 0;  // empty, or its first start was cut short
  if (is_new) {
    const std::int64_t now_ns = time_of_day_ns();
    wait_ns(unit_ns - now_ns % unit_ns);
    contents.kind = magic;
  }
  if (contents.kind != magic) return fail("a file of something else");
  const std::uint32_t by_time = life_at(time_of_day_ns(), unit_ns);
  contents.life = is_new || is_later_life(by_time, contents.life + 1) ? by_time : contents.life + 1;
  if (::msync(mapped, sizeof(Contents), MS_SYNC) != 0) return fail(what_failed("not written"));
  return memory;
}

SecurityMemory::~SecurityMemory() { ::munmap(contents_, sizeof(Contents)); }

std::uint16_t SecurityMemory::life() const { return static_cast<std::uint16_t>(contents_->life); }

std::uint16_t SecurityMemory::begin_life() {
  ++contents_->life;
  return life();
}

security::ReplayMemory SecurityMemory::windows() { return security::ReplayMemory(contents_->windows); }

}  // namespace takt::node
