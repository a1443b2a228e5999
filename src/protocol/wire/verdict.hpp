// SPDX-License-Identifier: Apache-2.0
// What becomes of a message that has come: taken, or why not. What is refused is counted, for each sender; nothing of
// it is acted upon.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace takt::wire {

enum class Verdict : std::uint8_t {
  taken,
  // Of this group and sound, but not to be stepped with.
  stale,
  not_running,
  unsubscribed,
  // Refused by what it says.
  not_uadp,
  other_publisher,
  other_group,
  other_version,
  other_layout,
  impossible,
  // Refused by its security.
  unsecured,
  secured,
  security_mode,
  security_header,
  token,
  truncated,
  signature,
  replayed,
  // Refused by the way on which it came.
  empty,
  too_short,
  too_long,
  vlan,
  address,
};

struct VerdictInfo {
  std::string_view name;
  std::string_view meaning;
};

/// By verdict.
inline constexpr auto verdicts = std::to_array<VerdictInfo>({
    {"taken", "stepped with, or given to the application"},
    {"stale", "overtaken, or came twice"},
    {"not_running", "process data of another run, or while this participant was not Running"},
    {"unsubscribed", "of the group, but of nobody whom this participant hears"},
    {"not_uadp", "no NetworkMessage with DataSetMessages of UADP version 1"},
    {"other_publisher", "a PublisherId that no participant of the group has"},
    {"other_group", "a WriterGroupId that the group does not have"},
    {"other_version", "another GroupVersion: the sender has been configured differently"},
    {"other_layout", "the ids of the group, but not its octets"},
    {"impossible", "says what no participant of the group says"},
    {"unsecured", "not signed, in a group whose messages are"},
    {"secured", "signed or encrypted, in a group whose messages are not"},
    {"security_mode", "signed only where messages are encrypted, or the other way round"},
    {"security_header", "reserved bits, a footer, or a nonce of another length"},
    {"token", "a key that this node does not have, or no longer or not yet takes"},
    {"truncated", "no room for a signature"},
    {"signature", "a signature that its key has not made"},
    {"replayed", "signed before the newest that has come of this sender"},
    {"empty", "a datagram without an octet"},
    {"too_short", "a frame without a message"},
    {"too_long", "longer than any message of a Program"},
    {"vlan", "of another VLAN"},
    {"address", "to an address of another interface, or to another group"},
});
inline constexpr std::size_t verdict_count = verdicts.size();
static_assert(verdict_count == static_cast<std::size_t>(Verdict::address) + 1);

constexpr std::size_t index_of(Verdict verdict) { return static_cast<std::size_t>(verdict); }
constexpr std::string_view name_of(Verdict verdict) { return verdicts[index_of(verdict)].name; }
/// Whether something is wrong with it, or with this node's idea of its group.
constexpr bool is_refusal(Verdict verdict) { return verdict >= Verdict::not_uadp; }

}  // namespace takt::wire
