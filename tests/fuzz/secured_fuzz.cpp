// SPDX-License-Identifier: Apache-2.0
// Any octets as a secured message, and sealed messages with some of their octets changed: nobody crashes, nothing is
// taken that the key has not signed, nothing is taken twice.
//
// The input: how the channel is set, then one operation after the other.
#include <cstdint>
#include <vector>

#include "security/secure_channel.hpp"

namespace {

using namespace takt;
using namespace takt::security;

class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
  bool is_empty() const { return left_ == 0; }
  std::uint8_t next() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }
  std::vector<std::byte> take(std::size_t count) {
    std::vector<std::byte> octets;
    for (; count > 0 && left_ > 0; --count) octets.push_back(static_cast<std::byte>(next()));
    return octets;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  const std::uint8_t kind = input.next();
  const auto policy = (kind & 1) != 0 ? MessagePolicy::aes256_ctr : MessagePolicy::aes128_ctr;
  const ChannelSettings settings{(kind & 2) != 0 ? MessageMode::sign : MessageMode::sign_and_encrypt,
                                 static_cast<Nonces>(kind / 4 % 3), 1, 1};
  const KeySchedule schedule{(kind & 64) != 0 ? 0xFFFF'FFFEU : 1U, 0, 100};
  std::vector<StoredWindow> windows(16);
  std::vector<StoredWindow> unused(16);
  SecureChannel receiver(settings, KeyRing(policy, schedule, std::make_unique<DerivedKeys>(policy, "cell", Secret(32))),
                         ReplayMemory(windows));
  SecureChannel sender(settings, KeyRing(policy, schedule, std::make_unique<DerivedKeys>(policy, "cell", Secret(32))),
                       ReplayMemory(unused));
  std::int64_t now = 0;
  for (int operations = 0; operations < 40 && !input.is_empty(); ++operations) {
    const std::uint8_t operation = input.next();
    now += operation / 4;
    const std::vector<std::byte> octets = input.take(input.next());
    const Octets sealed = sender.seal(octets, now);
    if (operation % 4 == 0 || sealed.empty()) {
      TAKT_CHECK(receiver.open(octets, now).verdict != SecurityVerdict::good, "who has no key is not heard");
      continue;
    }
    std::vector<std::byte> copy(sealed.begin(), sealed.end());
    bool is_changed = false;
    for (int changes = operation % 4 - 1; changes > 0; --changes) {
      const std::size_t at = (input.next() + 256U * input.next()) % copy.size();
      const auto mask = static_cast<std::byte>(input.next());
      copy[at] ^= mask;
    }
    is_changed = !std::equal(copy.begin(), copy.end(), sealed.begin());
    const bool is_taken = receiver.open(copy, now).verdict == SecurityVerdict::good;
    TAKT_CHECK(!is_changed || !is_taken, "what was changed is not taken");
    if (is_taken) TAKT_CHECK(receiver.open(copy, now).verdict != SecurityVerdict::good, "nothing is taken twice");
  }
  return 0;
}
