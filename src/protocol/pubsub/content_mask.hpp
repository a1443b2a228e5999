// SPDX-License-Identifier: Apache-2.0
// Which optional parts of a message are sent: the content masks (OPC 10000-14, 6.3.1.1.4 and 6.3.1.3.2; core nodeset).
#pragma once

#include <cstdint>

namespace takt::pubsub {

/// UadpNetworkMessageContentMask. Bits 2 to 5 need GroupHeader, PicoSeconds needs Timestamp.
namespace network_message_content {
inline constexpr std::uint32_t PublisherId = 1U << 0;
inline constexpr std::uint32_t GroupHeader = 1U << 1;
inline constexpr std::uint32_t WriterGroupId = 1U << 2;
inline constexpr std::uint32_t GroupVersion = 1U << 3;
inline constexpr std::uint32_t NetworkMessageNumber = 1U << 4;
inline constexpr std::uint32_t SequenceNumber = 1U << 5;
inline constexpr std::uint32_t PayloadHeader = 1U << 6;
inline constexpr std::uint32_t Timestamp = 1U << 7;
inline constexpr std::uint32_t PicoSeconds = 1U << 8;
inline constexpr std::uint32_t periodic_fixed = 0x3F;                  ///< A.2.1
inline constexpr std::uint32_t dynamic = PublisherId | PayloadHeader;  ///< A.2.2
}  // namespace network_message_content

/// UadpDataSetMessageContentMask.
namespace data_set_message_content {
inline constexpr std::uint32_t Timestamp = 1U << 0;
inline constexpr std::uint32_t PicoSeconds = 1U << 1;
inline constexpr std::uint32_t Status = 1U << 2;
inline constexpr std::uint32_t MajorVersion = 1U << 3;
inline constexpr std::uint32_t MinorVersion = 1U << 4;
inline constexpr std::uint32_t SequenceNumber = 1U << 5;
inline constexpr std::uint32_t periodic_fixed = Status | SequenceNumber;                      ///< A.2.1
inline constexpr std::uint32_t dynamic = Timestamp | Status | MinorVersion | SequenceNumber;  ///< A.2.2
}  // namespace data_set_message_content

/// DataSetFieldContentMask (OPC 10000-14, 6.2.4.2): none of them is the Variant encoding, RawData alone is RawData, all
/// others are DataValues.
namespace data_set_field_content {
inline constexpr std::uint32_t StatusCode = 1U << 0;
inline constexpr std::uint32_t SourceTimestamp = 1U << 1;
inline constexpr std::uint32_t ServerTimestamp = 1U << 2;
inline constexpr std::uint32_t SourcePicoSeconds = 1U << 3;
inline constexpr std::uint32_t ServerPicoSeconds = 1U << 4;
inline constexpr std::uint32_t RawData = 1U << 5;
}  // namespace data_set_field_content

}  // namespace takt::pubsub
