// SPDX-License-Identifier: Apache-2.0
// Random scenarios run by two builds of takt: this one and another, of which only the program is there.
#pragma once

#include <csignal>
#include <cstdint>
#include <string>

namespace takt::generator {

/// What another build makes of a scenario, compared with what this one makes of it.
struct Compared {
  bool is_refused = false;  ///< by one of the two builds: nothing was compared
  std::string difference;   ///< empty: there is none
};

class OtherBuild {
 public:
  /// `program` is takt of the other build, or its takt_digest, which is quicker. Digests are compared; with
  /// `recordings` also the rows of frames.csv and hops.csv, sorted by time and node and the rest of the row, so that a
  /// change of the digest or of the order within an instant is none. That takes takt.
  OtherBuild(std::string program, bool recordings);

  /// `file` is the name that the text has: traces are looked for beside it.
  Compared compare(const std::string& text, const std::string& file) const;

 private:
  std::string program_;
  bool recordings_;
  bool is_digest_ = false;  // takt_digest
};

struct AgainstOptions {
  std::string program;
  bool recordings = false;
  double hours = 1;
  std::uint64_t first = 0;
  std::uint64_t count = 2'000;
  unsigned jobs = 1;
  std::string folder;  ///< what differs is put there: against-NUMBER.json, the least scenario that does, and .txt
};

/// The exit status: 0 no scenario differs, 1 one does, 130 interrupted.
int soak_against(const AgainstOptions& options, const volatile std::sig_atomic_t& interrupted);

}  // namespace takt::generator
