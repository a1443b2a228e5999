// SPDX-License-Identifier: Apache-2.0
// The vocabulary of gates for a whole network.
#include "scenario/description/description.hpp"

namespace takt::scenario {

using json::name;
using json::optional;

const json::Enumeration& describe(json::Type<GatePlanning>) {
  static constexpr json::EnumName names[] = {
      name(GatePlanning::none, "none", "only the gates that nodes have in their \"egress\""),
      name(GatePlanning::automatic, "auto",
           "a no-wait window for each scheduled stream along its path; what does not fit is an error"),
      name(GatePlanning::listed, "listed", "the lists that follow, as \"auto\" leaves them in the resolved copy"),
  };
  static constexpr json::Enumeration table = json::enumeration<GatePlanning>("a plan of gates", names);
  return table;
}

const json::Enumeration& describe(json::Type<GateGuard>) {
  static constexpr json::EnumName names[] = {
      name(GateGuard::length_aware, "length-aware",
           "other classes close an inter-packet gap before a window; ports start no frame that would not end by then"),
      name(GateGuard::longest_frame, "longest-frame",
           "they close the time of the longest frame before, 1522 octets where there are no jumbo frames, for switches "
           "that do not look at the length"),
  };
  static constexpr json::Enumeration table = json::enumeration<GateGuard>("a guard", names);
  return table;
}

const json::Object& describe(json::Type<NetworkGates>) {
  static constexpr json::Field fields[] = {
      optional<&NetworkGates::plan>("plan", "Where the gates come from."),
      optional<&NetworkGates::margin>("margin",
                                      "With \"auto\": the clocks of any two nodes differ by at most this. 0 with ideal "
                                      "clocks, otherwise 1us if absent. \"auto\": `takt schedule` measures it.",
                                      {.max = 1_s}),
      optional<&NetworkGates::classes>("classes",
                                       "With \"auto\": the scheduled traffic classes; those of the programs if absent. "
                                       "Every stream of them gets windows.",
                                       {.max_items = 8, .unique = true, .items = {.max = 7}}),
      optional<&NetworkGates::guard>("guard", "With \"auto\": how long before a window the other classes close."),
      optional<&NetworkGates::lists>("lists", "With \"listed\": the gates of ports.", {.max_items = 65'536}),
  };
  static constexpr json::Object table =
      json::object<NetworkGates>("network_gates", "Transmission gates (IEEE 802.1Q 8.6.8.4, Qbv) for a whole network.",
                                 fields, {.shorthand = "plan"});
  return table;
}

}  // namespace takt::scenario
