#include "node/security_memory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>

#include "security/random.hpp"

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
  for (std::size_t slash = path.find('/', 1); slash != std::string::npos; slash = path.find('/', slash + 1)) ::mkdir(path.substr(0, slash).c_str(), 0700);
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
  for (const char c : node) name += (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ? c : '_';
  return folder() + "/" + name + ".memory";
}

std::unique_ptr<SecurityMemory> SecurityMemory::open(const std::string& path, std::string& problem) {
  const auto fail = [&](const std::string& what) {
    problem = what + " (the memory of what was signed and heard, " + path + ")";
    return nullptr;
  };
  make_folders(path);
  FileDescriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!file.is_open()) return fail(what_failed("no file"));
  struct stat status = {};
  if (::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode) || status.st_uid != ::geteuid() || (status.st_mode & 077) != 0)
    return fail("not a file of this user with mode 0600");
  if (::flock(file.number(), LOCK_EX | LOCK_NB) != 0) return fail("another node has it");
  const bool is_new = status.st_size == 0;
  if (!is_new && static_cast<std::size_t>(status.st_size) != sizeof(Contents)) return fail("a file of something else");
  if (is_new && ::ftruncate(file.number(), sizeof(Contents)) != 0) return fail(what_failed("no room"));
  void* const mapped = ::mmap(nullptr, sizeof(Contents), PROT_READ | PROT_WRITE, MAP_SHARED, file.number(), 0);
  if (mapped == MAP_FAILED) return fail(what_failed("not mapped"));
  auto& contents = *static_cast<Contents*>(mapped);
  std::unique_ptr<SecurityMemory> memory(new SecurityMemory(std::move(file), contents));
  if (is_new) {
    // Begins anywhere: a file that was lost does not lead back to lives that have been.
    std::array<std::byte, 4> random;
    security::SystemRandom().fill(random);
    contents.kind = magic;
    contents.life = sim::load<std::uint32_t>(random.data(), sim::ByteOrder::little);
  }
  if (contents.kind != magic) return fail("a file of something else");
  ++contents.life;
  if (::msync(mapped, sizeof(Contents), MS_SYNC) != 0) return fail(what_failed("not written"));
  return memory;
}

SecurityMemory::~SecurityMemory() { ::munmap(contents_, sizeof(Contents)); }

std::uint16_t SecurityMemory::life() const { return static_cast<std::uint16_t>(contents_->life); }

security::ReplayMemory SecurityMemory::windows() { return security::ReplayMemory(contents_->windows); }

}  // namespace takt::node
