// SPDX-License-Identifier: Apache-2.0
#include "cli/interrupt.hpp"

#include <csignal>

namespace takt::cli {
namespace {

// A signal handler can reach nothing but static storage; this flag is the only such thing in takt.
volatile std::sig_atomic_t interrupted = 0;

void on_signal(int) { interrupted = 1; }

void install(void (*handler)(int), int flags) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

// SA_RESETHAND gives the signal its default effect back, so that a second Ctrl-C ends a run that does not stop.
InterruptGuard::InterruptGuard() {
  interrupted = 0;
  install(on_signal, static_cast<int>(SA_RESETHAND));
}
InterruptGuard::~InterruptGuard() { install(SIG_DFL, 0); }
bool InterruptGuard::requested() const { return interrupted != 0; }

}  // namespace takt::cli
