// SPDX-License-Identifier: Apache-2.0
// Programs that run allocate nothing: no message, no step of the handshake, no process data.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

#include "support.hpp"

namespace {

std::uint64_t allocations = 0;  // of the whole process; the tests run one after the other in one thread

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  void* const memory = alignment <= alignof(std::max_align_t)
                           ? std::malloc(size == 0 ? 1 : size)
                           : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

// Not inlined: GCC would see that what `new` made is given to free() and warn.
[[gnu::noinline]] void* operator new(std::size_t size) { return counted(size, 1); }
[[gnu::noinline]] void* operator new[](std::size_t size) { return counted(size, 1); }
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void* operator new[](std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}

[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace takt::scenario::test {
namespace {

void expect_none_while_running(const std::string& subscription) {
  const std::string text = std::string(R"({"name": "g", "duration": "400ms",
 "network": {"generate": [{"topology": "line", "switches": 1, "hosts_per_switch": 6, "forwarding_delay": "1us"}]},
 "programs": [{"name": "p", "master": "h1", "slaves": ["h2", "h3", "h4", "h5", "h6"], "cycle": "500us", "subscription": ")") +
                           subscription + R"(",
   "process_data": [{"name": "down", "from": "h1", "fields": {"x": {"type": "Double", "count": 20}}}, {"name": "up", "from": "h2", "fields": {"x": "Double"}}]}],
 "script": [{"at": "1.1ms", "program": "p", "call": "Start"}]})";
  const auto resolved = sound(text);
  LiveRun run(*resolved);
  while (!run.advance(1000) && run.simulation().now() < sim::TrueTime() + 100_ms) {
  }
  ASSERT_EQ(run.state(0, 0), handshake::PublishedState::Running);
  const std::uint64_t before = allocations;
  run.advance();
  EXPECT_EQ(allocations, before);
  EXPECT_GT(run.monitor(0).process_data_received(), 2000u);
}

TEST(Allocation, NoneWhileRunningInAStar) { expect_none_while_running("star"); }
TEST(Allocation, NoneWhileRunningAllToAll) { expect_none_while_running("all-to-all"); }

}  // namespace
}  // namespace takt::scenario::test
