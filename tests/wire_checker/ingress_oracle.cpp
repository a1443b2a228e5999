// SPDX-License-Identifier: Apache-2.0
#include "tests/wire_checker/ingress_oracle.hpp"

#include <algorithm>

#include "models/ethernet/sizes.hpp"

namespace takt::wire_checker {
namespace {

constexpr sim::int128 bit = 1'000'000'000'000;    // at CIR, in 1 ps / CIR
constexpr sim::int128 octet_of_tokens = 8 * bit;  // in 1 / (8 * 10^12) octet

bool matches(const models::AddressIdentification& entry, const models::Frame& frame) {
  if (entry.destination != frame.destination) return false;
  if (!frame.tagged || frame.vlan == 0) return entry.tagged != models::Tagged::tagged;
  return entry.tagged != models::Tagged::priority && (entry.vlan == 0 || entry.vlan == frame.vlan);
}

}  // namespace

IngressOracle::IngressOracle(const models::IngressConfig& config, std::uint32_t first_group)
    : config_(config),
      first_group_(first_group),
      blocked_(config.stream_filters.size(), false),
      group_times_(config.ats_groups.size(), 0) {
  for (const models::StreamGateConfig& gate : config.stream_gates) {
    gates_.push_back(
        {ListMachine(ListEntry{
             {}, gate.admin_gate_open ? models::all_gates_open : models::GateStates{0}, 0, gate.admin_ipv, {}}),
         never, 0, false});
    if (!gate.admin_control_list.empty()) gates_.back().machine.start_with(list_config_of(gate), gate.is_running);
  }
  for (const models::NamedFlowMeterConfig& meter : config.flow_meters)
    meters_.push_back({octet_of_tokens * meter.meter.committed_burst_size.count,
                       octet_of_tokens * meter.meter.excess_burst_size.count, 0, false});
  // The bucket is full at time 0: BucketEmptyTime = -(CBS / CIR).
  for (const models::AtsSchedulerConfig& scheduler : config.ats_schedulers)
    buckets_.push_back({-(bit * 8 * scheduler.committed_burst_size.count)});
}

IngressOracle::Found IngressOracle::identify(const models::Frame& frame) const {
  models::StreamHeader header;
  header.destination = models::mac_address_of(frame.destination, first_group_);
  header.source = models::mac_address_of(frame.source, first_group_);
  header.vlan = frame.vlan;
  header.tagged = frame.tagged;
  header.priority = frame.priority;
  for (const models::StreamIdentityEntry& entry : config_.stream_identity_table) {
    bool found = false;
    if (const auto* const address = std::get_if<models::AddressIdentification>(&entry.function))
      found = matches(*address, frame);
    if (const auto* const source = std::get_if<models::SourceMacAndVlanIdentification>(&entry.function))
      found = identifies(*source, header);
    if (const auto* const mask = std::get_if<models::MaskAndMatchIdentification>(&entry.function))
      found = identifies(*mask, header);
    if (found) return {entry.stream.value, entry.member};
  }
  return {};
}

const models::StreamRecoveryConfig* IngressOracle::recovery_of(const models::Frame& frame) const {
  const Found found = identify(frame);
  if (found.stream == none || (!found.member && !frame.r_tagged)) return nullptr;
  for (const models::IngressRecovery& recovery : config_.recoveries)
    if (recovery.stream.value == found.stream) return &recovery.recovery;
  return nullptr;
}

IngressOracle::Verdict IngressOracle::pass(const models::Frame& frame, std::uint16_t port, Ps arrival) {
  const Found found = identify(frame);
  const models::StreamRecoveryConfig* const recovery = recovery_of(frame);
  const bool r_tagged = frame.r_tagged && (recovery == nullptr || recovery->keep_r_tag);
  const std::uint32_t msdu = frame.msdu + (r_tagged ? models::r_tag.count : 0u);
  const std::uint32_t length = models::frame_length(models::Octets{frame.msdu}, frame.tagged, r_tagged).count;

  for (std::size_t f = 0; f < config_.stream_filters.size(); ++f) {
    const models::StreamFilterConfig& filter = config_.stream_filters[f];
    if (filter.stream_handle && filter.stream_handle->value != found.stream) continue;
    if (filter.priority && *filter.priority != frame.priority) continue;
    Verdict verdict;
    if (!filter_accepts(f, msdu)) return {models::DropReason::stream_max_sdu, {}, {}};
    if (!filter.stream_gate.is_none() && !gate_passes(filter.stream_gate.value, msdu, arrival, verdict.ipv))
      return {models::DropReason::stream_gate, {}, {}};
    if (!filter.flow_meter.is_none() && !meter_passes(filter.flow_meter.value, length, frame.drop_eligible, arrival))
      return {models::DropReason::flow_meter, {}, {}};
    if (filter.ats_scheduler.is_none()) {
      if (verdict.ipv) verdict.eligible = arrival;  // a frame that nothing marks is eligible from the beginning of time
      return verdict;
    }
    verdict.eligible = eligibility(filter.ats_scheduler.value, frame, length, port, arrival);
    if (!verdict.eligible) verdict.drop = models::DropReason::residence_time;
    return verdict;
  }
  return {};
}

bool IngressOracle::filter_accepts(std::size_t f, std::uint32_t msdu) {
  const models::StreamFilterConfig& filter = config_.stream_filters[f];
  const bool oversize = filter.maximum_sdu_size.count != 0 && msdu > filter.maximum_sdu_size.count;
  if (oversize && filter.stream_blocked_due_to_oversize_frame_enable) blocked_[f] = true;
  return !oversize && !blocked_[f];
}

bool IngressOracle::gate_passes(std::size_t g, std::uint32_t msdu, Ps arrival, std::optional<models::Priority>& ipv) {
  const models::StreamGateConfig& config = config_.stream_gates[g];
  Gate& gate = gates_[g];
  gate.machine.run_to(arrival);
  const ListEntry& entry = gate.machine.entry();
  if (gate.closed_for_good || entry.states == 0) {
    gate.closed_for_good = gate.closed_for_good || config.closed_due_to_invalid_rx_enable;
    return false;
  }
  if (entry.octets) {
    if (gate.account_of != gate.machine.executed_at()) {
      gate.account_of = gate.machine.executed_at();
      gate.octets_left = *entry.octets;
    }
    if (msdu > gate.octets_left) {
      gate.closed_for_good = config.closed_due_to_octets_exceeded_enable;
      return false;
    }
    gate.octets_left -= msdu;
  }
  ipv = entry.ipv;
  return true;
}

bool IngressOracle::meter_passes(std::size_t m, std::uint32_t length, bool drop_eligible, Ps arrival) {
  const models::FlowMeterConfig& config = config_.flow_meters[m].meter;
  Meter& meter = meters_[m];
  const Ps elapsed = arrival - meter.last;
  meter.last = arrival;
  const sim::int128 committed_burst = octet_of_tokens * config.committed_burst_size.count;
  const sim::int128 excess_burst = octet_of_tokens * config.excess_burst_size.count;
  const sim::int128 filled =
      meter.committed +
      sim::int128{elapsed} * static_cast<std::int64_t>(config.committed_information_rate.bits_per_second);
  const sim::int128 overflow = std::max<sim::int128>(0, filled - committed_burst);
  meter.committed = std::min(committed_burst, filled);
  meter.excess = std::min(
      excess_burst,
      meter.excess + sim::int128{elapsed} * static_cast<std::int64_t>(config.excess_information_rate.bits_per_second) +
          (config.coupling_flag ? overflow : 0));
  if (meter.all_red) return false;
  const bool is_green = config.color_mode == models::ColorMode::color_blind || !drop_eligible;
  const sim::int128 tokens = octet_of_tokens * length;
  if (is_green && tokens <= meter.committed) {
    meter.committed -= tokens;
    return true;
  }
  const bool is_yellow = tokens <= meter.excess;
  if (is_yellow) meter.excess -= tokens;
  const bool passes = is_yellow && !config.drop_on_yellow;
  if (!passes) meter.all_red = config.mark_all_frames_red_enable;
  return passes;
}

/// ProcessFrame (8.6.11.3). An eligibility time that is not a whole picosecond is rounded up; the bucket goes on with
/// the exact one.
std::optional<Ps> IngressOracle::eligibility(std::size_t s, const models::Frame& frame, std::uint32_t length,
                                             std::uint16_t port, Ps arrival) {
  const models::AtsSchedulerConfig& config = config_.ats_schedulers[s];
  const bool has_group = !config.group.is_none();
  const Ps longest =
      (has_group ? config_.ats_groups[config.group.value].maximum_residence_time : config_.maximum_residence_time).ps();
  Ps& group_time = has_group ? group_times_[config.group.value]
                             : port_group_times_[{port, config_.traffic_class_of_priority[frame.priority]}];
  const auto rate = static_cast<std::int64_t>(config.committed_information_rate.bits_per_second);

  const sim::int128 length_recovery = bit * 8 * (length + (config.media_overhead ? 20 : 0));
  const sim::int128 empty_to_full = bit * 8 * config.committed_burst_size.count;
  const sim::int128 scheduler_eligibility = buckets_[s].empty_time + length_recovery;
  const sim::int128 bucket_full = buckets_[s].empty_time + empty_to_full;
  const sim::int128 exact = std::max(sim::int128{std::max(arrival, group_time)} * rate, scheduler_eligibility);
  const Ps eligible = static_cast<Ps>(exact / rate + (exact % rate > 0 ? 1 : 0));
  if (eligible - arrival > longest) return std::nullopt;
  group_time = eligible;
  buckets_[s].empty_time = exact < bucket_full ? scheduler_eligibility : scheduler_eligibility + (exact - bucket_full);
  return eligible;
}

}  // namespace takt::wire_checker
