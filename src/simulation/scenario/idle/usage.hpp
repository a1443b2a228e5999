// SPDX-License-Identifier: Apache-2.0
// Who uses what: which frames meet which ports and filters in a run. What tellers of idle configuration ask.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scenario/resolve/stream_at_port.hpp"
#include "scenario/topology/port_table.hpp"

namespace takt::scenario {

/// An egress port with what goes through it.
struct PortUse {
  std::uint32_t node = 0;
  std::uint16_t port = 0;
  std::uint32_t peer = 0;
  const models::LinkPlan* link = nullptr;
  const models::PortConfig* config = nullptr;
  std::vector<const StreamAtPort*> streams;  ///< those that rerouting brings here, too
  models::ClassSet classes = 0;              ///< of streams and of gPTP
  models::ClassSet classes_of_gptp = 0;
  std::vector<const models::GateConfig*> gates;  ///< the list at first and those of the script
  bool uses(models::TrafficClass q) const { return models::contains(classes, q); }
};

/// What ports one entry of "egress" configures: of generated switches, all that share it.
struct EgressUse {
  const Egress* egress = nullptr;
  std::string node;
  std::vector<const PortUse*> ports;
};

/// What switches one "ingress" belongs to.
struct IngressUse {
  const Ingress* ingress = nullptr;
  std::vector<std::uint32_t> nodes;
};

class Usage {
 public:
  explicit Usage(const Resolved& resolved);
  Usage(const Usage&) = delete;
  Usage& operator=(const Usage&) = delete;

  const Resolved& resolved() const { return r_; }
  const std::vector<StreamAtPort>& streams() const { return streams_; }
  /// Those that a link ends at, by node and number.
  const std::vector<PortUse>& ports() const { return ports_; }
  const PortUse& port(std::uint32_t node, std::uint16_t number) const { return ports_[place_.at(node, number)]; }
  const std::vector<EgressUse>& egress() const { return egress_; }
  const std::vector<IngressUse>& ingress() const { return ingress_; }

  const models::StreamPlan& plan(const StreamAtPort& at) const { return r_.plan.streams[at.stream.value]; }
  /// "sw1:2", or "the 4 ports of sw1", or "40 ports".
  std::string name(const std::vector<const PortUse*>& ports) const;
  std::string name(std::uint32_t node) const { return json::quote(r_.topology.nodes[node].name); }
  /// Why no frame is in the class at these ports: "no stream goes there; priority 0 is class 1".
  std::string why_unused(models::TrafficClass q, const std::vector<const PortUse*>& ports) const;
  /// The class of streams with that priority at these ports, if there are such and it is another number.
  std::optional<models::TrafficClass> class_of_priority(models::Priority priority,
                                                        const std::vector<const PortUse*>& ports) const;
  /// "one of the classes in use there: 1, 7".
  std::string classes_in_use(const std::vector<const PortUse*>& ports) const;
  /// Bit/s of a class at a port, as the medium carries them.
  double load(const PortUse& port, models::TrafficClass q) const;
  bool is_after_the_end(Duration at) const { return at >= r_.scenario.duration; }

 private:
  PortUse& use(std::uint32_t node, std::uint16_t number) { return ports_[place_.at(node, number)]; }
  void add_ports();
  void add_streams();
  void add_rerouted();
  void add_gptp();
  void add_egress();
  void add_ingress();

  const Resolved& r_;
  std::vector<StreamAtPort> streams_;
  std::vector<PortUse> ports_;
  PortTable<std::uint32_t> place_;  // of each port in ports_
  std::vector<EgressUse> egress_;
  std::vector<IngressUse> ingress_;
};

/// "1, 5 and 7".
std::string text_of_classes(models::ClassSet classes);
/// A warning, unless something has been said of the value or of a part of it.
void warn_once(json::Diagnostics& diagnostics, json::Place place, std::string message, json::Details details);

void report_ineffective_egress(const Usage& usage, json::Diagnostics& diagnostics);
void report_ineffective_gates(const Usage& usage, json::Diagnostics& diagnostics);
void report_ineffective_queues(const Usage& usage, json::Diagnostics& diagnostics);
void report_ineffective_ingress(const Usage& usage, json::Diagnostics& diagnostics);
void report_ineffective_streams(const Usage& usage, json::Diagnostics& diagnostics);
void report_ineffective_faults(const Usage& usage, json::Diagnostics& diagnostics);
void report_ineffective_script(const Usage& usage, json::Diagnostics& diagnostics);
void report_ineffective_clocks(const Usage& usage, json::Diagnostics& diagnostics);
void report_incapable_links(const Usage& usage, json::Diagnostics& diagnostics);
void report_ineffective_cpus(const Usage& usage, json::Diagnostics& diagnostics);
void report_ineffective_requirements(const Usage& usage, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
