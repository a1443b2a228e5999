// SPDX-License-Identifier: Apache-2.0
// The peer-to-peer delay mechanism of a port, IEEE 802.1AS-2020 11.2.19 and 11.2.20: MDPdelayReq and MDPdelayResp.
#pragma once

#include <optional>

#include "models/gptp/message_interval.hpp"
#include "models/gptp/neighbor_rate_ratio.hpp"
#include "models/gptp/output.hpp"
#include "sim/check.hpp"

namespace takt::models::gptp {

/// Why a port is not asCapable (11.2.2). The last one is of a domain, see Capability; all others are of the link.
enum class NotCapable : std::uint8_t {
  none,  ///< it is
  link_down,
  unmeasured,      ///< too few exchanges so far
  no_answer,       ///< the neighbour leaves more requests unanswered than are allowed
  delay_too_long,  ///< beyond meanLinkDelayThresh
  delay_too_short,
  several_answers,      ///< to one request: something between that does not speak gPTP
  own_answer,           ///< the port hears itself
  neighbor_not_capable  ///< no gPTP-capable TLV from the neighbour
};

struct LinkDelayConfig {
  int log_pdelay_req_interval = 0;             // 1 s
  std::size_t neighbor_rate_ratio_window = 8;  // exchanges
  bool compensate_drift = false;               // see NeighborRateRatio
  std::size_t average_over = 1;                // meanLinkDelay is averaged over about that many exchanges
  std::optional<sim::Duration> mean_link_delay_thresh = sim::Duration::from_ps(800'000);
  sim::Duration lowest_link_delay = sim::Duration::from_ps(-20'000'000'000);
  int allowed_lost_responses = 9;
  int allowed_faults = 9;
  sim::Duration delay_asymmetry = {};  // positive: from the neighbour takes longer
  MajorSdoId major_sdo_id = MajorSdoId::gptp;
};

/// Both sides at one port: asks the neighbour for its delay, and answers when asked. All domains of a node share it.
/// `now` and all LocalTimes are of the free-running clock. Outputs are appended.
class LinkDelay {
 public:
  LinkDelay(const LinkDelayConfig& config, PortIdentity self);

  void link_up(sim::LocalTime now, Outputs& outputs);
  void link_down(Outputs& outputs);
  /// The neighbour asks for another interval of Pdelay_Req, see MessageInterval. What has been measured stays.
  void interval_requested(std::int8_t log_interval, sim::LocalTime now, Outputs& outputs);
  /// The timer pdelay_interval.
  void interval_elapsed(sim::LocalTime now, Outputs& outputs);
  void received(const PdelayReq& request, sim::LocalTime ingress, Outputs& outputs);
  void received(const PdelayResp& response, sim::LocalTime ingress, Outputs& outputs);
  void received(const PdelayRespFollowUp& follow_up, Outputs& outputs);
  void transmitted(const EgressReport& report, Outputs& outputs);

  bool as_capable() const { return obstacle_ == NotCapable::none; }
  /// What keeps the link from being asCapable.
  NotCapable obstacle() const { return obstacle_; }
  bool is_measured() const { return measurements_ > 0; }
  /// In the neighbour's time base, as 802.1AS has it.
  sim::Duration mean_link_delay() const { return mean_link_delay_; }
  sim::Duration delay_asymmetry() const { return config_.delay_asymmetry; }
  /// Beyond which it is too long; nothing: it never is.
  const std::optional<sim::Duration>& threshold() const { return config_.mean_link_delay_thresh; }
  /// one() while it is not known.
  ClockRate neighbor_rate_ratio(sim::LocalTime at) const {
    return ratio_.is_valid() ? ratio_.ratio_at(at) : ClockRate::one();
  }
  RateOffset neighbor_rate_ratio_drift() const { return ratio_.drift_per_second(); }
  int lost_responses() const { return lost_responses_; }

 private:
  struct Request {
    std::uint16_t sequence_id = 0;
    bool pending = false;
    bool faulty = false;                         // answered more than once
    std::optional<sim::LocalTime> egress = {};   // t1
    std::optional<sim::LocalTime> ingress = {};  // t4
    sim::PtpTime receipt = {};                   // t2
    std::optional<sim::PtpTime> response = {};   // t3
    PortIdentity responder = {};
  };
  struct Answer {
    std::uint16_t sequence_id = 0;
    PortIdentity requesting_port = {};
  };

  void send_request(sim::LocalTime now, Outputs& outputs);
  void evaluate(Outputs& outputs);
  void measured(sim::Duration delay, Outputs& outputs);
  void fault(Outputs& outputs);
  void set_obstacle(NotCapable obstacle, Outputs& outputs);
  Header header(std::uint16_t sequence_id) const;

  LinkDelayConfig config_;
  PortIdentity self_;
  MessageInterval interval_;
  NeighborRateRatio ratio_;
  bool up_ = false;
  NotCapable obstacle_ = NotCapable::link_down;
  int lost_responses_ = 0;
  int faults_ = 0;
  std::size_t measurements_ = 0;
  sim::Duration mean_link_delay_;
  std::uint16_t next_sequence_ = 0;
  sim::LocalTime next_request_;
  Request request_;
  std::optional<Answer> answer_;
};

}  // namespace takt::models::gptp
