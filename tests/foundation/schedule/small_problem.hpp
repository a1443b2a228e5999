// SPDX-License-Identifier: Apache-2.0
// Small problems for the tests of the search and its judges.
#pragma once

#include "schedule/problem.hpp"

namespace takt::schedule {

inline constexpr Ps us = 1'000'000;

/// Bridges b0, b1, ... in a line, a station h0, h1, ... at each; 1 Gbit/s. Links: h0>b0, b0>h0, h1>b1, ...; then b0>b1,
/// b1>b0, b1>b2, ...
Problem line(std::size_t bridges, Ps propagation = 0, Ps forwarding = us);
LinkIndex link_of(const Problem& problem, const std::string& name);
NodeIndex node_of(const Problem& problem, const std::string& name);
/// A stream of one frame a period; 125 octets with preamble and gap take 1 us at 1 Gbit/s, so `length` in us is exact.
Stream& add_stream(Problem& problem, const std::string& from, const std::string& to, Ps length_us, Ps period);
/// A problem of every feature, from the seed.
Problem random_problem(std::uint64_t seed);

}  // namespace takt::schedule
