// SPDX-License-Identifier: Apache-2.0
// The network of an emulation on this machine: a namespace for each host and switch, veth pairs between them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "emulate/plan.hpp"

namespace takt::emulate {

/// Removes namespaces and folders of emulations whose process is no more; how many there were.
std::size_t remove_leftovers();

class Machine {
 public:
  /// Lays the plan's network. Null, and `problem` says why, if the machine does not permit it; nothing is left then.
  static std::unique_ptr<Machine> lay(const Plan& plan, std::string& problem);
  /// Removes all of it.
  ~Machine();
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  const std::string& namespace_of(std::uint32_t node) const { return names_[node]; }
  /// Waits until all bridges forward, which the kernel looks after once a second: what DDS participants first say of
  /// themselves, which they say again after many seconds only, would be lost before. "" or what failed.
  std::string wait_for_bridges() const;
  /// Gives an interface an address. "" or what failed.
  std::string add_address(std::uint32_t node, const std::string& interface, const std::string& address) const;
  /// Cables are pulled and plugged. "" or what failed.
  std::string set_cable(std::uint32_t cable, bool up);
  /// A folder for files, which goes with the machine.
  const std::string& folder() const { return folder_; }

 private:
  explicit Machine(const Plan& plan);
  std::string make();

  Plan plan_;
  std::vector<std::string> names_;  ///< by node of the topology
  std::string folder_;
};

}  // namespace takt::emulate
