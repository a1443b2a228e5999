#include "analysis/assumption.hpp"

#include <array>

namespace takt::analysis {
namespace {

struct Text {
  Assumption assumption;
  std::string_view name;
  std::string_view text;
};

constexpr std::array<Text, static_cast<std::size_t>(Assumption::count)> texts = {{
    {Assumption::no_fault, "no-fault", "No link or node fails, no gate is stuck, no clock jumps; paths are as laid. The faults of the scenario are left out."},
    {Assumption::listed_faults_only, "listed-babble-only", "Talkers babble as the scenario lists it, at any time, and not otherwise."},
    {Assumption::os_latency, "os-latency", "Operating systems delay by at most the greatest value of their distributions."},
    {Assumption::clock_rate, "clock-rate", "Oscillators keep to the greatest deviation that the scenario gives them; clocks that nothing holds together slide past each other."},
    {Assumption::clock_error, "clock-error", "Synchronised clocks are within the clock error (a requirement \"sync\" of the scenario, or --clock-error) from the start."},
    {Assumption::gptp_traffic, "gptp-traffic", "A port sends each kind of gPTP message at most once in half of its interval, in each domain."},
    {Assumption::gates_in_force, "gates-in-force", "Gate lists run already, as they do from their base time on."},
    {Assumption::gates_do_not_change, "gates-do-not-change", "No frame waits while a gate list is exchanged for another; the bound holds for each list."},
    {Assumption::elimination, "elimination", "Any one copy of a frame of a redundant stream may be the only one that comes; a recovery passes a frame once, or, where match recovery or a reset timer may forget it, each copy of it."},
    {Assumption::program_publishes, "changes-in-a-cycle", "A participant that publishes on change does so at most four times in a cycle, and so does whoever gives, gets or loses a role."},
    {Assumption::no_loss, "no-loss", "No message between participants is lost."},
    {Assumption::one_command, "one-command", "Nobody calls another method, and no alarm is raised, until all have reached the state."},
    {Assumption::initialisation, "initialisation", "Initialisations last as long as the scenario says."},
    {Assumption::sampled_states, "no-missed-state", "In the paper's handshake no state is missed between two publications."},
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

}  // namespace takt::analysis
