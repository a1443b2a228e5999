// SPDX-License-Identifier: Apache-2.0
// TimingProfile: when writers and readers ask, answer and repeat. The standard leaves it open (DDSI-RTPS 2.5, 8.4);
// implementations differ.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "sim/time.hpp"

namespace takt::dds {

struct TimingProfile {
  static constexpr sim::Duration off = sim::Duration::max();

  std::string_view name;
  // Of reliable writers
  sim::Duration heartbeat_period;             ///< while changes are not acknowledged
  sim::Duration heartbeat_period_max;         ///< it doubles up to this ...
  std::uint32_t heartbeat_backoff_after = 0;  ///< ... after so many since the last write
  sim::Duration initial_heartbeat_delay;      ///< after the match
  sim::Duration
      piggyback_interval;  ///< least time between HEARTBEATs that travel with samples; 0: with each; off: with none
  sim::Duration piggyback_answer_interval;  ///< least time between those of them that ask for an answer; 0: each asks
  bool piggyback_when_full = false;         ///< with the sample that fills the history, whatever the interval
  sim::Duration nack_response_delay;        ///< from an ACKNACK to what it asks for
  sim::Duration nack_suppression;           ///< what was sent so lately is not sent again
  bool heartbeat_after_resend = false;      ///< with what was asked for
  bool greets_by_heartbeat = false;         ///< tells a new reader at once what there is, be it nothing, and sends past
                                            ///< samples when asked; or else sends them at once
  // Of reliable readers
  sim::Duration heartbeat_response_delay;  ///< from a HEARTBEAT that asks to the ACKNACK
  sim::Duration nack_delay_when_final;     ///< the same if the HEARTBEAT asks for no answer but something is missing
  sim::Duration heartbeat_suppression;     ///< HEARTBEATs that follow so closely are passed over
  sim::Duration ack_spacing;               ///< between ACKNACKs that say the same
  sim::Duration initial_acknack_delay;     ///< after the match; off: none
  sim::Duration nack_repeat;               ///< asks again if nothing came; off: the next HEARTBEAT is waited for
  // Of writers with a liveliness lease
  std::uint32_t liveliness_percent = 70;  ///< of the shortest lease, between participant messages
};

namespace timing {
using namespace sim::literals;
/// The examples of the standard's text.
inline constexpr TimingProfile rtps{.name = "rtps",
                                    .heartbeat_period = 1_s,
                                    .heartbeat_period_max = 1_s,
                                    .heartbeat_backoff_after = 0,
                                    .initial_heartbeat_delay = 0_ms,
                                    .piggyback_interval = TimingProfile::off,
                                    .piggyback_answer_interval = 0_ms,
                                    .piggyback_when_full = true,
                                    .nack_response_delay = 200_ms,
                                    .nack_suppression = 0_ms,
                                    .heartbeat_after_resend = false,
                                    .greets_by_heartbeat = false,
                                    .heartbeat_response_delay = 500_ms,
                                    .nack_delay_when_final = 500_ms,
                                    .heartbeat_suppression = 0_ms,
                                    .ack_spacing = 0_ms,
                                    .initial_acknack_delay = TimingProfile::off,
                                    .nack_repeat = TimingProfile::off};
/// eProsima Fast DDS.
inline constexpr TimingProfile fast_dds{.name = "fast-dds",
                                        .heartbeat_period = 3_s,
                                        .heartbeat_period_max = 3_s,
                                        .heartbeat_backoff_after = 0,
                                        .initial_heartbeat_delay = 12_ms,
                                        .piggyback_interval = TimingProfile::off,
                                        .piggyback_answer_interval = 0_ms,
                                        .piggyback_when_full = true,
                                        .nack_response_delay = 5_ms,
                                        .nack_suppression = 0_ms,
                                        .heartbeat_after_resend = false,
                                        .greets_by_heartbeat = false,
                                        .heartbeat_response_delay = 5_ms,
                                        .nack_delay_when_final = 5_ms,
                                        .heartbeat_suppression = 0_ms,
                                        .ack_spacing = 0_ms,
                                        .initial_acknack_delay = 70_ms,
                                        .nack_repeat = TimingProfile::off};
/// Eclipse Cyclone DDS.
inline constexpr TimingProfile cyclone{.name = "cyclone",
                                       .heartbeat_period = 100_ms,
                                       .heartbeat_period_max = 8_s,
                                       .heartbeat_backoff_after = 5,
                                       .initial_heartbeat_delay = 0_ms,
                                       .piggyback_interval = 5_ms,
                                       .piggyback_answer_interval = 20_ms,
                                       .piggyback_when_full = true,
                                       .nack_response_delay = 0_ms,
                                       .nack_suppression = 0_ms,
                                       .heartbeat_after_resend = true,
                                       .greets_by_heartbeat = true,
                                       .heartbeat_response_delay = 0_ms,
                                       .nack_delay_when_final = 100_ms,
                                       .heartbeat_suppression = 0_ms,
                                       .ack_spacing = 10_ms,
                                       .initial_acknack_delay = 10_ms,
                                       .nack_repeat = 3_s};
inline constexpr std::array all{rtps, fast_dds, cyclone};
}  // namespace timing

}  // namespace takt::dds
