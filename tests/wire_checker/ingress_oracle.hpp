// SPDX-License-Identifier: Apache-2.0
// What a bridge must do to a frame that comes in (IEEE 802.1Q 8.6.5, 8.6.11; MEF 10.3): the standards' pseudo code,
// word by word, with tables searched from the top. Elimination of copies (FRER) is told from outside.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "models/ingress/ingress_config.hpp"
#include "sim/time.hpp"
#include "tests/wire_checker/list_machine.hpp"

namespace takt::wire_checker {

class IngressOracle {
 public:
  struct Verdict {
    std::optional<models::DropReason> drop;
    std::optional<models::Priority> ipv;
    std::optional<Ps> eligible;
  };

  IngressOracle(const models::IngressConfig& config, std::uint32_t first_group);

  /// Which stream and which member of it; none: 0xFFFF'FFFF.
  struct Found {
    std::uint32_t stream = none;
    std::optional<std::uint16_t> member;
  };
  static constexpr std::uint32_t none = 0xFFFF'FFFF;
  Found identify(const models::Frame& frame) const;
  /// The recovery of the stream to which the frame belongs, or null: then no copies are taken out here.
  const models::StreamRecoveryConfig* recovery_of(const models::Frame& frame) const;

  /// A frame whose last bit (or header) came at `arrival` and that is no copy of an earlier one. Times ascend.
  Verdict pass(const models::Frame& frame, std::uint16_t port, Ps arrival);

 private:
  struct Gate {
    ListMachine machine;
    Ps account_of = never;  // the run of the entry that the octets are counted for
    std::uint32_t octets_left = 0;
    bool closed_for_good = false;
  };
  struct Meter {
    sim::int128 committed = 0;  // in 1 / (8 * 10^12) octet
    sim::int128 excess = 0;
    Ps last = 0;
    bool all_red = false;
  };
  struct Bucket {
    sim::int128 empty_time = 0;  // in 1 ps / rate
  };
  bool filter_accepts(std::size_t filter, std::uint32_t msdu);
  bool gate_passes(std::size_t gate, std::uint32_t msdu, Ps arrival, std::optional<models::Priority>& ipv);
  bool meter_passes(std::size_t meter, std::uint32_t length, bool drop_eligible, Ps arrival);
  std::optional<Ps> eligibility(std::size_t scheduler, const models::Frame& frame, std::uint32_t length,
                                std::uint16_t port, Ps arrival);

  const models::IngressConfig& config_;
  std::uint32_t first_group_;
  std::vector<bool> blocked_;  // by filter
  std::vector<Gate> gates_;
  std::vector<Meter> meters_;
  std::vector<Bucket> buckets_;
  std::vector<Ps> group_times_;
  std::map<std::pair<std::uint16_t, models::TrafficClass>, Ps> port_group_times_;
};

}  // namespace takt::wire_checker
