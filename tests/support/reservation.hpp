// SPDX-License-Identifier: Apache-2.0
// Domains and ports that belong to one test program, so that tests at the same time do not meet. reservation.py gives
// the same to tests in Python.
//
// What is reserved is held by a UDP port on the loopback interface that nobody else uses. All are below those that the
// system gives to others (32768).
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <stdexcept>

namespace takt::testing {

class Reservation {
 public:
  /// A DDS domain from 1 to 80. Participants would have to be a hundred to use its holder's port.
  static Reservation domain() { return {domains, 7400 + 250 + 10 + 2 * 100, 250, 1, 1}; }
  /// `ports_in_block` UDP ports from number() on.
  static Reservation ports() {
    return {blocks, 28'000 + ports_in_block, ports_in_block + 1, 28'000, ports_in_block + 1};
  }
  static constexpr int ports_in_block = 19;

  Reservation(const Reservation&) = delete;
  Reservation& operator=(const Reservation&) = delete;
  ~Reservation() { ::close(socket_); }
  std::uint16_t number() const { return static_cast<std::uint16_t>(number_); }

 private:
  static constexpr int domains = 80;
  static constexpr int blocks = 200;

  Reservation(int count, int first_holder, int holder_step, int first_number, int number_step) {
    for (int i = 0; i < count; ++i) {
      const int candidate = (::getpid() + i) % count;
      number_ = first_number + candidate * number_step;
      if (hold(first_holder + candidate * holder_step)) return;
    }
    throw std::runtime_error("all domains or ports for tests are taken");
  }
  bool hold(int port) {
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in here = {};
    here.sin_family = AF_INET;
    here.sin_port = htons(static_cast<std::uint16_t>(port));
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::bind(socket_, reinterpret_cast<const sockaddr*>(&here), sizeof here) == 0) return true;
    ::close(socket_);
    return false;
  }

  int socket_ = -1;
  int number_ = 0;
};

}  // namespace takt::testing
