// SPDX-License-Identifier: Apache-2.0
#include "explain/way.hpp"

#include <array>

#include "sim/check.hpp"

namespace takt::explain {
namespace {

struct Naming {
  const char* name;
  std::string_view words;
  bool is_waiting;
};
constexpr std::array<Naming, static_cast<std::size_t>(Cause::count)> names{{
    {"os_transmit", "operating system, transmit", false},
    {"processor", "processor of the host", true},
    {"launch_time", "launch time", true},
    {"ats", "ATS eligibility", true},
    {"higher_class", "behind a higher class", true},
    {"precedence", "behind a class that goes first", true},
    {"own_class", "behind its own class", true},
    {"lower_class", "behind a lower class, on the wire already", true},
    {"gate_closed", "gate closed", true},
    {"guard", "guard: would not end before its gate closes", true},
    {"credit", "credit", true},
    {"hold", "hold", true},
    {"preemption", "preemption overhead", true},
    {"transmission", "transmission", false},
    {"cable", "cable", false},
    {"forwarding", "forwarding", false},
    {"jitter", "forwarding, random part", false},
    {"os_receive", "operating system, receive", false},
}};
const Naming& naming_of(Cause cause) { return names[static_cast<std::size_t>(cause)]; }

}  // namespace

const char* name_of(Cause cause) { return naming_of(cause).name; }
std::string_view words_of(Cause cause) { return naming_of(cause).words; }
bool is_waiting(Cause cause) { return naming_of(cause).is_waiting; }

std::vector<Part> parts_of(const Way& way) {
  std::vector<Part> parts = way.before;
  for (const Hop& hop : way.hops) parts.insert(parts.end(), hop.parts.begin(), hop.parts.end());
  TrueTime at = way.produced;
  for (const Part& part : parts) {
    TAKT_CHECK(part.begin == at && part.length >= Duration(), "the parts of a latency follow each other");
    at += part.length;
  }
  TAKT_CHECK(at == way.ended, "the parts of a latency add up to it");
  return parts;
}

}  // namespace takt::explain
