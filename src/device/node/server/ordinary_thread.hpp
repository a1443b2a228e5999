// SPDX-License-Identifier: Apache-2.0
// Threads that run beside the cycle.
#pragma once

namespace takt::node {

/// Whatever the cycle asked of the scheduler is not for the calling thread: no real-time priority, and behind a cycle
/// that has none either.
void become_ordinary();

}  // namespace takt::node
