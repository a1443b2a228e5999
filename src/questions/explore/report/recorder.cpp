// SPDX-License-Identifier: Apache-2.0
#include "explore/report/recorder.hpp"

#include "sim/check.hpp"

namespace takt::explore {
namespace {

constexpr std::uint32_t repetitions = 1U << 16;  ///< room for those in the counts of a key
constexpr std::size_t nowhere = ~std::size_t{0};

}  // namespace

Recorder::Recorder(const Query& query, const Wiring& wiring)
    : query_(query),
      wiring_(wiring),
      signers_(query.slaves + 1U),
      said_(query.slaves + 1U),
      standing_(wiring.size(), nowhere),
      last_(query.slaves + 1U),
      windows_(wiring.size()) {
  for (Windows& each : windows_) each.stored.resize(4);
}

std::size_t Recorder::say(std::size_t channel, Said said) {
  const std::size_t from = wiring_.sender(channel);
  Signer& signer = signers_[from];
  std::vector<Said>& all = said_[from];
  last_[from][said.word.incarnation] = said.sequence;
  if (all.empty() || all.back().word != said.word || all.back().freshness.token != signer.token ||
      all.back().freshness.life != signer.life) {
    said.freshness = {signer.token, signer.count + 1, signer.life};
    signer.count += repetitions;
    all.push_back(said);
  } else {
    all.back().sequence = said.sequence;
  }
  return standing_[channel] = all.size() - 1;
}

void Recorder::change_key(std::size_t who) {
  signers_[who].token = security::next_token(signers_[who].token);
  signers_[who].count = 0;
}

void Recorder::restart(std::size_t who) {
  ++signers_[who].life;
  signers_[who].count = 0;
}

std::uint16_t Recorder::sequence(std::size_t channel, std::size_t back) const {
  const std::size_t from = wiring_.sender(channel);
  const Said& chosen = said(channel, back);
  if (query_.is_signed) return chosen.sequence;
  const std::size_t standing = standing_[channel];
  if (standing != nowhere && said_[from][standing].word.incarnation == chosen.word.incarnation)
    return said_[from][standing].sequence;
  return last_[from].at(chosen.word.incarnation);
}

bool Recorder::take(std::size_t channel, std::size_t place) {
  if (!query_.is_signed) return true;
  const Said& message = said_at(channel, place);
  const std::uint32_t now = signers_[wiring_.receiver(channel)].token;
  const std::uint32_t token = message.freshness.token;
  if (token != now && security::next_token(token) != now && token != security::next_token(now)) return false;
  Windows& windows = windows_[channel];
  security::Freshness freshness = message.freshness;
  freshness.number += windows.used[place]++;
  return security::ReplayMemory(windows.stored).take({wiring_.sender(channel) + 1U, 1, 0}, freshness);
}

}  // namespace takt::explore
