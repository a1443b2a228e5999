// SPDX-License-Identifier: Apache-2.0
#include "interchange/yang/schema.hpp"

#include <algorithm>
#include <array>

#include "interchange/yang/device_schema.hpp"
#include "interchange/yang/modules.hpp"
#include "interchange/yang/schema_words.hpp"

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
    {ptp_m, "urn:ieee:std:1588:yang:ieee1588-ptp-tt"},
    {gptp_m, "urn:ieee:std:802.1AS:yang:ieee802-dot1as-gptp"},
    {hs_m, "urn:ieee:std:802.1AS:yang:ieee802-dot1as-hs"},
    {eth_m, "urn:ieee:std:802.3:yang:ieee802-ethernet-interface"},
    {mac_merge_m, "urn:ieee:std:802.3:yang:ieee802-ethernet-mac-merge"},
    {iec_bridge_m, "urn:ieee:std:60802:yang:iecieee60802-bridge"},
    {iec_eth_m, "urn:ieee:std:60802:yang:iecieee60802-ethernet-interface"},
    {iec_sched_m, "urn:ieee:std:60802:yang:iecieee60802-sched-bridge"},
    {stream_id_2017_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1q-stream-id"},
    {cnc_m, "urn:ieee:std:802.1Q:yang:ieee802-dot1q-cnc-config"},
};

constexpr std::string_view gate_operations =
    "ieee802-dot1q-sched:set-gate-states|ieee802-dot1q-sched:set-and-hold-mac|ieee802-dot1q-sched:set-and-release-mac";
constexpr std::string_view algorithms =
    "ieee802-dot1q-types:strict-priority|ieee802-dot1q-types:credit-based-shaper|ieee802-dot1q-types:enhanced-"
    "transmission-selection|ieee802-dot1q-types:asynchronous-traffic-shaping";
constexpr std::string_view ipv = "zero|one|two|three|four|five|six|seven|null";
constexpr std::string_view priorities = "zero|one|two|three|four|five|six|seven|wildcard";

// Gates of ports, published.
constexpr Schema gate_entry[] = {leaf(sched_bridge_m, "index", uint32, true),
                                 identity_of(sched_bridge_m, "operation-name", gate_operations, true),
                                 leaf(sched_bridge_m, "time-interval-value", uint32),
                                 leaf(sched_bridge_m, "gate-states-value", uint8, true, 0, 255)};
constexpr Schema gate_list[] = {entries(sched_bridge_m, "gate-control-entry", "index", gate_entry)};
constexpr Schema queue_sdu[] = {leaf(sched_bridge_m, "traffic-class", uint8, true, 0, 7),
                                leaf(sched_bridge_m, "queue-max-sdu", uint32),
                                state(sched_bridge_m, "transmission-overrun")};
constexpr Schema min_gating[] = {leaf(iec_sched_m, "speed", uint32, true),
                                 node(iec_sched_m, "min-cycle-time", rational<iec_sched_m>),
                                 leaf(iec_sched_m, "min-interval-time", uint32)};
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
    state(sched_bridge_m, "oper-gate-states"),
    state(sched_bridge_m, "oper-control-list"),
    state(sched_bridge_m, "oper-cycle-time"),
    state(sched_bridge_m, "oper-cycle-time-extension"),
    state(sched_bridge_m, "oper-base-time"),
    state(sched_bridge_m, "config-change-time"),
    state(sched_bridge_m, "current-time"),
    state(sched_bridge_m, "config-pending"),
    state(sched_bridge_m, "config-change-error"),
};

// Queues of ports.
constexpr Schema class_table[] = {leaf(dot1q_m, "number-of-traffic-classes", uint8, false, 1, 8),
                                  leaf(dot1q_m, "priority0", uint8, false, 0, 7),
                                  leaf(dot1q_m, "priority1", uint8, false, 0, 7),
                                  leaf(dot1q_m, "priority2", uint8, false, 0, 7),
                                  leaf(dot1q_m, "priority3", uint8, false, 0, 7),
                                  leaf(dot1q_m, "priority4", uint8, false, 0, 7),
                                  leaf(dot1q_m, "priority5", uint8, false, 0, 7),
                                  leaf(dot1q_m, "priority6", uint8, false, 0, 7),
                                  leaf(dot1q_m, "priority7", uint8, false, 0, 7)};
constexpr Schema class_tables[] = {node(dot1q_m, "traffic-class-table", class_table)};
constexpr Schema algorithm_map[] = {leaf(dot1q_m, "traffic-class", uint8, true, 0, 7),
                                    identity_of(dot1q_m, "transmission-selection-algorithm", algorithms)};
constexpr Schema algorithm_table[] = {
    entries(dot1q_m, "transmission-selection-algorithm-map", "traffic-class", algorithm_map)};
constexpr Schema slope[] = {leaf(cbsa_bridge_m, "traffic-class", uint8, true, 0, 7),
                            leaf(cbsa_bridge_m, "admin-idle-slope", uint64), state(cbsa_bridge_m, "oper-idle-slope")};
constexpr Schema slopes[] = {entries(cbsa_bridge_m, "cbsa-parameter-table", "traffic-class", slope)};
constexpr Schema preemption_status(std::string_view name) {
  return one_of(preempt_bridge_m, name, "express|preemptable");
}
constexpr Schema statuses[] = {preemption_status("priority0"), preemption_status("priority1"),
                               preemption_status("priority2"), preemption_status("priority3"),
                               preemption_status("priority4"), preemption_status("priority5"),
                               preemption_status("priority6"), preemption_status("priority7")};
constexpr Schema preemption[] = {node(preempt_bridge_m, "frame-preemption-status-table", statuses),
                                 leaf(preempt_bridge_m, "hold-advance", uint32),
                                 leaf(preempt_bridge_m, "release-advance", uint32),
                                 state(preempt_bridge_m, "preemption-active"), state(preempt_bridge_m, "hold-request")};
constexpr Schema bridge_port[] = {
    node(dot1q_m, "traffic-class", class_tables),
    node(dot1q_m, "transmission-selection-algorithm-table", algorithm_table),
    node(cbsa_bridge_m, "cbsa", slopes),
    node(preempt_bridge_m, "frame-preemption-parameters", preemption),
    node(sched_bridge_m, "gate-parameter-table", gate_table),
    state(dot1q_m, "bridge-name"),
    state(dot1q_m, "component-name"),
    state(dot1q_m, "port-type"),
    unheard(dot1q_m, "pvid"),
    unheard(dot1q_m, "default-priority"),
    state(dot1q_m, "capabilities"),
    state(dot1q_m, "type-capabilties"),
    state(dot1q_m, "external"),
    state(dot1q_m, "oper-point-to-point"),
    state(dot1q_m, "statistics"),
    unheard(dot1q_m, "priority-regeneration"),
    state(dot1q_m, "port-number"),
    state(dot1q_m, "address"),
    unheard(dot1q_m, "pcp-selection"),
    unheard(dot1q_m, "pcp-decoding-table"),
    unheard(dot1q_m, "pcp-encoding-table"),
    unheard(dot1q_m, "use-dei"),
    unheard(dot1q_m, "acceptable-frame"),
    unheard(dot1q_m, "enable-ingress-filtering"),
    unheard(dot1q_m, "drop-encoding"),
    unheard(dot1q_m, "service-access-priority-selection"),
    state(dot1q_m, "media-dependent-overhead"),
    state(ats_bridge_m, "discarded-frames-count"),
    state(iec_bridge_m, "max-burst-params"),
    state(iec_bridge_m, "committed-data-rates"),
    entries(iec_bridge_m, "transmission-selection-algorithm", "traffic-class", supported_algorithms),
    entries(iec_bridge_m, "supported-resource-pools", "resource-pool-name", resource_pool),
    entries(iec_bridge_m, "phy-latencies", "mau-type", phy_latency),
};
constexpr Schema merge_control[] = {one_of(mac_merge_m, "merge-enable-tx", "enabled|disabled"),
                                    one_of(mac_merge_m, "verify-disable-tx", "enabled|disabled"),
                                    leaf(mac_merge_m, "verify-time", uint16, false, 1, 128),
                                    leaf(mac_merge_m, "frag-size", uint8, false, 0, 3)};
constexpr Schema merge[] = {node(mac_merge_m, "admin-control", merge_control), state(mac_merge_m, "admin-status"),
                            state(mac_merge_m, "statistics")};
constexpr Schema ethernet[] = {node(mac_merge_m, "mac-merge", merge),
                               state(eth_m, "auto-negotiation"),
                               state(eth_m, "speed"),
                               state(eth_m, "duplex"),
                               state(eth_m, "flow-control"),
                               state(eth_m, "statistics"),
                               state(eth_m, "capabilities"),
                               state(eth_m, "max-frame-length"),
                               state(eth_m, "mac-control-extension-control"),
                               state(eth_m, "frame-limit-slow-protocol"),
                               entries(iec_eth_m, "supported-mau-types", "mau-type", supported_mau)};

// Gates of ports, 2018.
constexpr Schema parameters_of_2018[] = {leaf(sched_m, "gate-states-value", uint8, false, 0, 255),
                                         leaf(sched_m, "time-interval-value", uint32)};
constexpr Schema entry_of_2018[] = {
    leaf(sched_m, "index", uint32, true), identity_of(sched_m, "operation-name", gate_operations),
    node(sched_m, "sgs-params", parameters_of_2018), node(sched_m, "shm-params", parameters_of_2018),
    node(sched_m, "srm-params", parameters_of_2018)};
constexpr Schema base_of_2018[] = {leaf(sched_m, "seconds", uint64), leaf(sched_m, "fractional-seconds", uint64)};
constexpr Schema gates_of_2018[] = {
    leaf(sched_m, "gate-enabled", boolean),
    leaf(sched_m, "admin-gate-states", uint8, false, 0, 255),
    leaf(sched_m, "admin-control-list-length", uint32),
    entries(sched_m, "admin-control-list", "index", entry_of_2018),
    node(sched_m, "admin-cycle-time", rational_of_2018<sched_m>),
    leaf(sched_m, "admin-cycle-time-extension", uint32),
    node(sched_m, "admin-base-time", base_of_2018),
    leaf(sched_m, "config-change", boolean),
    leaf(sched_m, "supported-list-max", uint32),
    leaf(sched_m, "tick-granularity", uint32),
    state(sched_m, "oper-gate-states"),
    state(sched_m, "oper-control-list-length"),
    state(sched_m, "oper-control-list"),
    state(sched_m, "oper-cycle-time"),
    state(sched_m, "oper-cycle-time-extension"),
    state(sched_m, "oper-base-time"),
    state(sched_m, "config-change-time"),
    state(sched_m, "current-time"),
    state(sched_m, "config-pending"),
    state(sched_m, "config-change-error"),
};
constexpr Schema sdu_of_2018[] = {leaf(sched_m, "traffic-class", uint8, true, 0, 7),
                                  leaf(sched_m, "queue-max-sdu", uint32), state(sched_m, "transmission-overrun")};
constexpr Schema status_of_2018[] = {leaf(preempt_m, "traffic-class", uint8, true, 0, 7),
                                     one_of(preempt_m, "frame-preemption-status", "express|preemptable")};
constexpr Schema preemption_of_2018[] = {
    entries(preempt_m, "frame-preemption-status-table", "traffic-class", status_of_2018),
    leaf(preempt_m, "hold-advance", uint32), leaf(preempt_m, "release-advance", uint32),
    state(preempt_m, "preemption-active"), state(preempt_m, "hold-request")};

constexpr Schema available_2018[] = {leaf(dot1q_m, "num-traffic-class", uint8, true, 1, 8),
                                     leaf(dot1q_m, "traffic-class", uint8, false, 0, 7)};
constexpr Schema class_map_2018[] = {leaf(dot1q_m, "priority", uint8, true, 0, 7),
                                     entries(dot1q_m, "available-traffic-class", "num-traffic-class", available_2018)};
constexpr Schema class_maps_2018[] = {entries(dot1q_m, "traffic-class-map", "priority", class_map_2018)};
constexpr Schema bridge_port_2018[] = {node(dot1q_m, "traffic-class", class_maps_2018),
                                       state(dot1q_m, "bridge-name"),
                                       state(dot1q_m, "component-name"),
                                       state(dot1q_m, "port-type"),
                                       unheard(dot1q_m, "pvid"),
                                       unheard(dot1q_m, "default-priority"),
                                       unheard(dot1q_m, "priority-regeneration"),
                                       unheard(dot1q_m, "acceptable-frame"),
                                       unheard(dot1q_m, "enable-ingress-filtering"),
                                       state(dot1q_m, "statistics")};
constexpr Schema interface_published[] = {
    leaf(if_m, "name", text, true),
    identity_of(if_m, "type", {}),
    state(if_m, "enabled"),
    state(if_m, "description"),
    state(if_m, "admin-status"),
    state(if_m, "oper-status"),
    state(if_m, "if-index"),
    leaf(if_m, "speed", uint64),
    state(if_m, "statistics"),
    state(if_m, "phys-address"),
    state(if_m, "last-change"),
    state(if_m, "link-up-down-trap-enable"),
    node(dot1q_m, "bridge-port", bridge_port),
    node(eth_m, "ethernet", ethernet),
};
constexpr Schema interface_of_2018[] = {
    leaf(if_m, "name", text, true),
    identity_of(if_m, "type", {}),
    state(if_m, "enabled"),
    state(if_m, "description"),
    state(if_m, "admin-status"),
    state(if_m, "oper-status"),
    state(if_m, "if-index"),
    leaf(if_m, "speed", uint64),
    state(if_m, "statistics"),
    state(if_m, "phys-address"),
    state(if_m, "last-change"),
    state(if_m, "link-up-down-trap-enable"),
    entries(sched_m, "max-sdu-table", "traffic-class", sdu_of_2018),
    node(sched_m, "gate-parameters", gates_of_2018),
    node(preempt_m, "frame-preemption-parameters", preemption_of_2018),
    node(dot1q_m, "bridge-port", bridge_port_2018),
};
constexpr Schema interfaces_published[] = {entries(if_m, "interface", "name", interface_published)};
constexpr Schema interfaces_of_2018[] = {entries(if_m, "interface", "name", interface_of_2018)};

// Policing, published.
template <const std::string_view& m>
constexpr Schema meter[] = {leaf(m, "flow-meter-instance-id", uint32, true),
                            leaf(m, "committed-information-rate", uint64, true),
                            leaf(m, "committed-burst-size", uint32, true),
                            leaf(m, "excess-information-rate", uint64, true),
                            leaf(m, "excess-burst-size", uint32, true),
                            one_of(m, "coupling-flag", "zero|one", true),
                            one_of(m, "color-mode", "color-blind|color-aware", true),
                            leaf(m, "drop-on-yellow", boolean, true),
                            leaf(m, "mark-all-frames-red-enable", boolean),
                            state(m, "mark-all-frames-red")};
template <const std::string_view& m>
constexpr Schema meters[] = {entries(m, "flow-meter-instance-table", "flow-meter-instance-id", meter<m>),
                             leaf(m, "max-flow-meter-instances", uint32)};
constexpr Schema stream_gate_entry[] = {
    leaf(psfp_bridge_m, "index", uint32, true),
    identity_of(psfp_bridge_m, "operation-name", "ieee802-dot1q-psfp:set-gate-and-ipv", true),
    leaf(psfp_bridge_m, "time-interval-value", uint32),
    one_of(psfp_bridge_m, "gate-state-value", "closed|open", true),
    one_of(psfp_bridge_m, "ipv-spec", ipv, true),
    leaf(psfp_bridge_m, "interval-octet-max", uint32)};
constexpr Schema stream_gate_list[] = {entries(psfp_bridge_m, "gate-control-entry", "index", stream_gate_entry)};
constexpr Schema stream_gate[] = {
    leaf(psfp_bridge_m, "stream-gate-instance-id", uint32, true),
    leaf(psfp_bridge_m, "gate-enable", boolean),
    one_of(psfp_bridge_m, "admin-gate-states", "closed|open"),
    one_of(psfp_bridge_m, "admin-ipv", ipv),
    node(psfp_bridge_m, "admin-control-list", stream_gate_list),
    node(psfp_bridge_m, "admin-cycle-time", rational<psfp_bridge_m>),
    leaf(psfp_bridge_m, "admin-cycle-time-extension", uint32),
    node(psfp_bridge_m, "admin-base-time", ptp_time<psfp_bridge_m>),
    leaf(psfp_bridge_m, "config-change", boolean),
    leaf(psfp_bridge_m, "gate-closed-due-to-invalid-rx-enable", boolean),
    leaf(psfp_bridge_m, "gate-closed-due-octets-exceeded-enable", boolean),
    state(psfp_bridge_m, "gate-closed-due-to-invalid-rx"),
    state(psfp_bridge_m, "gate-closed-due-octets-exceeded"),
    state(psfp_bridge_m, "oper-gate-state"),
    state(psfp_bridge_m, "oper-ipv"),
    state(psfp_bridge_m, "oper-control-list"),
    state(psfp_bridge_m, "oper-cycle-time"),
    state(psfp_bridge_m, "oper-cycle-time-extension"),
    state(psfp_bridge_m, "oper-base-time"),
    state(psfp_bridge_m, "config-change-time"),
    state(psfp_bridge_m, "tick-granularity"),
    state(psfp_bridge_m, "current-time"),
    state(psfp_bridge_m, "config-pending"),
    state(psfp_bridge_m, "config-change-error"),
};
constexpr Schema stream_gates[] = {
    entries(psfp_bridge_m, "stream-gate-instance-table", "stream-gate-instance-id", stream_gate),
    leaf(psfp_bridge_m, "supported-list-max", uint32),
    node(psfp_bridge_m, "supported-cycle-max", rational<psfp_bridge_m>),
    leaf(psfp_bridge_m, "supported-interval-max", uint32), leaf(psfp_bridge_m, "max-stream-gate-instances", uint32)};
constexpr Schema stream_filter[] = {
    leaf(psfp_bridge_m, "stream-filter-instance-id", uint32, true),
    leaf(psfp_bridge_m, "wildcard", empty),
    leaf(psfp_bridge_m, "stream-handle", uint32),
    one_of(psfp_bridge_m, "priority-spec", priorities, true),
    leaf(psfp_bridge_m, "max-sdu-size", uint32, true),
    leaf(psfp_bridge_m, "stream-blocked-due-to-oversize-frame-enabled", boolean),
    state(psfp_bridge_m, "stream-blocked-due-to-oversize-frame"),
    leaf(psfp_bridge_m, "stream-gate-ref", uint32, true),
    leaf(psfp_bridge_m, "flow-meter-ref", uint32),
    leaf(psfp_bridge_m, "flow-meter-enable", boolean),
    state(psfp_bridge_m, "matching-frames-count"),
    state(psfp_bridge_m, "passing-frames-count"),
    state(psfp_bridge_m, "not-passing-frames-count"),
    state(psfp_bridge_m, "red-frames-count"),
    state(psfp_bridge_m, "passing-sdu-count"),
    state(psfp_bridge_m, "not-passing-sdu-count"),
};
constexpr Schema stream_filters[] = {
    entries(psfp_bridge_m, "stream-filter-instance-table", "stream-filter-instance-id", stream_filter),
    leaf(psfp_bridge_m, "max-stream-filter-instances", uint32)};

// ATS: schedulers and their groups stand in the entry of a filter.
constexpr Schema scheduler[] = {leaf(ats_bridge_m, "scheduler-instance-id", uint32, true),
                                leaf(ats_bridge_m, "committed-information-rate", uint64, true),
                                leaf(ats_bridge_m, "committed-burst-size", uint32, true),
                                leaf(ats_bridge_m, "scheduler-group-ref", uint32, true)};
constexpr Schema schedulers[] = {entries(ats_bridge_m, "scheduler-instance-table", "scheduler-instance-id", scheduler),
                                 state(ats_bridge_m, "max-scheduler-instances")};
constexpr Schema scheduler_group[] = {leaf(ats_bridge_m, "scheduler-group-instance-id", uint32, true),
                                      leaf(ats_bridge_m, "max-residence-time", uint32, true)};
constexpr Schema scheduler_groups[] = {
    entries(ats_bridge_m, "scheduler-group-instance-table", "scheduler-group-instance-id", scheduler_group),
    state(ats_bridge_m, "max-scheduler-group-instances"), state(ats_bridge_m, "scheduler-timing-characteristics")};
constexpr Schema scheduler_use[] = {leaf(ats_bridge_m, "scheduler-ref", uint32),
                                    leaf(ats_bridge_m, "scheduler-enable", boolean)};
constexpr Schema ats_filter[] = {
    leaf(ats_bridge_m, "stream-filter-instance-id", uint32, true),
    leaf(ats_bridge_m, "wildcard", empty),
    leaf(ats_bridge_m, "stream-handle", uint32),
    one_of(ats_bridge_m, "priority-spec", priorities, true),
    leaf(ats_bridge_m, "max-sdu-size", uint32, true),
    leaf(ats_bridge_m, "stream-blocked-due-to-oversize-frame-enabled", boolean),
    state(ats_bridge_m, "stream-blocked-due-to-oversize-frame"),
    leaf(ats_bridge_m, "stream-gate-ref", uint32, true),
    node(ats_bridge_m, "schedulers", schedulers),
    node(ats_bridge_m, "scheduler-groups", scheduler_groups),
    node(ats_bridge_m, "scheduler", scheduler_use),
};
constexpr Schema ats_filters[] = {
    entries(ats_bridge_m, "stream-filter-instance-table", "stream-filter-instance-id", ats_filter),
    state(ats_bridge_m, "max-stream-filter-instances")};
constexpr Schema ats_gate[] = {
    leaf(ats_bridge_m, "stream-gate-instance-id", uint32, true), leaf(ats_bridge_m, "gate-enable", boolean),
    one_of(ats_bridge_m, "admin-gate-states", "closed|open"), one_of(ats_bridge_m, "admin-ipv", ipv)};
constexpr Schema ats_gates[] = {
    entries(ats_bridge_m, "stream-gate-instance-table", "stream-gate-instance-id", ats_gate),
    state(ats_bridge_m, "max-stream-gate-instances")};

constexpr Schema component_published[] = {
    leaf(dot1q_m, "name", text, true),
    identity_of(dot1q_m, "type", {}),
    state(dot1q_m, "id"),
    state(dot1q_m, "address"),
    state(dot1q_m, "traffic-class-enabled"),
    state(dot1q_m, "ports"),
    state(dot1q_m, "bridge-port"),
    state(dot1q_m, "capabilities"),
    unheard(dot1q_m, "filtering-database"),
    unheard(dot1q_m, "permanent-database"),
    unheard(dot1q_m, "bridge-vlan"),
    unheard(dot1q_m, "bridge-mst"),
    node(psfp_bridge_m, "flow-meters", meters<psfp_bridge_m>),
    node(psfp_bridge_m, "stream-gates", stream_gates),
    node(psfp_bridge_m, "stream-filters", stream_filters),
    node(ats_bridge_m, "stream-gates", ats_gates),
    node(ats_bridge_m, "stream-filters", ats_filters),
    leaf(iec_bridge_m, "frer-supported", boolean),
    leaf(iec_bridge_m, "max-ptp-instances", uint8),
    entries(iec_bridge_m, "independent-delays", "in-port-mau-type out-port-mau-type traffic-class", independent_delay),
    entries(iec_bridge_m, "dependent-delays", "in-port-line-speed", dependent_delay),
    entries(iec_bridge_m, "independent-delays-cascaded",
            "in-port in-port-mau-type out-port out-port-mau-type traffic-class", independent_delay_of_ports),
    entries(iec_bridge_m, "dependent-delays-cascaded", "in-port in-port-line-speed out-port", dependent_delay_of_ports),
    state(iec_bridge_m, "max-redundant-streams"),
    state(iec_bridge_m, "max-fids"),
    state(iec_bridge_m, "max-fdb-entries"),
    state(iec_bridge_m, "max-hot-standby-systems"),
    state(iec_bridge_m, "clock"),
};

// Policing, 2018; stream identification as NXP's module had it.
constexpr Schema parameters_of_gate_2018[] = {
    one_of(psfp_m, "gate-state-value", "closed|open", true), one_of(psfp_m, "ipv-value", priorities, true),
    leaf(psfp_m, "time-interval-value", uint32, true), leaf(psfp_m, "interval-octet-max", uint32)};
constexpr Schema stream_gate_entry_2018[] = {
    leaf(psfp_m, "index", uint32, true),
    identity_of(psfp_m, "operation-name", "ieee802-dot1q-psfp:set-gate-and-ipv", true),
    node(psfp_m, "parameters", parameters_of_gate_2018)};
constexpr Schema stream_gate_2018[] = {
    leaf(sfsg_m, "stream-gate-instance-id", uint32, true),
    leaf(sfsg_m, "gate-enable", boolean),
    one_of(sfsg_m, "admin-gate-states", "closed|open"),
    one_of(sfsg_m, "admin-ipv", priorities),
    leaf(psfp_m, "admin-control-list-length", uint32),
    entries(psfp_m, "admin-control-list", "index", stream_gate_entry_2018),
    node(psfp_m, "admin-cycle-time", rational_of_2018<psfp_m>),
    leaf(psfp_m, "admin-cycle-time-extension", uint32),
    node(psfp_m, "admin-base-time", ptp_time<psfp_m>),
    leaf(psfp_m, "config-change", boolean),
    leaf(psfp_m, "gate-closed-due-to-invalid-rx-enable", boolean),
    leaf(psfp_m, "gate-closed-due-octets-exceeded-enable", boolean),
    state(psfp_m, "oper-ipv"),
    state(psfp_m, "gate-closed-due-to-invalid-rx"),
    state(psfp_m, "gate-closed-due-octets-exceeded"),
};
constexpr Schema stream_gates_2018[] = {
    entries(sfsg_m, "stream-gate-instance-table", "stream-gate-instance-id", stream_gate_2018),
    state(sfsg_m, "max-stream-gate-instances"), leaf(psfp_m, "supported-list-max", uint32)};
constexpr Schema filter_part_2018[] = {
    leaf(sfsg_m, "index", uint8, true, 0, 255), leaf(sfsg_m, "maximum-sdu-size", uint32),
    leaf(sfsg_m, "stream-blocked-due-to-oversize-frame-enabled", boolean),
    state(sfsg_m, "stream-blocked-due-to-oversize-frame"), leaf(psfp_m, "flow-meter-ref", uint32)};
constexpr Schema stream_filter_2018[] = {leaf(sfsg_m, "stream-filter-instance-id", uint32, true),
                                         leaf(sfsg_m, "wildcard", empty),
                                         leaf(sfsg_m, "stream-handle", uint32),
                                         one_of(sfsg_m, "priority-spec", priorities, true),
                                         leaf(sfsg_m, "stream-gate-ref", uint32, true),
                                         entries(sfsg_m, "filter-specification-list", "index", filter_part_2018)};
constexpr Schema stream_filters_2018[] = {
    entries(sfsg_m, "stream-filter-instance-table", "stream-filter-instance-id", stream_filter_2018),
    state(sfsg_m, "max-stream-filter-instances")};
constexpr Schema null_2017[] = {leaf(stream_id_2017_m, "dest-address", mac),
                                one_of(stream_id_2017_m, "vlan-tagged", "tagged|priority|all"),
                                leaf(stream_id_2017_m, "vlan-id", uint16, false, 0, 4095)};
constexpr Schema source_2017[] = {leaf(stream_id_2017_m, "source-address", mac),
                                  one_of(stream_id_2017_m, "vlan-tagged", "tagged|priority|all"),
                                  leaf(stream_id_2017_m, "vlan-id", uint16, false, 0, 4095)};
constexpr Schema parameters_2017[] = {node(stream_id_2017_m, "null-stream-identification-params", null_2017),
                                      node(stream_id_2017_m, "source-mac-and-vlan-identification-params", source_2017)};
constexpr Schema identity_2017[] = {
    leaf(stream_id_2017_m, "index", uint32, true),
    leaf(stream_id_2017_m, "stream-handle", uint32, true),
    leaf(stream_id_2017_m, "stream-id-enabled", boolean, true),
    one_of(stream_id_2017_m, "identification-type", "null|source-mac-and-vlan|dest-mac-and-vlan|ip-octuple"),
    node(stream_id_2017_m, "parameters", parameters_2017),
    state(stream_id_2017_m, "in-facing-output-port-list"),
    state(stream_id_2017_m, "out-facing-output-port-list"),
    state(stream_id_2017_m, "in-facing-input-port-list"),
    state(stream_id_2017_m, "out-facing-input-port-list"),
    state(stream_id_2017_m, "autoconfigured"),
    state(stream_id_2017_m, "lan-path-id"),
};
constexpr Schema streams_2017[] = {entries(stream_id_2017_m, "stream-identity-table", "index", identity_2017)};
constexpr Schema component_of_2018[] = {
    leaf(dot1q_m, "name", text, true),
    identity_of(dot1q_m, "type", {}),
    state(dot1q_m, "id"),
    state(dot1q_m, "address"),
    state(dot1q_m, "traffic-class-enabled"),
    state(dot1q_m, "ports"),
    state(dot1q_m, "bridge-port"),
    state(dot1q_m, "capabilities"),
    unheard(dot1q_m, "filtering-database"),
    unheard(dot1q_m, "permanent-database"),
    unheard(dot1q_m, "bridge-vlan"),
    unheard(dot1q_m, "bridge-mst"),
    node(psfp_m, "flow-meters", meters<psfp_m>),
    node(sfsg_m, "stream-gates", stream_gates_2018),
    node(sfsg_m, "stream-filters", stream_filters_2018),
    node(stream_id_2017_m, "streams", streams_2017),
};
constexpr Schema bridge_published[] = {leaf(dot1q_m, "name", text, true),
                                       leaf(dot1q_m, "address", mac, true),
                                       identity_of(dot1q_m, "bridge-type", {}),
                                       state(dot1q_m, "ports"),
                                       state(dot1q_m, "up-time"),
                                       state(dot1q_m, "components"),
                                       entries(dot1q_m, "component", "name", component_published)};
constexpr Schema bridge_of_2018[] = {leaf(dot1q_m, "name", text, true),
                                     leaf(dot1q_m, "address", mac, true),
                                     identity_of(dot1q_m, "bridge-type", {}),
                                     state(dot1q_m, "ports"),
                                     state(dot1q_m, "up-time"),
                                     state(dot1q_m, "components"),
                                     entries(dot1q_m, "component", "name", component_of_2018)};
constexpr Schema bridges_published[] = {entries(dot1q_m, "bridge", "name", bridge_published)};
constexpr Schema bridges_of_2018[] = {entries(dot1q_m, "bridge", "name", bridge_of_2018)};

// Stream identification.
constexpr Schema facing[] = {leaves(sid_m, "input-port", text), leaves(sid_m, "output-port", text)};
constexpr Schema null_identification[] = {
    leaf(sid_m, "destination-mac", mac), one_of(sid_m, "tagged", "tagged|priority|all"),
    leaf(sid_m, "vlan", uint16, false, 0, 4095), state(sid_m, "identification-type")};
constexpr Schema source_identification[] = {
    leaf(sid_m, "source-mac", mac), one_of(sid_m, "tagged", "tagged|priority|all"),
    leaf(sid_m, "vlan", uint16, false, 0, 4095), state(sid_m, "identification-type")};
constexpr Schema active_address[] = {
    leaf(sid_m, "destination-mac", mac), one_of(sid_m, "tagged", "tagged|priority|all"),
    leaf(sid_m, "vlan", uint16, false, 0, 4095), leaf(sid_m, "priority", uint8, false, 0, 7)};
constexpr Schema active_identification[] = {node(sid_m, "down", active_address), node(sid_m, "up", active_address),
                                            state(sid_m, "identification-type")};
constexpr Schema stream_identity[] = {leaf(sid_m, "index", uint32, true),
                                      leaf(sid_m, "handle", uint32, true),
                                      node(sid_m, "in-facing", facing),
                                      node(sid_m, "out-facing", facing),
                                      node(sid_m, "null-stream-identification", null_identification),
                                      node(sid_m, "smac-vlan-stream-identification", source_identification),
                                      state(sid_m, "tsn-stream-id"),
                                      node(sid_m, "dmac-vlan-stream-identification", active_identification),
                                      node(sid_m, "ip-stream-identification", {})};

// Redundancy (802.1CB).
constexpr Schema sequence_generation[] = {leaf(frer_m, "index", uint32, true), leaves(frer_m, "stream", uint32),
                                          leaf(frer_m, "direction-out-facing", boolean),
                                          leaf(frer_m, "reset", boolean)};
constexpr Schema recovery_algorithm[] = {node(frer_m, "vector", {}), node(frer_m, "match", {}),
                                         unheard(frer_m, "organization-specific")};
constexpr Schema latent_errors[] = {leaf(frer_m, "difference", int32), leaf(frer_m, "period", uint32),
                                    leaf(frer_m, "paths", uint16), leaf(frer_m, "reset-period", uint32)};
constexpr Schema sequence_recovery[] = {
    leaf(frer_m, "index", uint32, true),
    leaves(frer_m, "stream", uint32),
    leaves(frer_m, "port", text),
    leaf(frer_m, "direction-out-facing", boolean),
    leaf(frer_m, "reset", boolean),
    node(frer_m, "algorithm", recovery_algorithm),
    leaf(frer_m, "history-length", uint32, false, 2),
    leaf(frer_m, "reset-timeout", uint32),
    state(frer_m, "invalid-sequence-value"),
    leaf(frer_m, "take-no-sequence", boolean),
    leaf(frer_m, "individual-recovery", boolean),
    leaf(frer_m, "latent-error-detection", boolean),
    node(frer_m, "latent-error-detection-parameters", latent_errors),
};
constexpr Schema encapsulation[] = {node(frer_m, "r-tag", {}), unheard(frer_m, "hsr-sequence-tag"),
                                    unheard(frer_m, "prp-sequence-tag"), unheard(frer_m, "organization-specific")};
constexpr Schema sequence_identification[] = {leaf(frer_m, "port", text, true),
                                              leaf(frer_m, "direction-out-facing", boolean, true),
                                              leaves(frer_m, "stream", uint32),
                                              leaf(frer_m, "active", boolean),
                                              node(frer_m, "encapsulation", encapsulation),
                                              unheard(frer_m, "path-id-lan-id")};
constexpr Schema stream_split[] = {leaf(frer_m, "port", text, true),
                                   leaf(frer_m, "direction-out-facing", boolean, true),
                                   leaves(frer_m, "input-id", uint32), leaves(frer_m, "output-id", uint32)};
constexpr Schema frer[] = {
    entries(frer_m, "sequence-generation", "index", sequence_generation),
    entries(frer_m, "sequence-recovery", "index", sequence_recovery),
    entries(frer_m, "sequence-identification", "port direction-out-facing", sequence_identification),
    entries(frer_m, "stream-split", "port direction-out-facing", stream_split), unheard(frer_m, "autoconfiguration")};

// gPTP.
constexpr std::string_view clock_classes =
    "ieee1588-ptp-tt:cc-primary-sync|ieee1588-ptp-tt:cc-primary-sync-lost|ieee1588-ptp-tt:cc-application-specific-sync|"
    "ieee1588-ptp-tt:cc-application-specific-sync-lost|ieee1588-ptp-tt:cc-primary-sync-alternative-a|"
    "ieee1588-ptp-tt:cc-application-specific-alternative-a|ieee1588-ptp-tt:cc-primary-sync-alternative-b|ieee1588-ptp-"
    "tt:cc-application-specific-alternative-b|ieee1588-ptp-tt:cc-default|ieee1588-ptp-tt:cc-time-receiver-only";
constexpr std::string_view clock_accuracies =
    "ieee1588-ptp-tt:ca-time-accurate-to-1000-fs|ieee1588-ptp-tt:ca-time-accurate-to-2500-fs|ieee1588-ptp-tt:ca-time-"
    "accurate-to-10-ps|ieee1588-ptp-tt:ca-time-accurate-to-25ps|ieee1588-ptp-tt:ca-time-accurate-to-100-ps|"
    "ieee1588-ptp-tt:ca-time-accurate-to-250-ps|ieee1588-ptp-tt:ca-time-accurate-to-1000-ps|ieee1588-ptp-tt:ca-time-"
    "accurate-to-2500-ps|ieee1588-ptp-tt:ca-time-accurate-to-10-ns|ieee1588-ptp-tt:ca-time-accurate-to-25-ns|"
    "ieee1588-ptp-tt:ca-time-accurate-to-100-ns|ieee1588-ptp-tt:ca-time-accurate-to-250-ns|ieee1588-ptp-tt:ca-time-"
    "accurate-to-1000-ns|ieee1588-ptp-tt:ca-time-accurate-to-2500-ns|ieee1588-ptp-tt:ca-time-accurate-to-10-us|"
    "ieee1588-ptp-tt:ca-time-accurate-to-25-us|ieee1588-ptp-tt:ca-time-accurate-to-100-us|ieee1588-ptp-tt:ca-time-"
    "accurate-to-250-us|ieee1588-ptp-tt:ca-time-accurate-to-1000-us|ieee1588-ptp-tt:ca-time-accurate-to-2500-us|"
    "ieee1588-ptp-tt:ca-time-accurate-to-10-ms|ieee1588-ptp-tt:ca-time-accurate-to-25-ms|ieee1588-ptp-tt:ca-time-"
    "accurate-to-100-ms|ieee1588-ptp-tt:ca-time-accurate-to-250-ms|ieee1588-ptp-tt:ca-time-accurate-to-1-s|"
    "ieee1588-ptp-tt:ca-time-accurate-to-10-s|ieee1588-ptp-tt:ca-time-accurate-to-gt-10-s";
constexpr std::string_view time_sources =
    "ieee1588-ptp-tt:atomic-clock|ieee1588-ptp-tt:gnss|ieee1588-ptp-tt:terrestrial-radio|ieee1588-ptp-tt:serial-time-"
    "code|ieee1588-ptp-tt:ptp|ieee1588-ptp-tt:ntp|ieee1588-ptp-tt:hand-set|ieee1588-ptp-tt:other|"
    "ieee1588-ptp-tt:internal-oscillator";
constexpr std::string_view port_states =
    "initializing|faulty|disabled|listening|pre-time-transmitter|time-transmitter|passive|uncalibrated|time-receiver";
constexpr Schema clock_quality[] = {identity_of(ptp_m, "clock-class", clock_classes),
                                    identity_of(ptp_m, "clock-accuracy", clock_accuracies),
                                    unheard(ptp_m, "offset-scaled-log-variance")};
constexpr Schema default_ds[] = {
    node(ptp_m, "clock-quality", clock_quality),
    leaf(ptp_m, "priority1", uint8),
    leaf(ptp_m, "priority2", uint8),
    leaf(ptp_m, "domain-number", uint8),
    leaf(ptp_m, "time-receiver-only", boolean),
    leaf(ptp_m, "sdo-id", uint16, false, 0, 4095),
    leaf(ptp_m, "instance-enable", boolean),
    leaf(ptp_m, "external-port-config-enable", boolean),
    unheard(ptp_m, "max-steps-removed"),
    one_of(ptp_m, "instance-type", "oc|bc|p2p-tc|e2e-tc"),
    state(ptp_m, "two-step-flag"),
    state(ptp_m, "clock-identity"),
    state(ptp_m, "number-ports"),
    state(ptp_m, "current-time"),
    state(gptp_m, "gm-capable"),
    state(gptp_m, "current-utc-offset"),
    state(gptp_m, "current-utc-offset-valid"),
    state(gptp_m, "leap59"),
    state(gptp_m, "leap61"),
    state(gptp_m, "time-traceable"),
    state(gptp_m, "frequency-traceable"),
    state(gptp_m, "ptp-timescale"),
    state(gptp_m, "time-source"),
};
constexpr Schema time_properties[] = {
    leaf(ptp_m, "current-utc-offset", int16), leaf(ptp_m, "current-utc-offset-valid", boolean),
    leaf(ptp_m, "leap59", boolean),           leaf(ptp_m, "leap61", boolean),
    leaf(ptp_m, "time-traceable", boolean),   leaf(ptp_m, "frequency-traceable", boolean),
    leaf(ptp_m, "ptp-timescale", boolean),    identity_of(ptp_m, "time-source", time_sources)};
constexpr Schema ptp_port_ds[] = {
    leaf(ptp_m, "log-announce-interval", int8),
    leaf(ptp_m, "announce-receipt-timeout", uint8),
    leaf(ptp_m, "log-sync-interval", int8),
    one_of(ptp_m, "delay-mechanism", "e2e|p2p|no-mechanism|common-p2p|special"),
    leaf(ptp_m, "log-min-pdelay-req-interval", int8),
    leaf(ptp_m, "port-enable", boolean),
    leaf(gptp_m, "mean-link-delay-thresh", int64),
    leaf(gptp_m, "initial-log-announce-interval", int8),
    leaf(gptp_m, "initial-log-sync-interval", int8),
    leaf(gptp_m, "initial-log-pdelay-req-interval", int8),
    leaf(gptp_m, "initial-log-gptp-cap-interval", int8),
    leaf(gptp_m, "sync-receipt-timeout", uint8),
    leaf(gptp_m, "initial-one-step-tx-oper", boolean),
    leaf(hs_m, "gptp-capable-state-machines-enabled", boolean),
    unheard(ptp_m, "log-min-delay-req-interval"),
    unheard(ptp_m, "version-number"),
    unheard(ptp_m, "minor-version-number"),
    unheard(ptp_m, "delay-asymmetry"),
    unheard(ptp_m, "time-transmitter-only"),
    unheard(gptp_m, "neg-mean-link-delay-thresh"),
    unheard(gptp_m, "use-mgt-log-announce-interval"),
    unheard(gptp_m, "use-mgt-log-sync-interval"),
    unheard(gptp_m, "use-mgt-log-pdelay-req-interval"),
    unheard(gptp_m, "mgt-log-pdelay-req-interval"),
    unheard(gptp_m, "use-mgt-log-gptp-cap-interval"),
    unheard(gptp_m, "mgt-log-gptp-cap-interval"),
    unheard(gptp_m, "initial-compute-neighbor-rate-ratio"),
    unheard(gptp_m, "use-mgt-compute-neighbor-rate-ratio"),
    unheard(gptp_m, "mgt-compute-neighbor-rate-ratio"),
    unheard(gptp_m, "initial-compute-mean-link-delay"),
    unheard(gptp_m, "use-mgt-compute-mean-link-delay"),
    unheard(gptp_m, "mgt-compute-mean-link-delay"),
    unheard(gptp_m, "allowed-lost-responses"),
    unheard(gptp_m, "allowed-faults"),
    unheard(gptp_m, "gptp-cap-receipt-timeout"),
    unheard(gptp_m, "nup"),
    unheard(gptp_m, "ndown"),
    unheard(gptp_m, "use-mgt-one-step-tx-oper"),
    unheard(gptp_m, "mgt-one-step-tx-oper"),
    unheard(hs_m, "nrr-comp-method"),
    state(ptp_m, "port-identity"),
    state(ptp_m, "port-state"),
    state(ptp_m, "mean-link-delay"),
    state(ptp_m, "peer-mean-path-delay"),
    state(gptp_m, "is-measuring-delay"),
    state(gptp_m, "as-capable"),
    state(gptp_m, "neighbor-rate-ratio"),
    state(gptp_m, "current-log-announce-interval"),
    state(gptp_m, "current-log-sync-interval"),
    state(gptp_m, "sync-receipt-timeout-interval"),
    state(gptp_m, "current-log-pdelay-req-interval"),
    state(gptp_m, "current-log-gptp-cap-interval"),
    state(gptp_m, "current-compute-neighbor-rate-ratio"),
    state(gptp_m, "current-compute-mean-link-delay"),
    state(gptp_m, "one-step-tx-oper"),
    state(gptp_m, "one-step-receive"),
    state(gptp_m, "one-step-transmit"),
    state(gptp_m, "current-one-step-tx-oper"),
    state(gptp_m, "sync-locked"),
    state(gptp_m, "pdelay-truncated-timestamps"),
    state(hs_m, "nrr-pdelay"),
    state(hs_m, "nrr-sync"),
    state(hs_m, "as-capable-across-domains"),
};
constexpr Schema timestamp_correction[] = {leaf(ptp_m, "egress-latency", int64), leaf(ptp_m, "ingress-latency", int64)};
constexpr Schema external_config[] = {one_of(ptp_m, "desired-state", port_states)};
constexpr Schema ptp_port[] = {
    leaf(ptp_m, "port-index", uint16, true),
    leaf(ptp_m, "underlying-interface", text),
    node(ptp_m, "port-ds", ptp_port_ds),
    node(ptp_m, "timestamp-correction-port-ds", timestamp_correction),
    node(ptp_m, "external-port-config-port-ds", external_config),
    unheard(ptp_m, "asymmetry-correction-port-ds"),
    unheard(ptp_m, "unicast-negotiation-port-ds"),
    unheard(ptp_m, "alternate-time-transmitter-port-ds"),
    unheard(ptp_m, "unicast-discovery-port-ds"),
    unheard(ptp_m, "acceptable-time-transmitter-port-ds"),
    unheard(ptp_m, "l1-sync-basic-port-ds"),
    unheard(ptp_m, "l1-sync-opt-params-port-ds"),
    unheard(ptp_m, "common-services-port-ds"),
    unheard(ptp_m, "time-receiver-monitoring-port-ds"),
    unheard(gptp_m, "asymmetry-measurement-mode-ds"),
    state(ptp_m, "description-port-ds"),
    state(ptp_m, "communication-cap-port-ds"),
    state(ptp_m, "performance-monitoring-port-ds"),
    state(gptp_m, "port-statistics-ds"),
};
constexpr Schema ptp_ports[] = {entries(ptp_m, "port", "port-index", ptp_port)};
constexpr Schema drift_tracking[] = {leaf(hs_m, "drift-tracking-tlv-support", boolean),
                                     state(hs_m, "sync-grandmaster-identity"), state(hs_m, "sync-steps-removed"),
                                     state(hs_m, "rate-ratio-drift")};
constexpr Schema instance_sync[] = {leaf(hs_m, "offset-from-time-transmitter-max", int64),
                                    leaf(hs_m, "rx-sync-count-time-receiver-p-thresh", uint32),
                                    leaf(hs_m, "offset-max-exceeded-count-thresh", uint32),
                                    leaf(hs_m, "offset-max-met-count-thresh", uint32), state(hs_m, "is-synced")};
constexpr Schema ptp_instance[] = {
    leaf(ptp_m, "instance-index", uint32, true),
    node(ptp_m, "default-ds", default_ds),
    node(ptp_m, "time-properties-ds", time_properties),
    node(ptp_m, "ports", ptp_ports),
    node(hs_m, "drift-tracking-ds", drift_tracking),
    node(hs_m, "ptp-instance-sync-ds", instance_sync),
    unheard(ptp_m, "alternate-timescale-ds"),
    unheard(ptp_m, "holdover-upgrade-ds"),
    unheard(ptp_m, "grandmaster-cluster-ds"),
    unheard(ptp_m, "acceptable-time-transmitter-ds"),
    state(ptp_m, "current-ds"),
    state(ptp_m, "parent-ds"),
    state(ptp_m, "description-ds"),
    state(ptp_m, "fault-log-ds"),
    state(ptp_m, "path-trace-ds"),
    state(ptp_m, "performance-monitoring-ds"),
    state(ptp_m, "enhanced-metrics-ds"),
};
constexpr Schema ptp_instances[] = {entries(ptp_m, "instance", "instance-index", ptp_instance)};
// Hot standby (IEEE 802.1ASdm).
constexpr Schema standby_system_ds[] = {leaf(hs_m, "primary-ptp-instance-index", uint32),
                                        leaf(hs_m, "secondary-ptp-instance-index", uint32),
                                        leaf(hs_m, "hot-standby-system-enable", boolean),
                                        leaf(hs_m, "hot-standby-system-split-functionality", boolean),
                                        leaf(hs_m, "primary-secondary-offset-thresh", text),
                                        leaf(hs_m, "hot-standby-system-log-sync-time-thresh", int8),
                                        state(hs_m, "hot-standby-system-state"),
                                        state(hs_m, "primary-secondary-offset")};
constexpr Schema standby_system[] = {leaf(hs_m, "hot-standby-system-index", uint8, true),
                                     node(hs_m, "hot-standby-system-ds", standby_system_ds),
                                     unheard(hs_m, "hot-standby-system-description-ds")};
constexpr Schema standby_service[] = {entries(hs_m, "hot-standby-system", "hot-standby-system-index", standby_system)};
constexpr Schema common_services[] = {node(hs_m, "hot-standby-service", standby_service), unheard(ptp_m, "cmlds")};
constexpr Schema ptp[] = {node(ptp_m, "instances", ptp_instances), node(ptp_m, "common-services", common_services),
                          unheard(ptp_m, "transparent-clock-default-ds"), unheard(ptp_m, "transparent-clock-ports")};

constexpr Schema published[] = {
    node(if_m, "interfaces", interfaces_published), node(dot1q_m, "bridges", bridges_published),
    entries(sid_m, "stream-identity", "index", stream_identity), node(frer_m, "frer", frer), node(ptp_m, "ptp", ptp)};
constexpr Schema of_2018[] = {node(if_m, "interfaces", interfaces_of_2018), node(dot1q_m, "bridges", bridges_of_2018)};
constexpr Schema published_root = node({}, {}, published);
constexpr Schema root_of_2018 = node({}, {}, of_2018);

}  // namespace

const Schema* Schema::find(std::string_view which_module, std::string_view which_name) const {
  const auto found = std::ranges::find_if(
      children, [&](const Schema& each) { return each.name == which_name && each.module == which_module; });
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
std::vector<std::string_view> known_modules() {
  std::vector<std::string_view> names;
  for (const Module& module : modules) names.push_back(module.name);
  return names;
}

const Schema& root_of(Dialect dialect) { return dialect == Dialect::published ? published_root : root_of_2018; }

}  // namespace takt::interchange::yang
