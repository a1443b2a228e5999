// SPDX-License-Identifier: Apache-2.0
#include "models/frer/sequence_recovery.hpp"

namespace takt::models {

SequenceRecovery::SequenceRecovery(const SequenceRecoveryConfig& config) : config_(config) {
  TAKT_CHECK(config.history_length >= 2, "a sequence history has at least 2 bits");
  TAKT_CHECK(config.history_length <= longest_history, "a sequence history has at most 1024 bits");
  reset();
}

SequenceRecovery::Decision SequenceRecovery::recover(std::optional<SequenceNumber> sequence) {
  if (!sequence) {
    ++counters_.tagless_packets;
    if (config_.take_no_sequence || config_.algorithm == RecoveryAlgorithm::match) return pass();
    ++counters_.discarded_packets;
    return {false, false};
  }
  if (accept_any_) return accept_any(*sequence);
  return config_.algorithm == RecoveryAlgorithm::vector ? vector_recovery(*sequence) : match_recovery(*sequence);
}

void SequenceRecovery::reset() {
  recovery_number_ = 65535;
  history_ = {};
  accept_any_ = true;
  empty_shifts_ = config_.history_length - 1;
  ++counters_.resets;
}

SequenceRecovery::Decision SequenceRecovery::vector_recovery(SequenceNumber sequence) {
  const auto length = static_cast<std::int32_t>(config_.history_length);
  // Modulo 65536, taken as a number from -32768 to 32767.
  const std::int32_t delta = static_cast<std::int16_t>(static_cast<std::uint16_t>(sequence - recovery_number_));
  if (delta >= length || delta <= -length) {
    ++counters_.rogue_packets;
    return discard();
  }
  if (delta <= 0) {
    if (seen(sequence)) return discard();
    set_seen(sequence, true);
    ++counters_.out_of_order_packets;
    return pass();
  }
  if (delta != 1) ++counters_.out_of_order_packets;
  for (std::int32_t i = 1; i < delta; ++i) shift(false);
  shift(true);
  return pass();
}

SequenceRecovery::Decision SequenceRecovery::match_recovery(SequenceNumber sequence) {
  if (sequence == recovery_number_) return discard();
  if (sequence != static_cast<SequenceNumber>(recovery_number_ + 1)) ++counters_.out_of_order_packets;
  recovery_number_ = sequence;
  return pass();
}

SequenceRecovery::Decision SequenceRecovery::accept_any(SequenceNumber sequence) {
  accept_any_ = false;
  recovery_number_ = sequence;
  set_seen(sequence, true);
  return pass();
}

SequenceRecovery::Decision SequenceRecovery::pass() {
  ++counters_.passed_packets;
  return {true, true};
}

SequenceRecovery::Decision SequenceRecovery::discard() {
  ++counters_.discarded_packets;
  return {false, config_.individual_recovery};
}

/// The history moves on by one number; the oldest one is lost if it has not been seen.
void SequenceRecovery::shift(bool is_seen) {
  ++recovery_number_;
  const auto leaving = static_cast<SequenceNumber>(recovery_number_ - config_.history_length);
  if (!seen(leaving)) {
    ++counters_.lost_packets;
    if (empty_shifts_ > 0) ++counters_.lost_at_start;
  }
  if (empty_shifts_ > 0) --empty_shifts_;
  set_seen(recovery_number_, is_seen);
}

}  // namespace takt::models
