// SPDX-License-Identifier: Apache-2.0
// The processes that run applications and gateways in an emulation: started, killed with their hosts, asked at their
// end.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "emulate/application_comparison.hpp"
#include "emulate/child.hpp"
#include "emulate/machine.hpp"
#include "emulate/plan.hpp"

namespace takt::emulate {

class ApplicationProcesses {
 public:
  /// All outlive it.
  ApplicationProcesses(const scenario::Resolved& resolved, const Plan& plan, Machine& machine)
      : resolved_(resolved), plan_(plan), machine_(machine) {}

  /// All at once, when the bridges forward, so that their counts are those of one time. "" or what failed.
  std::string start();
  /// Whose process has not told of its start yet; "" if all have.
  std::string not_started() const;
  /// They end by themselves after the duration of the scenario, which nobody else waits for. What one said that has
  /// ended otherwise; "" if none has.
  std::string failure();
  /// A host is killed, or starts again.
  void set_host(std::uint32_t host, bool up);
  /// Waits until those have ended that were never killed; `at_once`: for none. The others are told to.
  void stop(bool at_once);
  void wait();
  /// Of all of them: what they ran by, told and complained of.
  std::vector<std::string> files() const;
  /// After their end: what their threads counted, and by application whether its process was never killed. "" or what
  /// failed.
  std::string collect(EmulatedThreads& threads, std::vector<bool>& is_whole) const;

 private:
  struct Process {
    const PlannedApplications* plan = nullptr;
    std::string file;
    std::string log;
    std::string errors;
    bool is_whole = true;          ///< never killed
    std::unique_ptr<Child> child;  ///< null while its host is down
  };
  void start(Process& process, bool again);
  const std::string& name_of(const Process& process) const { return resolved_.topology.nodes[process.plan->host].name; }

  const scenario::Resolved& resolved_;
  const Plan& plan_;
  Machine& machine_;
  std::deque<Process> processes_;
};

}  // namespace takt::emulate
