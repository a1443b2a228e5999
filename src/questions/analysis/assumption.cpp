// SPDX-License-Identifier: Apache-2.0
#include "analysis/assumption.hpp"

#include <array>

namespace takt::analysis {
namespace {

struct Text {
  Assumption assumption;
  bool is_condition;
  std::string_view name;
  std::string_view text;
};

constexpr std::array<Text, static_cast<std::size_t>(Assumption::count)> texts = {{
    {Assumption::nothing_else, true, "nothing-else",
     "Nothing is sent but what the scenario lists, and devices are as fast as it says."},
    {Assumption::listed_faults_only, true, "listed-faults-only",
     "What fails, and the talkers that babble, are those of the scenario."},
    {Assumption::os_latency, true, "os-latency",
     "Operating systems delay by at most the greatest value of their distributions."},
    {Assumption::execution_times, true, "execution-times",
     "Jobs take a processor for at most the greatest value of their execution time, and nothing else does."},
    {Assumption::clock_rate, true, "clock-rate",
     "Oscillators keep to the greatest deviation that the scenario gives them; clocks that nothing holds together "
     "slide past each other."},
    {Assumption::clock_difference, false, "clock-difference",
     "Synchronised clocks of the nodes on a way, and of ways that meet, are within the clock difference of each "
     "other."},
    {Assumption::gptp_traffic, true, "gptp-traffic",
     "A port sends each kind of gPTP message at most once in half of its interval, in each domain."},
    {Assumption::gates_in_force, false, "gates-in-force",
     "Gate lists run already, as they do from their base time on."},
    {Assumption::gates_do_not_change, false, "gates-do-not-change",
     "No frame waits while a gate list is exchanged for another; the bound holds for each list."},
    {Assumption::no_disturbance, false, "no-disturbance",
     "No gate is stuck, no clock jumps, and no frame goes in circles."},
    {Assumption::drained, false, "drained", "What was sent before everything above held has left the network."},
    {Assumption::program_publishes, false, "changes-in-a-cycle",
     "A participant that publishes on change does so at most four times in a cycle, and so does whoever gives, gets or "
     "loses a role."},
    {Assumption::no_loss, false, "no-loss", "No message between participants is lost."},
    {Assumption::initialisation, true, "initialisation", "Initialisations last as long as the scenario says."},
    {Assumption::sampled_states, false, "no-missed-state",
     "In the paper's handshake no state is missed between two publications."},
}};

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < texts.size(); ++i)
    if (texts[i].assumption != static_cast<Assumption>(i)) return false;
  return true;
}
static_assert(is_in_order(), "each assumption has its text");

}  // namespace

std::string_view name_of(Assumption assumption) { return texts[static_cast<std::size_t>(assumption)].name; }
std::string_view text_of(Assumption assumption) { return texts[static_cast<std::size_t>(assumption)].text; }
bool is_condition(Assumption assumption) { return texts[static_cast<std::size_t>(assumption)].is_condition; }

}  // namespace takt::analysis
