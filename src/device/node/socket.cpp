// SPDX-License-Identifier: Apache-2.0
#include "node/socket.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace takt::node {

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}

FileDescriptor::~FileDescriptor() {
  if (number_ >= 0) ::close(number_);
}

std::string to_text(const SenderAddress& address) {
  const auto& o = address.octets;
  switch (address.kind) {
    case SenderAddress::Kind::udp:
      return fmt::format("{}.{}.{}.{}:{}", o[0], o[1], o[2], o[3], o[4] << 8 | o[5]);
    case SenderAddress::Kind::ethernet:
      return fmt::format("{:02x}:{:02x}:{:02x}:{:02x}:{:02x}:{:02x}", o[0], o[1], o[2], o[3], o[4], o[5]);
    case SenderAddress::Kind::unknown:
      break;
  }
  return "?";
}

uadp::Octets Socket::next() {
  constexpr int most_passed_over = 256;
  for (int i = 0; i < most_passed_over; ++i) {
    const auto arrival = take();
    if (!arrival) return {};
    if (arrival->verdict == wire::Verdict::taken) return arrival->message;
  }
  return {};
}

std::string what_failed(const std::string& what) { return what + ": " + std::strerror(errno); }

}  // namespace takt::node
