// SPDX-License-Identifier: Apache-2.0
#include "models/gptp/port_selection.hpp"

namespace takt::models::gptp {
namespace {

PortRole role_of(const PortInformation& port, PortNumber number, const Selection& selection, ClockIdentity self) {
  if (port.info_is == InfoIs::disabled) return PortRole::disabled;
  if (port.info_is != InfoIs::received) return PortRole::time_transmitter;
  if (number == selection.receiver) return PortRole::time_receiver;
  return selection.announced_at(number, self) < port.priority ? PortRole::time_transmitter : PortRole::passive;
}

}  // namespace

void select_roles(const SystemIdentity& self, const std::vector<PortInformation>& ports, Selection& selection) {
  selection.grandmaster = {self, 0, {self.clock, 0}, 0};
  selection.receiver = 0;
  for (std::size_t i = 0; i < ports.size(); ++i) {
    if (ports[i].info_is != InfoIs::received || ports[i].priority.source.clock == self.clock) continue;
    const PriorityVector path = ports[i].priority.one_step_further();
    if (path < selection.grandmaster) {
      selection.grandmaster = path;
      selection.receiver = static_cast<PortNumber>(i + 1);
    }
  }
  selection.roles.resize(ports.size());
  for (std::size_t i = 0; i < ports.size(); ++i)
    selection.roles[i] = role_of(ports[i], static_cast<PortNumber>(i + 1), selection, self.clock);
}

}  // namespace takt::models::gptp
