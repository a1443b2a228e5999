// SPDX-License-Identifier: Apache-2.0
// A proof of a solver made one that is easy to check: each step says from what it follows, and what leads nowhere is
// left out.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "schedule/certificate.hpp"

namespace takt::schedule {

/// `proof` is DRAT as text, of which only steps by unit propagation are understood; nothing if it has others, or does
/// not end in the empty clause. Thresholds that no clause speaks of are left out of the result as well.
struct TrimmedProof {
  ClausalProof proof;
  std::vector<std::uint32_t> axioms;  ///< by axiom of the proof: which one it was
};
std::optional<TrimmedProof> trim(std::span<const Clause> axioms, const std::vector<Threshold>& thresholds,
                                 std::string_view proof);

}  // namespace takt::schedule
