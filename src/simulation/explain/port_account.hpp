// SPDX-License-Identifier: Apache-2.0
// What the medium of a port was used for while frames waited there, and why others might not start: hence why a frame
// waits.
#pragma once

#include <deque>
#include <vector>

#include "explain/way.hpp"
#include "models/ethernet/traffic.hpp"

namespace takt::explain {

class PortAccount {
 public:
  /// A frame, or what was left of it, is on the medium until then, gap included.
  void started(TrueTime now, TrueTime free_at, FrameName frame, models::TrafficClass q, bool is_rest);
  /// It is cut, and has the medium for so long.
  void cut(Duration occupied);
  void refused(TrueTime now, TrueTime until, const models::BlockedRecord& refusal);
  /// Nobody waits who asks: only what is on the medium, and what is said at this instant, counts from here on.
  void forget(TrueTime now);
  /// Whoever waits has waited since then, or less: what was decided before it and is over does not count any more.
  void forget_before(TrueTime earliest);

  struct Waiting {
    TrueTime from;
    TrueTime until;
    models::TrafficClass traffic_class = 0;
    bool is_rest = false;          ///< of a frame that was cut
    bool has_launch_time = false;  ///< what is not eligible waits for it, not for an ATS scheduler's time
  };
  /// Whose frame was the last to start.
  std::optional<FrameName> last_started() const;
  /// The parts of that time, appended. Precondition: the account has not been told to forget since.
  void explain(const Waiting& waiting, std::vector<Part>& parts) const;

 private:
  /// From a decision of the port to the next one.
  struct Decision {
    TrueTime at;
    std::vector<std::pair<models::BlockedRecord, TrueTime>> refusals = {};  // and until when at most
    bool starts = false;
    FrameName frame = {};
    TrueTime free_at = {};
    models::TrafficClass traffic_class = 0;
    bool is_rest = false;
  };
  Decision& decision_at(TrueTime now);
  std::deque<Decision> decisions_;
};

}  // namespace takt::explain
