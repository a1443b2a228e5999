#include "interchange/yang/schema.hpp"

#include <algorithm>
#include <array>

#include "interchange/yang/modules.hpp"

namespace takt::interchange::yang {
namespace {

using enum Type;

struct Module {
  std::string_view name;
  std::string_view name_space;
};

constexpr Module modules[] = {
    {if_m, "urn:ietf:params:xml:ns:yang:ietf-interfaces"},
    {ianaift_m, "urn:ietf:params:xml:ns:yang:iana-if-type"},
    {dot1q_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1q-bridge"},
    {types_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1q-types"},
    {sched_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1q-sched"},
    {sched_bridge_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1q-sched-bridge"},
    {preempt_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1q-preemption"},
    {preempt_bridge_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1q-preemption-bridge"},
    {cbsa_bridge_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1q-cbsa-bridge"},
    {psfp_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1q-psfp"},
    {psfp_bridge_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1q-psfp-bridge"},
    {sfsg_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1q-stream-filters-gates"},
    {ats_bridge_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1q-ats-bridge"},
    {sid_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1cb-stream-identification"},
    {frer_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1cb-frer"},
    {eth_m, "urn:ieee:std:802.3:yang:ieee802-ethernet-interface"},
    {mac_merge_m, "urn:ieee:std:802.3:yang:ieee802-ethernet-mac-merge"},
    {iec_sched_m, "urn:ieee:std:60802:yang:iecieee60802-sched-bridge"},
    {stream_id_2017_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1q-stream-id"},
    {cnc_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1q-cnc-config"},
};

constexpr std::string_view gate_operations = "ieee802-dot1q-sched:set-gate-states|ieee802-dot1q-sched:set-and-hold-mac|ieee802-dot1q-sched:set-and-release-mac";
constexpr std::string_view algorithms =
    "ieee802-dot1q-types:strict-priority|ieee802-dot1q-types:credit-based-shaper|ieee802-dot1q-types:enhanced-transmission-selection|ieee802-dot1q-types:asynchronous-traffic-shaping";
constexpr std::string_view ipv = "zero|one|two|three|four|five|six|seven|null";
constexpr std::string_view priorities = "zero|one|two|three|four|five|six|seven|wildcard";

constexpr Schema leaf(std::string_view module, std::string_view name, Type type, bool mandatory = false, std::uint64_t least = 0, std::uint64_t most = ~std::uint64_t{0}) {
  return {module, name, type, {}, {}, {}, mandatory, least, most};
}
constexpr Schema one_of(std::string_view module, std::string_view name, std::string_view choices, bool mandatory = false) { return {module, name, choice, {}, {}, choices, mandatory}; }
constexpr Schema identity_of(std::string_view module, std::string_view name, std::string_view choices, bool mandatory = false) { return {module, name, identity, {}, {}, choices, mandatory}; }
constexpr Schema node(std::string_view module, std::string_view name, std::span<const Schema> children) { return {module, name, container, children}; }
constexpr Schema entries(std::string_view module, std::string_view name, std::string_view key, std::span<const Schema> children) { return {module, name, list, children, key}; }
constexpr Schema state(std::string_view module, std::string_view name) {
  Schema schema{module, name, anything};
  schema.is_state = true;
  return schema;
}
constexpr Schema leaves(std::string_view module, std::string_view name, Type type) {
  Schema schema{module, name, type};
  schema.is_leaf_list = true;
  return schema;
}

template <const std::string_view& m>
constexpr Schema rational[] = {leaf(m, "numerator", uint32), leaf(m, "denominator", uint32, false, 1)};
template <const std::string_view& m>
constexpr Schema rational_of_2018[] = {leaf(m, "numerator", uint32), leaf(m, "denominator", uint32)};
template <const std::string_view& m>
constexpr Schema ptp_time[] = {leaf(m, "seconds", uint64), leaf(m, "nanoseconds", uint32)};

// Gates of ports, published.
constexpr Schema gate_entry[] = {leaf(sched_bridge_m, "index", uint32, true), identity_of(sched_bridge_m, "operation-name", gate_operations, true),
                                 leaf(sched_bridge_m, "time-interval-value", uint32), leaf(sched_bridge_m, "gate-states-value", uint8, true, 0, 255)};
constexpr Schema gate_list[] = {entries(sched_bridge_m, "gate-control-entry", "index", gate_entry)};
constexpr Schema queue_sdu[] = {leaf(sched_bridge_m, "traffic-class", uint8, true, 0, 7), leaf(sched_bridge_m, "queue-max-sdu", uint32), state(sched_bridge_m, "transmission-overrun")};
constexpr Schema min_gating[] = {leaf(iec_sched_m, "speed", uint32, true), node(iec_sched_m, "min-cycle-time", rational<iec_sched_m>), leaf(iec_sched_m, "min-interval-time", uint32)};
constexpr Schema gate_table[] = {
    entries(sched_bridge_m, "queue-max-sdu-table", "traffic-class", queue_sdu),
    leaf(sched_bridge_m, "gate-enabled", boolean),
    leaf(sched_bridge_m, "admin-gate-states", uint8, false, 0, 255),
    node(sched_bridge_m, "admin-control-list", gate_list),
    node(sched_bridge_m, "admin-cycle-time", rational<sched_bridge_m>),
    leaf(sched_bridge_m, "admin-cycle-time-extension", uint32),
    node(sched_bridge_m, "admin-base-time", ptp_time<sched_bridge_m>),
    leaf(sched_bridge_m, "config-change", boolean),
    leaf(sched_bridge_m, "supported-list-max", uint32),
    node(sched_bridge_m, "supported-cycle-max", rational<sched_bridge_m>),
    leaf(sched_bridge_m, "supported-interval-max", uint32),
    leaf(sched_bridge_m, "tick-granularity", uint32),
    entries(iec_sched_m, "min-gating-times", "speed", min_gating),
    state(sched_bridge_m, "oper-gate-states"), state(sched_bridge_m, "oper-control-list"), state(sched_bridge_m, "oper-cycle-time"), state(sched_bridge_m, "oper-cycle-time-extension"),
    state(sched_bridge_m, "oper-base-time"), state(sched_bridge_m, "config-change-time"), state(sched_bridge_m, "current-time"), state(sched_bridge_m, "config-pending"),
    state(sched_bridge_m, "config-change-error"),
};

// Queues of ports.
constexpr Schema class_table[] = {leaf(dot1q_m, "number-of-traffic-classes", uint8, false, 1, 8), leaf(dot1q_m, "priority0", uint8, false, 0, 7), leaf(dot1q_m, "priority1", uint8, false, 0, 7),
                                  leaf(dot1q_m, "priority2", uint8, false, 0, 7), leaf(dot1q_m, "priority3", uint8, false, 0, 7), leaf(dot1q_m, "priority4", uint8, false, 0, 7),
                                  leaf(dot1q_m, "priority5", uint8, false, 0, 7), leaf(dot1q_m, "priority6", uint8, false, 0, 7), leaf(dot1q_m, "priority7", uint8, false, 0, 7)};
constexpr Schema class_tables[] = {node(dot1q_m, "traffic-class-table", class_table)};
constexpr Schema algorithm_map[] = {leaf(dot1q_m, "traffic-class", uint8, true, 0, 7), identity_of(dot1q_m, "transmission-selection-algorithm", algorithms)};
constexpr Schema algorithm_table[] = {entries(dot1q_m, "transmission-selection-algorithm-map", "traffic-class", algorithm_map)};
constexpr Schema slope[] = {leaf(cbsa_bridge_m, "traffic-class", uint8, true, 0, 7), leaf(cbsa_bridge_m, "admin-idle-slope", uint64), state(cbsa_bridge_m, "oper-idle-slope")};
constexpr Schema slopes[] = {entries(cbsa_bridge_m, "cbsa-parameter-table", "traffic-class", slope)};
constexpr Schema preemption_status(std::string_view name) { return one_of(preempt_bridge_m, name, "express|preemptable"); }
constexpr Schema statuses[] = {preemption_status("priority0"), preemption_status("priority1"), preemption_status("priority2"), preemption_status("priority3"),
                               preemption_status("priority4"), preemption_status("priority5"), preemption_status("priority6"), preemption_status("priority7")};
constexpr Schema preemption[] = {node(preempt_bridge_m, "frame-preemption-status-table", statuses), leaf(preempt_bridge_m, "hold-advance", uint32), leaf(preempt_bridge_m, "release-advance", uint32),
                                 state(preempt_bridge_m, "preemption-active"), state(preempt_bridge_m, "hold-request")};
constexpr Schema bridge_port[] = {
    node(dot1q_m, "traffic-class", class_tables),
    node(dot1q_m, "transmission-selection-algorithm-table", algorithm_table),
    node(cbsa_bridge_m, "cbsa", slopes),
    node(preempt_bridge_m, "frame-preemption-parameters", preemption),
    node(sched_bridge_m, "gate-parameter-table", gate_table),
    state(dot1q_m, "bridge-name"), state(dot1q_m, "component-name"), state(dot1q_m, "port-type"), state(dot1q_m, "pvid"), state(dot1q_m, "default-priority"), state(dot1q_m, "capabilities"),
    state(dot1q_m, "type-capabilties"), state(dot1q_m, "external"), state(dot1q_m, "oper-point-to-point"), state(dot1q_m, "statistics"), state(dot1q_m, "priority-regeneration"),
    state(dot1q_m, "port-number"), state(dot1q_m, "address"), state(dot1q_m, "pcp-selection"), state(dot1q_m, "pcp-decoding-table"), state(dot1q_m, "pcp-encoding-table"), state(dot1q_m, "use-dei"),
    state(dot1q_m, "acceptable-frame"), state(dot1q_m, "enable-ingress-filtering"), state(dot1q_m, "drop-encoding"), state(dot1q_m, "service-access-priority-selection"),
    state(dot1q_m, "media-dependent-overhead"), state(ats_bridge_m, "discarded-frames-count"),
};
constexpr Schema merge_control[] = {one_of(mac_merge_m, "merge-enable-tx", "enabled|disabled"), one_of(mac_merge_m, "verify-disable-tx", "enabled|disabled"), leaf(mac_merge_m, "verify-time", uint16, false, 1, 128),
                                    leaf(mac_merge_m, "frag-size", uint8, false, 0, 3)};
constexpr Schema merge[] = {node(mac_merge_m, "admin-control", merge_control), state(mac_merge_m, "admin-status"), state(mac_merge_m, "statistics")};
constexpr Schema ethernet[] = {node(mac_merge_m, "mac-merge", merge), state(eth_m, "auto-negotiation"), state(eth_m, "speed"), state(eth_m, "duplex"), state(eth_m, "flow-control"), state(eth_m, "statistics"), state(eth_m, "capabilities"),
                               state(eth_m, "max-frame-length"), state(eth_m, "mac-control-extension-control"), state(eth_m, "frame-limit-slow-protocol")};

// Gates of ports, 2018.
constexpr Schema parameters_of_2018[] = {leaf(sched_m, "gate-states-value", uint8, false, 0, 255), leaf(sched_m, "time-interval-value", uint32)};
constexpr Schema entry_of_2018[] = {leaf(sched_m, "index", uint32, true), identity_of(sched_m, "operation-name", gate_operations), node(sched_m, "sgs-params", parameters_of_2018),
                                    node(sched_m, "shm-params", parameters_of_2018), node(sched_m, "srm-params", parameters_of_2018)};
constexpr Schema base_of_2018[] = {leaf(sched_m, "seconds", uint64), leaf(sched_m, "fractional-seconds", uint64)};
constexpr Schema gates_of_2018[] = {
    leaf(sched_m, "gate-enabled", boolean), leaf(sched_m, "admin-gate-states", uint8, false, 0, 255), leaf(sched_m, "admin-control-list-length", uint32),
    entries(sched_m, "admin-control-list", "index", entry_of_2018), node(sched_m, "admin-cycle-time", rational_of_2018<sched_m>), leaf(sched_m, "admin-cycle-time-extension", uint32),
    node(sched_m, "admin-base-time", base_of_2018), leaf(sched_m, "config-change", boolean),
    leaf(sched_m, "supported-list-max", uint32), leaf(sched_m, "tick-granularity", uint32),
    state(sched_m, "oper-gate-states"), state(sched_m, "oper-control-list-length"), state(sched_m, "oper-control-list"), state(sched_m, "oper-cycle-time"), state(sched_m, "oper-cycle-time-extension"),
    state(sched_m, "oper-base-time"), state(sched_m, "config-change-time"), state(sched_m, "current-time"), state(sched_m, "config-pending"), state(sched_m, "config-change-error"),
};
constexpr Schema sdu_of_2018[] = {leaf(sched_m, "traffic-class", uint8, true, 0, 7), leaf(sched_m, "queue-max-sdu", uint32), state(sched_m, "transmission-overrun")};
constexpr Schema status_of_2018[] = {leaf(preempt_m, "traffic-class", uint8, true, 0, 7), one_of(preempt_m, "frame-preemption-status", "express|preemptable")};
constexpr Schema preemption_of_2018[] = {entries(preempt_m, "frame-preemption-status-table", "traffic-class", status_of_2018), leaf(preempt_m, "hold-advance", uint32), leaf(preempt_m, "release-advance", uint32),
                                         state(preempt_m, "preemption-active"), state(preempt_m, "hold-request")};

constexpr Schema available_2018[] = {leaf(dot1q_m, "num-traffic-class", uint8, true, 1, 8), leaf(dot1q_m, "traffic-class", uint8, false, 0, 7)};
constexpr Schema class_map_2018[] = {leaf(dot1q_m, "priority", uint8, true, 0, 7), entries(dot1q_m, "available-traffic-class", "num-traffic-class", available_2018)};
constexpr Schema class_maps_2018[] = {entries(dot1q_m, "traffic-class-map", "priority", class_map_2018)};
constexpr Schema bridge_port_2018[] = {node(dot1q_m, "traffic-class", class_maps_2018), state(dot1q_m, "bridge-name"), state(dot1q_m, "component-name"), state(dot1q_m, "port-type"), state(dot1q_m, "pvid"),
                                       state(dot1q_m, "default-priority"), state(dot1q_m, "priority-regeneration"), state(dot1q_m, "acceptable-frame"), state(dot1q_m, "enable-ingress-filtering"), state(dot1q_m, "statistics")};
constexpr Schema interface_published[] = {
    leaf(if_m, "name", text, true), identity_of(if_m, "type", {}), state(if_m, "enabled"), state(if_m, "description"), state(if_m, "admin-status"), state(if_m, "oper-status"), state(if_m, "if-index"),
    leaf(if_m, "speed", uint64), state(if_m, "statistics"), state(if_m, "phys-address"), state(if_m, "last-change"), state(if_m, "link-up-down-trap-enable"),
    node(dot1q_m, "bridge-port", bridge_port), node(eth_m, "ethernet", ethernet),
};
constexpr Schema interface_of_2018[] = {
    leaf(if_m, "name", text, true), identity_of(if_m, "type", {}), state(if_m, "enabled"), state(if_m, "description"), state(if_m, "admin-status"), state(if_m, "oper-status"), state(if_m, "if-index"),
    leaf(if_m, "speed", uint64), state(if_m, "statistics"), state(if_m, "phys-address"), state(if_m, "last-change"), state(if_m, "link-up-down-trap-enable"),
    entries(sched_m, "max-sdu-table", "traffic-class", sdu_of_2018), node(sched_m, "gate-parameters", gates_of_2018), node(preempt_m, "frame-preemption-parameters", preemption_of_2018),
    node(dot1q_m, "bridge-port", bridge_port_2018),
};
constexpr Schema interfaces_published[] = {entries(if_m, "interface", "name", interface_published)};
constexpr Schema interfaces_of_2018[] = {entries(if_m, "interface", "name", interface_of_2018)};

// Policing, published.
template <const std::string_view& m>
constexpr Schema meter[] = {leaf(m, "flow-meter-instance-id", uint32, true), leaf(m, "committed-information-rate", uint64, true), leaf(m, "committed-burst-size", uint32, true),
                            leaf(m, "excess-information-rate", uint64, true), leaf(m, "excess-burst-size", uint32, true), one_of(m, "coupling-flag", "zero|one", true), one_of(m, "color-mode", "color-blind|color-aware", true),
                            leaf(m, "drop-on-yellow", boolean, true), leaf(m, "mark-all-frames-red-enable", boolean), state(m, "mark-all-frames-red")};
template <const std::string_view& m>
constexpr Schema meters[] = {entries(m, "flow-meter-instance-table", "flow-meter-instance-id", meter<m>), leaf(m, "max-flow-meter-instances", uint32)};
constexpr Schema stream_gate_entry[] = {leaf(psfp_bridge_m, "index", uint32, true), identity_of(psfp_bridge_m, "operation-name", "ieee802-dot1q-psfp:set-gate-and-ipv", true),
                                        leaf(psfp_bridge_m, "time-interval-value", uint32), one_of(psfp_bridge_m, "gate-state-value", "closed|open", true), one_of(psfp_bridge_m, "ipv-spec", ipv, true),
                                        leaf(psfp_bridge_m, "interval-octet-max", uint32)};
constexpr Schema stream_gate_list[] = {entries(psfp_bridge_m, "gate-control-entry", "index", stream_gate_entry)};
constexpr Schema stream_gate[] = {
    leaf(psfp_bridge_m, "stream-gate-instance-id", uint32, true), leaf(psfp_bridge_m, "gate-enable", boolean), one_of(psfp_bridge_m, "admin-gate-states", "closed|open"), one_of(psfp_bridge_m, "admin-ipv", ipv),
    node(psfp_bridge_m, "admin-control-list", stream_gate_list), node(psfp_bridge_m, "admin-cycle-time", rational<psfp_bridge_m>), leaf(psfp_bridge_m, "admin-cycle-time-extension", uint32),
    node(psfp_bridge_m, "admin-base-time", ptp_time<psfp_bridge_m>), leaf(psfp_bridge_m, "config-change", boolean), leaf(psfp_bridge_m, "gate-closed-due-to-invalid-rx-enable", boolean),
    leaf(psfp_bridge_m, "gate-closed-due-octets-exceeded-enable", boolean), state(psfp_bridge_m, "gate-closed-due-to-invalid-rx"), state(psfp_bridge_m, "gate-closed-due-octets-exceeded"),
    state(psfp_bridge_m, "oper-gate-state"), state(psfp_bridge_m, "oper-ipv"), state(psfp_bridge_m, "oper-control-list"), state(psfp_bridge_m, "oper-cycle-time"), state(psfp_bridge_m, "oper-cycle-time-extension"),
    state(psfp_bridge_m, "oper-base-time"), state(psfp_bridge_m, "config-change-time"), state(psfp_bridge_m, "tick-granularity"), state(psfp_bridge_m, "current-time"), state(psfp_bridge_m, "config-pending"),
    state(psfp_bridge_m, "config-change-error"),
};
constexpr Schema stream_gates[] = {entries(psfp_bridge_m, "stream-gate-instance-table", "stream-gate-instance-id", stream_gate), leaf(psfp_bridge_m, "supported-list-max", uint32),
                                   node(psfp_bridge_m, "supported-cycle-max", rational<psfp_bridge_m>), leaf(psfp_bridge_m, "supported-interval-max", uint32), leaf(psfp_bridge_m, "max-stream-gate-instances", uint32)};
constexpr Schema stream_filter[] = {
    leaf(psfp_bridge_m, "stream-filter-instance-id", uint32, true), leaf(psfp_bridge_m, "wildcard", empty), leaf(psfp_bridge_m, "stream-handle", uint32), one_of(psfp_bridge_m, "priority-spec", priorities, true),
    leaf(psfp_bridge_m, "max-sdu-size", uint32, true), leaf(psfp_bridge_m, "stream-blocked-due-to-oversize-frame-enabled", boolean), state(psfp_bridge_m, "stream-blocked-due-to-oversize-frame"),
    leaf(psfp_bridge_m, "stream-gate-ref", uint32, true), leaf(psfp_bridge_m, "flow-meter-ref", uint32), leaf(psfp_bridge_m, "flow-meter-enable", boolean),
    state(psfp_bridge_m, "matching-frames-count"), state(psfp_bridge_m, "passing-frames-count"), state(psfp_bridge_m, "not-passing-frames-count"), state(psfp_bridge_m, "red-frames-count"),
    state(psfp_bridge_m, "passing-sdu-count"), state(psfp_bridge_m, "not-passing-sdu-count"),
};
constexpr Schema stream_filters[] = {entries(psfp_bridge_m, "stream-filter-instance-table", "stream-filter-instance-id", stream_filter), leaf(psfp_bridge_m, "max-stream-filter-instances", uint32)};

// ATS: schedulers and their groups stand in the entry of a filter.
constexpr Schema scheduler[] = {leaf(ats_bridge_m, "scheduler-instance-id", uint32, true), leaf(ats_bridge_m, "committed-information-rate", uint64, true), leaf(ats_bridge_m, "committed-burst-size", uint32, true),
                                leaf(ats_bridge_m, "scheduler-group-ref", uint32, true)};
constexpr Schema schedulers[] = {entries(ats_bridge_m, "scheduler-instance-table", "scheduler-instance-id", scheduler), state(ats_bridge_m, "max-scheduler-instances")};
constexpr Schema scheduler_group[] = {leaf(ats_bridge_m, "scheduler-group-instance-id", uint32, true), leaf(ats_bridge_m, "max-residence-time", uint32, true)};
constexpr Schema scheduler_groups[] = {entries(ats_bridge_m, "scheduler-group-instance-table", "scheduler-group-instance-id", scheduler_group), state(ats_bridge_m, "max-scheduler-group-instances"),
                                       state(ats_bridge_m, "scheduler-timing-characteristics")};
constexpr Schema scheduler_use[] = {leaf(ats_bridge_m, "scheduler-ref", uint32), leaf(ats_bridge_m, "scheduler-enable", boolean)};
constexpr Schema ats_filter[] = {
    leaf(ats_bridge_m, "stream-filter-instance-id", uint32, true), leaf(ats_bridge_m, "wildcard", empty), leaf(ats_bridge_m, "stream-handle", uint32), one_of(ats_bridge_m, "priority-spec", priorities, true),
    leaf(ats_bridge_m, "max-sdu-size", uint32, true), leaf(ats_bridge_m, "stream-blocked-due-to-oversize-frame-enabled", boolean), state(ats_bridge_m, "stream-blocked-due-to-oversize-frame"),
    leaf(ats_bridge_m, "stream-gate-ref", uint32, true), node(ats_bridge_m, "schedulers", schedulers), node(ats_bridge_m, "scheduler-groups", scheduler_groups), node(ats_bridge_m, "scheduler", scheduler_use),
};
constexpr Schema ats_filters[] = {entries(ats_bridge_m, "stream-filter-instance-table", "stream-filter-instance-id", ats_filter), state(ats_bridge_m, "max-stream-filter-instances")};
constexpr Schema ats_gate[] = {leaf(ats_bridge_m, "stream-gate-instance-id", uint32, true), leaf(ats_bridge_m, "gate-enable", boolean), one_of(ats_bridge_m, "admin-gate-states", "closed|open"), one_of(ats_bridge_m, "admin-ipv", ipv)};
constexpr Schema ats_gates[] = {entries(ats_bridge_m, "stream-gate-instance-table", "stream-gate-instance-id", ats_gate), state(ats_bridge_m, "max-stream-gate-instances")};

constexpr Schema component_published[] = {
    leaf(dot1q_m, "name", text, true), identity_of(dot1q_m, "type", {}), state(dot1q_m, "id"), state(dot1q_m, "address"), state(dot1q_m, "traffic-class-enabled"), state(dot1q_m, "ports"), state(dot1q_m, "bridge-port"),
    state(dot1q_m, "capabilities"), state(dot1q_m, "filtering-database"), state(dot1q_m, "permanent-database"), state(dot1q_m, "bridge-vlan"), state(dot1q_m, "bridge-mst"),
    node(psfp_bridge_m, "flow-meters", meters<psfp_bridge_m>), node(psfp_bridge_m, "stream-gates", stream_gates), node(psfp_bridge_m, "stream-filters", stream_filters),
    node(ats_bridge_m, "stream-gates", ats_gates), node(ats_bridge_m, "stream-filters", ats_filters),
};

// Policing, 2018; stream identification as NXP's module had it.
constexpr Schema parameters_of_gate_2018[] = {one_of(psfp_m, "gate-state-value", "closed|open", true), one_of(psfp_m, "ipv-value", priorities, true), leaf(psfp_m, "time-interval-value", uint32, true),
                                              leaf(psfp_m, "interval-octet-max", uint32)};
constexpr Schema stream_gate_entry_2018[] = {leaf(psfp_m, "index", uint32, true), identity_of(psfp_m, "operation-name", "ieee802-dot1q-psfp:set-gate-and-ipv", true), node(psfp_m, "parameters", parameters_of_gate_2018)};
constexpr Schema stream_gate_2018[] = {
    leaf(sfsg_m, "stream-gate-instance-id", uint32, true), leaf(sfsg_m, "gate-enable", boolean), one_of(sfsg_m, "admin-gate-states", "closed|open"), one_of(sfsg_m, "admin-ipv", priorities),
    leaf(psfp_m, "admin-control-list-length", uint32), entries(psfp_m, "admin-control-list", "index", stream_gate_entry_2018), node(psfp_m, "admin-cycle-time", rational_of_2018<psfp_m>),
    leaf(psfp_m, "admin-cycle-time-extension", uint32), node(psfp_m, "admin-base-time", ptp_time<psfp_m>), leaf(psfp_m, "config-change", boolean), leaf(psfp_m, "gate-closed-due-to-invalid-rx-enable", boolean),
    leaf(psfp_m, "gate-closed-due-octets-exceeded-enable", boolean), state(psfp_m, "oper-ipv"), state(psfp_m, "gate-closed-due-to-invalid-rx"), state(psfp_m, "gate-closed-due-octets-exceeded"),
};
constexpr Schema stream_gates_2018[] = {entries(sfsg_m, "stream-gate-instance-table", "stream-gate-instance-id", stream_gate_2018), state(sfsg_m, "max-stream-gate-instances"), leaf(psfp_m, "supported-list-max", uint32)};
constexpr Schema filter_part_2018[] = {leaf(sfsg_m, "index", uint8, true, 0, 255), leaf(sfsg_m, "maximum-sdu-size", uint32), leaf(sfsg_m, "stream-blocked-due-to-oversize-frame-enabled", boolean),
                                       state(sfsg_m, "stream-blocked-due-to-oversize-frame"), leaf(psfp_m, "flow-meter-ref", uint32)};
constexpr Schema stream_filter_2018[] = {leaf(sfsg_m, "stream-filter-instance-id", uint32, true), leaf(sfsg_m, "wildcard", empty), leaf(sfsg_m, "stream-handle", uint32), one_of(sfsg_m, "priority-spec", priorities, true),
                                         leaf(sfsg_m, "stream-gate-ref", uint32, true), entries(sfsg_m, "filter-specification-list", "index", filter_part_2018)};
constexpr Schema stream_filters_2018[] = {entries(sfsg_m, "stream-filter-instance-table", "stream-filter-instance-id", stream_filter_2018), state(sfsg_m, "max-stream-filter-instances")};
constexpr Schema null_2017[] = {leaf(stream_id_2017_m, "dest-address", mac), one_of(stream_id_2017_m, "vlan-tagged", "tagged|priority|all"), leaf(stream_id_2017_m, "vlan-id", uint16, false, 0, 4095)};
constexpr Schema source_2017[] = {leaf(stream_id_2017_m, "source-address", mac), one_of(stream_id_2017_m, "vlan-tagged", "tagged|priority|all"), leaf(stream_id_2017_m, "vlan-id", uint16, false, 0, 4095)};
constexpr Schema parameters_2017[] = {node(stream_id_2017_m, "null-stream-identification-params", null_2017), node(stream_id_2017_m, "source-mac-and-vlan-identification-params", source_2017)};
constexpr Schema identity_2017[] = {
    leaf(stream_id_2017_m, "index", uint32, true), leaf(stream_id_2017_m, "stream-handle", uint32, true), leaf(stream_id_2017_m, "stream-id-enabled", boolean, true),
    one_of(stream_id_2017_m, "identification-type", "null|source-mac-and-vlan|dest-mac-and-vlan|ip-octuple"), node(stream_id_2017_m, "parameters", parameters_2017),
    state(stream_id_2017_m, "in-facing-output-port-list"), state(stream_id_2017_m, "out-facing-output-port-list"), state(stream_id_2017_m, "in-facing-input-port-list"), state(stream_id_2017_m, "out-facing-input-port-list"),
    state(stream_id_2017_m, "autoconfigured"), state(stream_id_2017_m, "lan-path-id"),
};
constexpr Schema streams_2017[] = {entries(stream_id_2017_m, "stream-identity-table", "index", identity_2017)};
constexpr Schema component_of_2018[] = {
    leaf(dot1q_m, "name", text, true), identity_of(dot1q_m, "type", {}), state(dot1q_m, "id"), state(dot1q_m, "address"), state(dot1q_m, "traffic-class-enabled"), state(dot1q_m, "ports"), state(dot1q_m, "bridge-port"),
    state(dot1q_m, "capabilities"), state(dot1q_m, "filtering-database"), state(dot1q_m, "permanent-database"), state(dot1q_m, "bridge-vlan"), state(dot1q_m, "bridge-mst"),
    node(psfp_m, "flow-meters", meters<psfp_m>), node(sfsg_m, "stream-gates", stream_gates_2018), node(sfsg_m, "stream-filters", stream_filters_2018), node(stream_id_2017_m, "streams", streams_2017),
};
constexpr Schema bridge_published[] = {leaf(dot1q_m, "name", text, true), leaf(dot1q_m, "address", mac, true), identity_of(dot1q_m, "bridge-type", {}), state(dot1q_m, "ports"), state(dot1q_m, "up-time"), state(dot1q_m, "components"),
                                       entries(dot1q_m, "component", "name", component_published)};
constexpr Schema bridge_of_2018[] = {leaf(dot1q_m, "name", text, true), leaf(dot1q_m, "address", mac, true), identity_of(dot1q_m, "bridge-type", {}), state(dot1q_m, "ports"), state(dot1q_m, "up-time"), state(dot1q_m, "components"),
                                     entries(dot1q_m, "component", "name", component_of_2018)};
constexpr Schema bridges_published[] = {entries(dot1q_m, "bridge", "name", bridge_published)};
constexpr Schema bridges_of_2018[] = {entries(dot1q_m, "bridge", "name", bridge_of_2018)};

// Stream identification.
constexpr Schema facing[] = {leaves(sid_m, "input-port", text), leaves(sid_m, "output-port", text)};
constexpr Schema null_identification[] = {leaf(sid_m, "destination-mac", mac), one_of(sid_m, "tagged", "tagged|priority|all"), leaf(sid_m, "vlan", uint16, false, 0, 4095), state(sid_m, "identification-type")};
constexpr Schema source_identification[] = {leaf(sid_m, "source-mac", mac), one_of(sid_m, "tagged", "tagged|priority|all"), leaf(sid_m, "vlan", uint16, false, 0, 4095), state(sid_m, "identification-type")};
constexpr Schema stream_identity[] = {leaf(sid_m, "index", uint32, true), leaf(sid_m, "handle", uint32, true), node(sid_m, "in-facing", facing), node(sid_m, "out-facing", facing),
                                      node(sid_m, "null-stream-identification", null_identification), node(sid_m, "smac-vlan-stream-identification", source_identification), state(sid_m, "tsn-stream-id"),
                                      node(sid_m, "dmac-vlan-stream-identification", {}), node(sid_m, "ip-stream-identification", {})};

constexpr Schema published[] = {node(if_m, "interfaces", interfaces_published), node(dot1q_m, "bridges", bridges_published), entries(sid_m, "stream-identity", "index", stream_identity)};
constexpr Schema of_2018[] = {node(if_m, "interfaces", interfaces_of_2018), node(dot1q_m, "bridges", bridges_of_2018)};
constexpr Schema published_root = node({}, {}, published);
constexpr Schema root_of_2018 = node({}, {}, of_2018);

}  // namespace

const Schema* Schema::find(std::string_view which_module, std::string_view which_name) const {
  const auto found = std::ranges::find_if(children, [&](const Schema& each) { return each.name == which_name && each.module == which_module; });
  return found == children.end() ? nullptr : &*found;
}

std::string_view namespace_of(std::string_view module) {
  const auto found = std::ranges::find(modules, module, &Module::name);
  return found == std::end(modules) ? std::string_view() : found->name_space;
}
std::string_view module_of(std::string_view name_space) {
  const auto found = std::ranges::find(modules, name_space, &Module::name_space);
  return found == std::end(modules) ? std::string_view() : found->name;
}
bool is_known(std::string_view module) { return !namespace_of(module).empty(); }

const Schema& root_of(Dialect dialect) { return dialect == Dialect::published ? published_root : root_of_2018; }

}  // namespace takt::interchange::yang
