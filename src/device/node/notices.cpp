// SPDX-License-Identifier: Apache-2.0
#include "node/notices.hpp"

namespace takt::node {
namespace {

constexpr std::int64_t last_wait_ns = 500'000'000;

/// Printable ASCII as it is; other octets as \xNN.
std::string plain(std::string_view text) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string line;
  for (const char each : text) {
    const auto octet = static_cast<unsigned char>(each);
    if (octet >= 0x20 && octet < 0x7f)
      line += each;
    else
      line += {'\\', 'x', digits[octet >> 4], digits[octet & 15]};
  }
  return line;
}

}  // namespace

std::string cut_text(std::string_view text, std::size_t most_octets) {
  return text.size() <= most_octets ? std::string(text) : std::string(text.substr(0, most_octets)) + "...";
}

void Notices::say(std::string_view text) { page("takt: " + plain(text) + "\n"); }

void Notices::page(std::string_view lines) {
  const std::lock_guard lock(mutex_);
  log_.write(lines);
}

void Notices::flush() {
  const std::lock_guard lock(mutex_);
  log_.flush();
}

void Notices::finish(std::string_view lines) {
  const std::lock_guard lock(mutex_);
  log_.finish(lines, last_wait_ns);
}

}  // namespace takt::node
