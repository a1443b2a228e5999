// SPDX-License-Identifier: Apache-2.0
#include "security/random.hpp"

#include <openssl/rand.h>

#include <stdexcept>

namespace takt::security {

void SystemRandom::fill(std::span<std::byte> octets) {
  if (octets.empty()) return;
  if (RAND_bytes(reinterpret_cast<unsigned char*>(octets.data()), static_cast<int>(octets.size())) != 1)
    throw std::runtime_error("the operating system gives no random octets");
}

}  // namespace takt::security
