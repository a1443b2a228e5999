// SPDX-License-Identifier: Apache-2.0
#include "models/gptp/link_delay.hpp"

#include <algorithm>

namespace takt::models::gptp {
namespace {

// No exchange takes longer; what a faulty neighbour claims beyond that is not computed with.
constexpr sim::Duration longest_exchange = sim::Duration::from_ps(10'000'000'000'000);

bool plausible(sim::Duration d) { return d >= sim::Duration() && d <= longest_exchange; }

/// Timestamps of Pdelay messages are times of the sender's own clock, whole nanoseconds with the rest in the
/// correction.
Timestamp whole(sim::LocalTime time) { return Timestamp::floor_of(sim::PtpTime::from_ps(time.ps())); }
Correction rest(sim::LocalTime time) {
  return Correction::of(sim::Duration::from_ps(time.ps()) - whole(time).time().since_start());
}

std::optional<sim::PtpTime> joined(const Timestamp& time, Correction correction) {
  if (!time.in_range() || !correction.in_range()) return std::nullopt;
  return time.time() + correction.duration();
}

}  // namespace

LinkDelay::LinkDelay(const LinkDelayConfig& config, PortIdentity self)
    : config_(config),
      self_(self),
      interval_(config.log_pdelay_req_interval, 0),
      ratio_(config.neighbor_rate_ratio_window, config.compensate_drift) {
  TAKT_CHECK(config.average_over >= 1, "an average over something");
}

void LinkDelay::link_up(sim::LocalTime now, Outputs& outputs) {
  up_ = true;
  lost_responses_ = 0;
  faults_ = 0;
  measurements_ = 0;
  ratio_.reset();
  request_.pending = false;
  answer_.reset();
  interval_.reset();
  if (!as_capable()) obstacle_ = NotCapable::unmeasured;
  next_request_ = now;
  send_request(now, outputs);
}

void LinkDelay::link_down(Outputs& outputs) {
  up_ = false;
  outputs.push_back(CancelTimer{{TimerId::no_instance, self_.port, TimerPurpose::pdelay_interval}});
  set_obstacle(NotCapable::link_down, outputs);
}

void LinkDelay::interval_requested(std::int8_t log_interval, sim::LocalTime now, Outputs& outputs) {
  if (!up_) return;
  const bool was_stopped = interval_.is_stopped();
  if (!interval_.request(log_interval)) return;
  const TimerId timer{TimerId::no_instance, self_.port, TimerPurpose::pdelay_interval};
  if (interval_.is_stopped()) {
    outputs.push_back(CancelTimer{timer});
    return;
  }
  const sim::LocalTime soonest = now + interval_.length();
  next_request_ = was_stopped ? soonest : std::min(next_request_, soonest);
  outputs.push_back(ArmTimer{timer, next_request_});
}

void LinkDelay::interval_elapsed(sim::LocalTime now, Outputs& outputs) {
  if (!up_) return;
  if (request_.pending) {
    request_.pending = false;
    if (++lost_responses_ > config_.allowed_lost_responses) {
      ratio_.reset();
      measurements_ = 0;
      set_obstacle(NotCapable::no_answer, outputs);
    }
  }
  send_request(now, outputs);
}

void LinkDelay::send_request(sim::LocalTime now, Outputs& outputs) {
  if (!request_.faulty) faults_ = 0;  // only faults in a row count
  request_ = {.sequence_id = next_sequence_++, .pending = true};
  outputs.push_back(SendMessage{self_.port, PdelayReq{header(request_.sequence_id)}});
  next_request_ = std::max(next_request_ + interval_.sent(), now);
  outputs.push_back(ArmTimer{{TimerId::no_instance, self_.port, TimerPurpose::pdelay_interval}, next_request_});
}

void LinkDelay::received(const PdelayReq& request, sim::LocalTime ingress, Outputs& outputs) {
  if (!up_ || request.header.source.clock == self_.clock) return;
  answer_ = {request.header.sequence_id, request.header.source};
  PdelayResp response{header(request.header.sequence_id), whole(ingress), request.header.source};
  response.header.correction = rest(ingress);
  outputs.push_back(SendMessage{self_.port, response});
}

void LinkDelay::transmitted(const EgressReport& report, Outputs& outputs) {
  if (report.type == MessageType::pdelay_req) {
    if (!request_.pending || report.sequence_id != request_.sequence_id) return;
    request_.egress = report.egress;
    evaluate(outputs);
  } else if (report.type == MessageType::pdelay_resp && answer_ && report.sequence_id == answer_->sequence_id) {
    PdelayRespFollowUp follow_up{header(answer_->sequence_id), whole(report.egress), answer_->requesting_port};
    follow_up.header.correction = rest(report.egress);
    answer_.reset();
    outputs.push_back(SendMessage{self_.port, follow_up});
  }
}

void LinkDelay::received(const PdelayResp& response, sim::LocalTime ingress, Outputs& outputs) {
  if (!up_ || response.requesting_port != self_ || response.header.sequence_id != request_.sequence_id) return;
  if (response.header.source.clock == self_.clock) return set_obstacle(NotCapable::own_answer, outputs);
  if (request_.ingress) return fault(outputs);  // a second answer
  const std::optional<sim::PtpTime> receipt = joined(response.request_receipt, response.header.correction);
  if (!request_.pending || !receipt) return;
  request_.ingress = ingress;
  request_.receipt = *receipt;
  request_.responder = response.header.source;
}

void LinkDelay::received(const PdelayRespFollowUp& follow_up, Outputs& outputs) {
  if (!up_ || !request_.pending || !request_.ingress || request_.response) return;
  if (follow_up.requesting_port != self_ || follow_up.header.sequence_id != request_.sequence_id) return;
  if (follow_up.header.source != request_.responder) return fault(outputs);
  request_.response = joined(follow_up.response_origin, follow_up.header.correction);
  evaluate(outputs);
}

// All four timestamps: D = (r (t4 - t1) - (t3 - t2)) / 2.
void LinkDelay::evaluate(Outputs& outputs) {
  if (!request_.egress || !request_.ingress || !request_.response) return;
  const sim::Duration round_trip = *request_.ingress - *request_.egress;
  const sim::Duration turnaround = *request_.response - request_.receipt;
  if (!plausible(round_trip) || !plausible(turnaround)) return;  // counts as lost when the interval ends
  request_.pending = false;
  lost_responses_ = 0;
  ratio_.add(*request_.response, *request_.ingress);
  const ClockRate ratio = neighbor_rate_ratio(*request_.ingress);
  measured((ratio.times(round_trip) - turnaround) / 2, outputs);
}

void LinkDelay::measured(sim::Duration delay, Outputs& outputs) {
  if (!ratio_.is_valid()) return;
  measurements_ = std::min(measurements_ + 1, config_.average_over);
  if (measurements_ == 1)
    mean_link_delay_ = delay;
  else
    mean_link_delay_ += (delay - mean_link_delay_) / static_cast<std::int64_t>(measurements_);
  if (faults_ > config_.allowed_faults) return set_obstacle(NotCapable::several_answers, outputs);
  if (config_.mean_link_delay_thresh && mean_link_delay_ > *config_.mean_link_delay_thresh)
    return set_obstacle(NotCapable::delay_too_long, outputs);
  set_obstacle(mean_link_delay_ < config_.lowest_link_delay ? NotCapable::delay_too_short : NotCapable::none, outputs);
}

// Several answers to a request: there is something between that does not speak gPTP.
void LinkDelay::fault(Outputs& outputs) {
  if (!request_.faulty) ++faults_;
  request_.faulty = true;
  if (faults_ > config_.allowed_faults) set_obstacle(NotCapable::several_answers, outputs);
}

void LinkDelay::set_obstacle(NotCapable obstacle, Outputs& outputs) {
  const bool was_capable = as_capable();
  obstacle_ = obstacle;
  if (as_capable() != was_capable) outputs.push_back(AsCapableChange{self_.port, as_capable()});
}

Header LinkDelay::header(std::uint16_t sequence_id) const {
  Header header;
  header.major_sdo_id = config_.major_sdo_id;
  header.source = self_;
  header.sequence_id = sequence_id;
  header.log_message_interval = interval_.announced();
  return header;
}

}  // namespace takt::models::gptp
