// SPDX-License-Identifier: Apache-2.0
// The way to the network of a real node: NetworkMessages out and in.
#pragma once

#include <array>
#include <compare>
#include <memory>
#include <string>

#include "node/config.hpp"
#include "pubsub/stack.hpp"
#include "wire/verdict.hpp"

namespace takt::node {

/// A file descriptor that is closed with its owner.
class FileDescriptor {
 public:
  explicit FileDescriptor(int number = -1) : number_(number) {}
  FileDescriptor(FileDescriptor&& other) noexcept : number_(other.number_) { other.number_ = -1; }
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor();
  int number() const { return number_; }
  bool is_open() const { return number_ >= 0; }

 private:
  int number_;
};

/// Who has sent something, as far as the network says so: anybody can write any address.
struct SenderAddress {
  enum class Kind : std::uint8_t { unknown, udp, ethernet };
  Kind kind = Kind::unknown;
  std::array<std::uint8_t, 6> octets{};  ///< IPv4 address and port, in network order; or MAC address
  auto operator<=>(const SenderAddress&) const = default;
};
/// "10.0.0.3:4840", "02:00:00:00:00:07".
std::string to_text(const SenderAddress& address);

/// One frame or datagram. What must not be taken has no message, but counts like one that has: a flood of it does not
/// keep a turn of the loop going.
struct Arrival {
  wire::Verdict verdict = wire::Verdict::taken;  ///< or why its way or its length speaks against it
  uadp::Octets message;                          ///< lasts until the next one
  SenderAddress from;
};

/// Sends to all destinations; gives what was received, without waiting.
class Socket : public pubsub::PublishedData, public pubsub::SubscribedData {
 public:
  virtual int file_descriptor() const = 0;
  /// The next frame or datagram, oldest first; nothing if there is none.
  virtual std::optional<Arrival> take() = 0;
  /// The next one that may be taken. Passes over a bounded number of others; so nothing is no proof that nothing waits.
  uadp::Octets next() final;
  /// Messages that the kernel did not take.
  virtual std::uint64_t send_failures() const = 0;
  /// From now on messages may have launch times, on this clock. Returns what is in the way, or "".
  virtual std::string enable_launch_times(ClockName clock) = 0;
  /// Messages that are published now leave at this time of that clock; 0: at once.
  void set_launch_time(std::int64_t ns) { launch_ns_ = ns; }

 protected:
  std::int64_t launch_ns_ = 0;
};

/// "what: ", and what the operating system has against it (errno).
std::string what_failed(const std::string& what);
/// Null, and `problem` says why, if the machine does not give what the transport needs.
std::unique_ptr<Socket> open_socket(const UdpTransport& transport, std::string& problem);
std::unique_ptr<Socket> open_socket(const EthernetTransport& transport, std::string& problem);

}  // namespace takt::node
