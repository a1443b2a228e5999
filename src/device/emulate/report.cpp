// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "emulate/emulation.hpp"

namespace takt::emulate {
namespace {

std::string sequence_of(const std::vector<handshake::StateChange>& changes) {
  std::string text = "Halted";
  for (const handshake::StateChange& change : changes)
    text += (change.transition == 0 && change.to == handshake::PublishedState::Halted ? " x " : " ") +
            std::string(name_of(change.to));
  return text;
}

std::string nodes_of(const std::vector<std::string>& nodes) {
  std::string text;
  for (const std::string& each : nodes) text += (text.empty() ? "" : ", ") + (each.empty() ? "nobody" : each);
  return text.empty() ? "nobody" : text;
}

double us_of(std::int64_t ns) { return static_cast<double>(ns) / 1000; }

std::string times_text(const char* what, const Times& emulated, const Times& simulated) {
  return fmt::format("    {}: mean {:.1f} us ({:.1f}), max {:.1f} us ({:.1f})\n", what, us_of(emulated.mean_ns),
                     us_of(simulated.mean_ns), us_of(emulated.max_ns), us_of(simulated.max_ns));
}

std::string signal_text(const SignalCounts& emulated, const SignalCounts& simulated) {
  return fmt::format("    signal: {} edges ({}), {} pulses irregular ({})\n", emulated.edges, simulated.edges,
                     emulated.irregular_pulses, simulated.irregular_pulses) +
         times_text("signal latency", emulated.latency, simulated.latency) +
         times_text("signal pulses", emulated.pulses, simulated.pulses);
}

}  // namespace

std::string to_text(const Result& result, const std::string& scenario) {
  std::string out;
  for (const std::string& note : result.notes) out += fmt::format("note: {}\n", note);
  for (const ProgramResult& program : result.programs) {
    out += fmt::format("\nProgram {}\n", program.name);
    for (const ParticipantComparison& each : program.comparison.participants) {
      out += fmt::format("  {:<16} {}\n", each.name, each.same ? "as simulated" : "NOT as simulated");
      out += each.same ? fmt::format("    {}\n", sequence_of(each.emulated))
                       : fmt::format("    simulated: {}\n    emulated:  {}\n", sequence_of(each.simulated),
                                     sequence_of(each.emulated));
    }
    for (const RoleResult& each : program.roles)
      out += each.simulated == each.emulated
                 ? fmt::format("  role {:<11} {}\n", each.name, nodes_of(each.emulated))
                 : fmt::format("  role {:<11} NOT as simulated\n    simulated: {}\n    emulated:  {}\n", each.name,
                               nodes_of(each.simulated), nodes_of(each.emulated));
    out += fmt::format("  {} orders between participants, {} violated\n", program.comparison.orders,
                       program.comparison.violated.size());
    for (const std::string& each : program.comparison.violated) out += fmt::format("    {}\n", each);
  }
  for (const ApplicationComparison& application : result.applications) {
    out += fmt::format("\nApplication {} on {}{}\n", application.name, application.node,
                       application.is_whole ? "" : ", which was killed: nothing is compared");
    for (const ThreadComparison& each : application.threads) {
      const auto counted = [](const char* what, std::uint64_t emulated, std::uint64_t simulated) {
        return fmt::format(", {} {} ({})", emulated, what, simulated);
      };
      const std::string values = each.publishes
                                     ? counted("published", each.emulated.published, each.simulated.published)
                                     : counted("received", each.emulated.received, each.simulated.received) +
                                           counted("lost", each.emulated.lost, each.simulated.lost);
      out += fmt::format("  {:<16} {}: {} activations ({}){}{}\n", each.name,
                         each.is_same() ? "as simulated" : "NOT as simulated", each.emulated.activations,
                         each.simulated.activations, counted("missed", each.emulated.missed, each.simulated.missed),
                         values);
      out += times_text("response", each.emulated.response, each.simulated.response);
      if (each.simulated.signal)
        out += signal_text(each.emulated.signal.value_or(SignalCounts()), *each.simulated.signal);
      for (const std::string& difference : each.differs) out += fmt::format("    {}\n", difference);
    }
  }
  if (!result.applications.empty()) out += "  (in brackets: simulated)\n";
  if (!result.programs.empty())
    out += fmt::format("\n{} steps of the nodes against S1, S2, S4 and S5: {} violated\n", result.invariants.steps,
                       result.invariants.violated.size());
  for (const std::string& each : result.invariants.violated) out += fmt::format("  {}\n", each);
  if (result.interrupted) return out + fmt::format("\n{}: interrupted\n", scenario);
  return out + fmt::format("\n{}: {}\n", scenario,
                           result.is_same()
                               ? (result.programs.empty() ? "threads act and get values as simulated"
                                                          : "the same transitions in the same order as simulated")
                               : "differs from the simulated run");
}

}  // namespace takt::emulate
