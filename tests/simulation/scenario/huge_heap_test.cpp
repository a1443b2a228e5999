// SPDX-License-Identifier: Apache-2.0
// The heap on huge pages: room is reserved where nothing limits it, and nothing happens where something does.
#include "scenario/run/huge_heap.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace takt::scenario::test::huge_heap_test {
namespace {

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
constexpr bool is_glibc_heap = true;
#else
constexpr bool is_glibc_heap = false;  // another library allocates
#endif

std::uintptr_t end_of_heap() { return reinterpret_cast<std::uintptr_t>(::sbrk(0)); }

/// By how many MiB the heap of a child grows, with this limit of its address space; vectors of all sizes still come and
/// go.
int growth(rlim_t limit) {
  const pid_t child = ::fork();
  if (child == 0) {
    rlimit now{};
    ::getrlimit(RLIMIT_AS, &now);
    now.rlim_cur = std::min(limit, now.rlim_max);
    ::setrlimit(RLIMIT_AS, &now);
    const std::uintptr_t before = end_of_heap();
    put_heap_on_huge_pages();
    const std::uintptr_t grown = end_of_heap() - before;
    std::uint64_t sum = 0;
    for (std::size_t size = 1; size <= std::size_t{1} << 23; size *= 2) {
      std::vector<std::uint64_t> some(size, 3);
      sum += some[size / 2];
    }
    ::_exit(sum == 24 * 3 ? static_cast<int>(grown >> 27) : 99);  // in 128 MiB
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) * 128 : -1;
}

TEST(HugeHeap, ReservesRoomWhereNothingLimitsIt) {
  if (!is_glibc_heap) GTEST_SKIP() << "another library allocates";
  EXPECT_EQ(growth(RLIM_INFINITY), 1024);
}

TEST(HugeHeap, LeavesALimitedProcessAlone) {
  if (!is_glibc_heap) GTEST_SKIP() << "another library allocates";
  EXPECT_EQ(growth(rlim_t{2} << 30), 0);
}

}  // namespace
}  // namespace takt::scenario::test::huge_heap_test
