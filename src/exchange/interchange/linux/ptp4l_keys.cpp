// SPDX-License-Identifier: Apache-2.0
#include "interchange/linux/ptp4l_keys.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace takt::interchange::linux_tc {
namespace {

constexpr double any = 2147483647;

constexpr Key all_keys[] = {
    {"logSyncInterval", ValueKind::whole, -128, 127,
     [](Target& t, double v, const std::string&) { t.gptp.log_sync_interval = static_cast<std::int8_t>(v); }},
    {"logAnnounceInterval", ValueKind::whole, -128, 127,
     [](Target& t, double v, const std::string&) { t.gptp.log_announce_interval = static_cast<std::int8_t>(v); }},
    {"logMinPdelayReqInterval", ValueKind::whole, -128, 127,
     [](Target& t, double v, const std::string&) { t.gptp.log_pdelay_interval = static_cast<std::int8_t>(v); }},
    {"syncReceiptTimeout", ValueKind::whole, 0, 255,
     [](Target& t, double v, const std::string&) { t.gptp.sync_receipt_timeout = static_cast<std::uint8_t>(v); }},
    {"announceReceiptTimeout", ValueKind::whole, 2, 255,
     [](Target& t, double v, const std::string&) { t.gptp.announce_receipt_timeout = static_cast<std::uint8_t>(v); }},
    {"neighborPropDelayThresh", ValueKind::whole, 0, any,
     [](Target& t, double v, const std::string&) {
       t.gptp.link_delay_threshold = sim::Duration::from_ps(static_cast<std::int64_t>(v) * 1000);
     }},
    {"priority1", ValueKind::whole, 0, 255,
     [](Target& t, double v, const std::string&) { t.node.priority1 = static_cast<std::uint8_t>(v); }},
    {"priority2", ValueKind::whole, 0, 255,
     [](Target& t, double v, const std::string&) { t.node.priority2 = static_cast<std::uint8_t>(v); }},
    {"clockClass", ValueKind::whole, 0, 255,
     [](Target& t, double v, const std::string&) { t.node.clock_class = static_cast<std::uint8_t>(v); }},
    {"clockAccuracy", ValueKind::whole, 0, 255,
     [](Target& t, double v, const std::string&) { t.node.clock_accuracy = static_cast<std::uint8_t>(v); }},
    {"gmCapable", ValueKind::whole, 0, 1,
     [](Target& t, double v, const std::string&) { t.never_grandmaster = v == 0; }},
    {"slaveOnly", ValueKind::whole, 0, 1, [](Target& t, double v, const std::string&) { t.receiver_only = v != 0; }},
    {"twoStepFlag", ValueKind::whole, 0, 1, [](Target& t, double v, const std::string&) { t.gptp.one_step = v == 0; }},
    {"clock_servo", ValueKind::text, 0, 0,
     [](Target& t, double, const std::string&) { t.gptp.servo.algorithm = scenario::ServoAlgorithm::pi; }},
    {"first_step_threshold", ValueKind::real, 0, 1e9,
     [](Target& t, double v, const std::string&) {
       t.gptp.servo.first_step_threshold = sim::Duration::from_ps(std::llround(v * 1e12));
     }},
    {"step_threshold", ValueKind::real, 0, 1e9,
     [](Target& t, double v, const std::string&) {
       t.gptp.servo.step_threshold = sim::Duration::from_ps(std::llround(v * 1e12));
     }},
    {"max_frequency", ValueKind::whole, 0, any,
     [](Target& t, double v, const std::string&) {
       t.gptp.servo.max_frequency = {static_cast<std::int64_t>(v) * 1000};
     }},
    {"egressLatency", ValueKind::whole, -any, any,
     [](Target& t, double v, const std::string&) {
       t.clock.tx_correction = sim::Duration::from_ps(static_cast<std::int64_t>(v) * 1000);
       t.has_clock = true;
     }},
    {"ingressLatency", ValueKind::whole, -any, any,
     [](Target& t, double v, const std::string&) {
       t.clock.rx_correction = sim::Duration::from_ps(static_cast<std::int64_t>(v) * 1000);
       t.has_clock = true;
     }},
    {"transportSpecific", ValueKind::whole, 0, 15, [](Target& t, double v, const std::string&) { t.is_gptp = v == 1; }},
    // What the reader judges, what takt does in one way alone, and what changes no message and no clock.
    {"domainNumber", ValueKind::whole, 0, 127, nullptr, "", ""},
    {"network_transport", ValueKind::text, 0, 0, nullptr, "", ""},
    {"delay_mechanism", ValueKind::text, 0, 0, nullptr, "", ""},
    {"masterOnly", ValueKind::whole, 0, 1, nullptr, "", ""},
    {"BMCA", ValueKind::text, 0, 0, nullptr, "", ""},
    {"offsetScaledLogVariance", ValueKind::whole, 0, 65535, nullptr, "", ""},
    {"min_neighbor_prop_delay", ValueKind::whole, -any, any, nullptr, "-20000000",
     "a least link delay of ports that are capable"},
    {"path_trace_enabled", ValueKind::whole, 0, 1, nullptr, "1", "Announce without path trace, which takt's has"},
    {"follow_up_info", ValueKind::whole, 0, 1, nullptr, "1", "Follow_Up without its information TLV, which takt's has"},
    {"ptp_dst_mac", ValueKind::text, 0, 0, nullptr, "01:80:C2:00:00:0E|01:1B:19:00:00:00",
     "another address of the messages"},
    {"p2p_dst_mac", ValueKind::text, 0, 0, nullptr, "01:80:C2:00:00:0E", "another address of the messages"},
    {"pi_proportional_const", ValueKind::real, 0, any, nullptr, "0",
     "other constants of the servo than those that linuxptp takes by default, which are takt's"},
    {"pi_integral_const", ValueKind::real, 0, any, nullptr, "0",
     "other constants of the servo than those that linuxptp takes by default, which are takt's"},
    {"pi_proportional_scale", ValueKind::real, 0, any, nullptr, "0",
     "other constants of the servo than those that linuxptp takes by default, which are takt's"},
    {"pi_proportional_exponent", ValueKind::real, -any, any, nullptr, "-0.3",
     "other constants of the servo than those that linuxptp takes by default, which are takt's"},
    {"pi_proportional_norm_max", ValueKind::real, 0, 1, nullptr, "0.7",
     "other constants of the servo than those that linuxptp takes by default, which are takt's"},
    {"pi_integral_scale", ValueKind::real, 0, any, nullptr, "0",
     "other constants of the servo than those that linuxptp takes by default, which are takt's"},
    {"pi_integral_exponent", ValueKind::real, -any, any, nullptr, "0.4",
     "other constants of the servo than those that linuxptp takes by default, which are takt's"},
    {"pi_integral_norm_max", ValueKind::real, 0, 2, nullptr, "0.3",
     "other constants of the servo than those that linuxptp takes by default, which are takt's"},
    {"inhibit_announce", ValueKind::whole, 0, 1, nullptr, "0", "ports that send no Announce"},
    {"inhibit_delay_req", ValueKind::whole, 0, 1, nullptr, "0", "ports that do not ask for the delay"},
    {"inhibit_multicast_service", ValueKind::whole, 0, 1, nullptr, "0", "ports without multicast messages"},
    {"asCapable", ValueKind::text, 0, 0, nullptr, "auto",
     "ports that are capable whatever is measured (asCapable true)"},
    {"ignore_source_id", ValueKind::whole, 0, 1, nullptr, "0", "messages that are taken from whatever source"},
    {"ignore_transport_specific", ValueKind::whole, 0, 1, nullptr, "0", "messages of whatever profile"},
    {"time_stamping", ValueKind::text, 0, 0, nullptr, "hardware|onestep|p2p1step",
     "time stamps that are not taken at the wire: takt's are"},
    {"free_running", ValueKind::whole, 0, 1, nullptr, "0",
     "a clock that is measured and not adjusted (free_running): takt's servo adjusts it"},
    {"freq_est_interval", ValueKind::whole, 0, any, nullptr, "1",
     "how long the frequency is estimated before the servo locks"},
    {"fault_reset_interval", ValueKind::text, 0, 0, nullptr, "4|ASAP", "how long a port rests after a fault"},
    {"fault_badpeernet_interval", ValueKind::text, 0, 0, nullptr, "16|ASAP", "how long a port rests after a fault"},
    {"delayAsymmetry", ValueKind::whole, -any, any, nullptr, "0",
     "a link that is slower in one direction: takt's links are alike in both"},
    {"delay_filter", ValueKind::text, 0, 0, nullptr, "moving_median", "how link delays are filtered"},
    {"delay_filter_length", ValueKind::whole, 1, any, nullptr, "10", "how link delays are filtered"},
    {"dataset_comparison", ValueKind::text, 0, 0, nullptr, "ieee1588", "another comparison of clocks (G.8275)"},
    {"G.8275.defaultDS.localPriority", ValueKind::whole, 1, 255, nullptr, "128", "a local priority"},
    {"G.8275.portDS.localPriority", ValueKind::whole, 1, 255, nullptr, "128", "a local priority"},
    {"maxStepsRemoved", ValueKind::whole, 2, 255, nullptr, "255", "the longest way from the grandmaster"},
    {"operLogSyncInterval", ValueKind::whole, -128, 127, nullptr, "0", "another interval once a port is synchronised"},
    {"operLogPdelayReqInterval", ValueKind::whole, -128, 127, nullptr, "0",
     "another interval once a port is synchronised"},
    {"msg_interval_request", ValueKind::whole, 0, 1, nullptr, "0", "intervals that a neighbour asks for"},
    {"hybrid_e2e", ValueKind::whole, 0, 1, nullptr, "0", "delays measured end to end"},
    {"net_sync_monitor", ValueKind::whole, 0, 1, nullptr, "0", "the monitor of a network's time"},
    {"tc_spanning_tree", ValueKind::whole, 0, 1, nullptr, "0", "a transparent clock"},
    {"clock_type", ValueKind::text, 0, 0, nullptr, "OC|BC",
     "a transparent clock, or none: takt's are ordinary clocks and relays"},
    {"sanity_freq_limit", ValueKind::whole, 0, any, nullptr, "200000000|0",
     "a frequency beyond which the servo begins anew"},
    {"clockIdentity", ValueKind::text, 0, 0, nullptr, "000000.0000.000000",
     "the identity of the clock, by which equal clocks are told apart: takt does it by the order of nodes"},
    {"tsproc_mode", ValueKind::text, 0, 0, nullptr, "filter", "how time stamps are processed"},
    {"unicast_listen", ValueKind::whole, 0, 1, nullptr, "0", "unicast messages"},
    {"unicast_master_table", ValueKind::whole, 0, any, nullptr, "0", "unicast messages"},
    {"unicast_req_duration", ValueKind::whole, 10, any, nullptr, "3600", "unicast messages"},
    {"allowedLostResponses", ValueKind::whole, 1, 255, nullptr, "3|9",
     "after how many lost answers a port is not capable"},
    {"boundary_clock_jbod", ValueKind::whole, 0, 1, nullptr, "0|1", ""},
    {"step_window", ValueKind::whole, 0, any, nullptr, "0", "a window after a step"},
    {"inhibit_pps", ValueKind::whole, 0, any, nullptr, "", ""},
    {"initial_delay", ValueKind::whole, 0, any, nullptr, "0", "a delay that is known before it is measured"},
    {"power_profile.version", ValueKind::text, 0, 0, nullptr, "none", "the power profile"},
    {"interface_rate_tlv", ValueKind::whole, 0, 1, nullptr, "0", "rates of interfaces in messages"},
    {"spp", ValueKind::whole, -1, 255, nullptr, "-1", "authenticated messages"},
    {"active_key_id", ValueKind::whole, 0, any, nullptr, "0", "authenticated messages"},
    {"sa_file", ValueKind::text, 0, 0, nullptr, "", ""},
    {"allow_unauth", ValueKind::whole, 0, 2, nullptr, "0", "messages without authentication"},
    {"delay_response_timeout", ValueKind::whole, 0, 255, nullptr, "0", "a time-out of delays"},
    {"assume_two_step", ValueKind::whole, 0, 1},
    {"tx_timestamp_timeout", ValueKind::whole, 1, any},
    {"summary_interval", ValueKind::whole, -any, any},
    {"logging_level", ValueKind::whole, 0, 7},
    {"verbose", ValueKind::whole, 0, 1},
    {"use_syslog", ValueKind::whole, 0, 1},
    {"kernel_leap", ValueKind::whole, 0, 1},
    {"check_fup_sync", ValueKind::whole, 0, 1},
    {"servo_num_offset_values", ValueKind::whole, 0, any},
    {"servo_offset_threshold", ValueKind::whole, 0, any},
    {"utc_offset", ValueKind::whole, 0, 32767},
    {"timeSource", ValueKind::whole, 0, 254},
    {"uds_address", ValueKind::text, 0, 0},
    {"uds_ro_address", ValueKind::text, 0, 0},
    {"uds_file_mode", ValueKind::text, 0, 0},
    {"uds_ro_file_mode", ValueKind::text, 0, 0},
    {"udp_ttl", ValueKind::whole, 1, 255},
    {"udp6_scope", ValueKind::whole, 0, 15},
    {"ptp_dst_ipv4", ValueKind::text, 0, 0},
    {"p2p_dst_ipv4", ValueKind::text, 0, 0},
    {"ptp_dst_ipv6", ValueKind::text, 0, 0},
    {"p2p_dst_ipv6", ValueKind::text, 0, 0},
    {"dscp_event", ValueKind::whole, 0, 63},
    {"dscp_general", ValueKind::whole, 0, 63},
    {"socket_priority", ValueKind::whole, 0, 15},
    {"productDescription", ValueKind::text, 0, 0},
    {"revisionData", ValueKind::text, 0, 0},
    {"manufacturerIdentity", ValueKind::text, 0, 0},
    {"userDescription", ValueKind::text, 0, 0},
    {"neighborPropDelay", ValueKind::whole, 0, any},
    {"hwts_filter", ValueKind::text, 0, 0},
    {"write_phase_mode", ValueKind::whole, 0, 1},
    {"logMinDelayReqInterval", ValueKind::whole, -128, 127},
    {"message_tag", ValueKind::text, 0, 0},
    {"slave_event_monitor", ValueKind::text, 0, 0},
    {"client_event_monitor", ValueKind::text, 0, 0},
    {"phc_index", ValueKind::whole, -1, any},
    {"ntpshm_segment", ValueKind::whole, -any, any},
    {"refclock_sock_address", ValueKind::text, 0, 0},
    {"leapfile", ValueKind::text, 0, 0},
    {"ptp_minor_version", ValueKind::whole, 0, 1},
    {"power_profile.2011.grandmasterTimeInaccuracy", ValueKind::whole, -1, any},
    {"power_profile.2011.networkTimeInaccuracy", ValueKind::whole, -1, any},
    {"power_profile.2017.totalTimeInaccuracy", ValueKind::whole, -1, any},
    {"power_profile.grandmasterID", ValueKind::whole, 0, any},
    {"table_id", ValueKind::whole, 0, any},
    {"logQueryInterval", ValueKind::whole, -128, 127},
    {"peer_address", ValueKind::text, 0, 0},
    {"L2", ValueKind::text, 0, 0},
    {"UDPv4", ValueKind::text, 0, 0},
    {"UDPv6", ValueKind::text, 0, 0},
    {"hash_name", ValueKind::text, 0, 0},
};

constexpr std::pair<std::string_view, std::string_view> renamed[] = {
    {"serverOnly", "masterOnly"}, {"clientOnly", "slaveOnly"}, {"client_event_monitor", "slave_event_monitor"}};

}  // namespace

std::span<const Key> ptp4l_keys() { return all_keys; }

std::string_view ptp4l_key(std::string_view name) {
  const auto found = std::ranges::find(renamed, name, &std::pair<std::string_view, std::string_view>::first);
  return found == std::end(renamed) ? name : found->second;
}

bool is_usual(const Key& key, double value, std::string_view text) {
  const auto same_text = [&](std::string_view usual) {
    return std::ranges::equal(usual, text,
                              [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); });
  };
  std::string_view rest = key.usual;
  while (true) {
    const std::size_t bar = rest.find('|');
    const std::string_view usual = rest.substr(0, bar);
    double number = 0;
    const auto [stop, error] = std::from_chars(usual.data(), usual.data() + usual.size(), number);
    if (key.kind == ValueKind::text ? same_text(usual) : error == std::errc() && number == value) return true;
    if (bar == std::string_view::npos) return false;
    rest.remove_prefix(bar + 1);
  }
}

}  // namespace takt::interchange::linux_tc
