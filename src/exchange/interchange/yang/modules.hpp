// SPDX-License-Identifier: Apache-2.0
// The names of the YANG modules that takt knows.
#pragma once

#include <string_view>

namespace takt::interchange::yang {

inline constexpr std::string_view if_m = "ietf-interfaces";
inline constexpr std::string_view ianaift_m = "iana-if-type";
inline constexpr std::string_view dot1q_m = "ieee802-dot1q-bridge";
inline constexpr std::string_view types_m = "ieee802-dot1q-types";
inline constexpr std::string_view sched_m = "ieee802-dot1q-sched";
inline constexpr std::string_view sched_bridge_m = "ieee802-dot1q-sched-bridge";
inline constexpr std::string_view preempt_m = "ieee802-dot1q-preemption";
inline constexpr std::string_view preempt_bridge_m = "ieee802-dot1q-preemption-bridge";
inline constexpr std::string_view cbsa_bridge_m = "ieee802-dot1q-cbsa-bridge";
inline constexpr std::string_view psfp_m = "ieee802-dot1q-psfp";
inline constexpr std::string_view psfp_bridge_m = "ieee802-dot1q-psfp-bridge";
inline constexpr std::string_view sfsg_m = "ieee802-dot1q-stream-filters-gates";
inline constexpr std::string_view ats_bridge_m = "ieee802-dot1q-ats-bridge";
inline constexpr std::string_view sid_m = "ieee802-dot1cb-stream-identification";
inline constexpr std::string_view frer_m = "ieee802-dot1cb-frer";
inline constexpr std::string_view ptp_m = "ieee1588-ptp-tt";
inline constexpr std::string_view gptp_m = "ieee802-dot1as-gptp";
inline constexpr std::string_view hs_m = "ieee802-dot1as-hs";
inline constexpr std::string_view eth_m = "ieee802-ethernet-interface";
inline constexpr std::string_view mac_merge_m = "ieee802-ethernet-mac-merge";
inline constexpr std::string_view iec_bridge_m = "iecieee60802-bridge";
inline constexpr std::string_view iec_eth_m = "iecieee60802-ethernet-interface";
inline constexpr std::string_view iec_sched_m = "iecieee60802-sched-bridge";
inline constexpr std::string_view stream_id_2017_m = "ieee802-dot1q-cb-stream-identification";
inline constexpr std::string_view cnc_m = "ieee802-dot1q-cnc-config";

}  // namespace takt::interchange::yang
