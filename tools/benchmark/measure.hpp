// SPDX-License-Identifier: Apache-2.0
// CPU time, memory and medians.
#pragma once

#include <cstddef>
#include <vector>

namespace takt::benchmark {

/// CPU seconds that this process has used.
double cpu_seconds();
/// Octets that are allocated now.
std::size_t allocated_octets();
double median(std::vector<double> values);

}  // namespace takt::benchmark
