// SPDX-License-Identifier: Apache-2.0
#include "node/server/ordinary_thread.hpp"

#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace takt::node {
namespace {

constexpr int niceness = 5;

}  // namespace

void become_ordinary() {
  sched_param ordinary = {};
  ::sched_setscheduler(0, SCHED_OTHER, &ordinary);
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::syscall(SYS_gettid)), niceness);
}

}  // namespace takt::node
