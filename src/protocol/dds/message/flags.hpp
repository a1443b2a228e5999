// SPDX-License-Identifier: Apache-2.0
// The flags of submessages (DDSI-RTPS 9.4.5), for encoder and decoder alike. Bits that are not named here are ignored.
#pragma once

namespace takt::dds::flags {

inline constexpr unsigned little_endian = 0x01;

inline constexpr unsigned data_inline_qos = 0x02;
inline constexpr unsigned data_data = 0x04;
inline constexpr unsigned data_key = 0x08;
inline constexpr unsigned data_not_standard = 0x10;

inline constexpr unsigned frag_inline_qos = 0x02;
inline constexpr unsigned frag_key = 0x04;
inline constexpr unsigned frag_not_standard = 0x08;

inline constexpr unsigned final_ = 0x02;  // HEARTBEAT and ACKNACK
inline constexpr unsigned liveliness = 0x04;
inline constexpr unsigned timestamp_invalid = 0x02;
inline constexpr unsigned multicast_reply = 0x02;

}  // namespace takt::dds::flags
