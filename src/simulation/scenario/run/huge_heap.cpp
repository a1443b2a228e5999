// SPDX-License-Identifier: Apache-2.0
#include "scenario/run/huge_heap.hpp"

#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>

namespace takt::scenario {

void put_heap_on_huge_pages() {
#if defined(__GLIBC__) && defined(MADV_HUGEPAGE)
  constexpr std::uintptr_t huge = std::uintptr_t{1} << 21;
  for (const auto resource : {RLIMIT_AS, RLIMIT_DATA}) {
    rlimit limit{};
    if (::getrlimit(resource, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY) return;
  }
  // The heap grows in one step, because advice holds for what is there; untouched pages of it take no memory. Vectors
  // up to the greatest threshold come from it, too.
  constexpr int room = 1 << 30, usual_step = 128 << 10, greatest_threshold = 32 << 20, never = -1;
  const auto begin = reinterpret_cast<std::uintptr_t>(::sbrk(0));
  ::mallopt(M_MMAP_THRESHOLD, greatest_threshold);
  ::mallopt(M_TRIM_THRESHOLD, never);
  ::mallopt(M_TOP_PAD, room);
  void* volatile some =
      std::malloc(std::size_t{1} << 20);  // more than the heap begins with; volatile, or the compiler leaves both out
  std::free(some);
  ::mallopt(M_TOP_PAD, usual_step);
  const auto end = reinterpret_cast<std::uintptr_t>(::sbrk(0));
  const std::uintptr_t first = (begin + huge - 1) / huge * huge;
  if (end > first + huge)
    static_cast<void>(
        ::madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE));  // advice: without it all is right, too
#endif
}

}  // namespace takt::scenario
