// SPDX-License-Identifier: Apache-2.0
// The flag octets of UADP (OPC 10000-14, 7.2.4.4.2 and 7.2.4.5.4), for encoder and decoder alike.
#pragma once

namespace takt::uadp::flags {

// Octet 0: version in bits 0 to 3.
inline constexpr unsigned version = 1;
inline constexpr unsigned version_mask = 0x0F;
inline constexpr unsigned publisher_id = 0x10;
inline constexpr unsigned group_header = 0x20;
inline constexpr unsigned payload_header = 0x40;
inline constexpr unsigned extended_1 = 0x80;

// ExtendedFlags1: type of the PublisherId in bits 0 to 2.
inline constexpr unsigned publisher_id_type_mask = 0x07;
inline constexpr unsigned data_set_class_id = 0x08;
inline constexpr unsigned security = 0x10;
inline constexpr unsigned timestamp = 0x20;
inline constexpr unsigned picoseconds = 0x40;
inline constexpr unsigned extended_2 = 0x80;

// ExtendedFlags2: type of the NetworkMessage in bits 2 to 4.
inline constexpr unsigned chunk = 0x01;
inline constexpr unsigned promoted_fields = 0x02;
inline constexpr unsigned message_type_shift = 2;
inline constexpr unsigned message_type_mask = 0x07;
inline constexpr unsigned action_header = 0x20;
inline constexpr unsigned extended_2_reserved = 0xC0;

// GroupFlags.
inline constexpr unsigned writer_group_id = 0x01;
inline constexpr unsigned group_version = 0x02;
inline constexpr unsigned network_message_number = 0x04;
inline constexpr unsigned group_sequence_number = 0x08;
inline constexpr unsigned group_reserved = 0xF0;

// DataSetFlags1: field encoding in bits 1 and 2.
inline constexpr unsigned valid = 0x01;
inline constexpr unsigned field_encoding_shift = 1;
inline constexpr unsigned field_encoding_mask = 0x03;
inline constexpr unsigned sequence_number = 0x08;
inline constexpr unsigned status = 0x10;
inline constexpr unsigned major_version = 0x20;
inline constexpr unsigned minor_version = 0x40;
inline constexpr unsigned data_set_flags_2 = 0x80;

// DataSetFlags2: type of the DataSetMessage in bits 0 to 3.
inline constexpr unsigned data_set_message_type_mask = 0x0F;
inline constexpr unsigned data_set_timestamp = 0x10;
inline constexpr unsigned data_set_picoseconds = 0x20;
inline constexpr unsigned data_set_flags_2_reserved = 0xC0;

}  // namespace takt::uadp::flags
