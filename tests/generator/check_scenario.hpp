// SPDX-License-Identifier: Apache-2.0
// What must hold of every sound scenario, whatever it combines.
//
//   load       what the loader takes, the schema takes; and a copy with all defaults is the same scenario: the same
//   digest run        a run comes to its end without a broken invariant, and all its reports can be written digest it
//   is the same with a recorder and without, and whatever the order of equal events threads    so is the result on
//   several threads, whatever part a node is in (scenarios that can be divided) wire       the wire checker finds
//   nothing (scenarios whose clocks are ideal) frames     what was sent or copied was delivered, dropped, or is on its
//   way; nothing leaks ways       the latency of every frame is explained: parts add up, and what they blame was on
//   that wire; deliveries and losses are all there clocks     what passes of clocks is so at every look, whomever they
//   follow; nothing passes that two grandmasters show; no gate keeps gPTP waiting for ever outputs    whatever the
//   names: reports, tables, pages, recordings and exports keep their form, and can be read back bound      no run
//   exceeds a bound phases     nor does the run of a study, whose phases the seed draws where nobody gives them order
//   bounds are the same with streams, nodes and links in another order in the file verify     contradicts neither
//   itself nor a run, and its worst runs can be replayed
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace takt::generator {

struct Finding {
  std::string check;
  std::string message;
};

struct Checked {
  bool is_sound = false;  ///< false: the loader refuses it, and nothing else was checked
  std::string refusal;
  std::vector<Finding> findings;  ///< by the first failure of each check
  std::uint64_t events = 0;       ///< of one run
  std::vector<std::string> done;  ///< the checks that applied
};

struct CheckOptions {
  std::uint64_t verify_events = 300'000;  ///< what the search of `verify` may cost; 0: it is left out
  std::uint64_t most_states = 20'000;     ///< to explore for the invariants of Programs
  std::string only;                       ///< the name of a check, which is all that is done beside "run"; empty: all
};

/// `file` is the name that the text has: traces are looked for beside it.
Checked check_scenario(const std::string& text, const std::string& file, const CheckOptions& options = {});

}  // namespace takt::generator
