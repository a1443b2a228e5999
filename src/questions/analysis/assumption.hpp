// SPDX-License-Identifier: Apache-2.0
// What bounds and proofs rest on. Each says which assumptions it needs; an AssumptionLedger says what becomes of them
// in a scenario.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace takt::analysis {

enum class Assumption : std::uint8_t {
  nothing_else,
  listed_faults_only,
  os_latency,
  execution_times,
  clock_rate,
  clock_difference,
  gptp_traffic,
  gates_in_force,
  gates_do_not_change,
  no_disturbance,
  drained,
  program_publishes,
  no_loss,
  initialisation,
  sampled_states,
  count
};

/// A set of assumptions.
class Assumptions {
 public:
  void add(Assumption assumption) { bits_ |= std::uint32_t{1} << static_cast<unsigned>(assumption); }
  void add(const Assumptions& others) { bits_ |= others.bits_; }
  bool contains(Assumption assumption) const { return (bits_ >> static_cast<unsigned>(assumption) & 1U) != 0; }
  std::vector<Assumption> list() const {
    std::vector<Assumption> all;
    for (unsigned i = 0; i < static_cast<unsigned>(Assumption::count); ++i)
      if (contains(static_cast<Assumption>(i))) all.push_back(static_cast<Assumption>(i));
    return all;
  }
  bool operator==(const Assumptions&) const = default;

 private:
  std::uint32_t bits_ = 0;
};

/// The name in reports, such as "clock-difference", and a sentence.
std::string_view name_of(Assumption assumption);
std::string_view text_of(Assumption assumption);
/// Only the plant can keep it (nothing else is sent, oscillators keep within their tolerance): it is a condition of
/// every proof that needs it, and no run of the simulator can contradict it.
bool is_condition(Assumption assumption);

}  // namespace takt::analysis
