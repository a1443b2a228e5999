// UADP over UDP and IPv4 (OPC 10000-14, 7.3.2).
#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <vector>

#include "node/launch_time.hpp"
#include "node/socket.hpp"

namespace takt::node {
namespace {


template <class T>
bool set_option(int fd, int level, int name, const T& value) {
  return ::setsockopt(fd, level, name, &value, sizeof value) == 0;
}

/// "address" or "address:port".
bool parse_address(const std::string& text, std::uint16_t default_port, sockaddr_in& address) {
  const std::size_t colon = text.find(':');
  unsigned port = default_port;
  if (colon != std::string::npos) {
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data() + colon + 1, end, port);
    if (parsed.ec != std::errc() || parsed.ptr != end || port == 0 || port > 65535) return false;
  }
  address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return ::inet_pton(AF_INET, text.substr(0, colon).c_str(), &address.sin_addr) == 1;
}

class UdpSocket final : public Socket {
 public:
  UdpSocket(FileDescriptor fd, std::vector<sockaddr_in> destinations, int interface)
      : fd_(std::move(fd)), destinations_(std::move(destinations)), interface_(interface) {}

  int file_descriptor() const override { return fd_.number(); }
  std::uint64_t send_failures() const override { return failures_; }
  std::string enable_launch_times(ClockName clock) override { return node::enable_launch_times(fd_.number(), clock, interface_); }

  void publish(uadp::Octets message, const pubsub::Destination&) override {
    for (const sockaddr_in& to : destinations_)
      if (!send_at(fd_.number(), message, reinterpret_cast<const sockaddr*>(&to), sizeof to, launch_ns_)) ++failures_;
  }

  uadp::Octets next() override {
    for (;;) {
      const ssize_t size = ::recv(fd_.number(), buffer_.data(), buffer_.size(), MSG_DONTWAIT | MSG_TRUNC);
      if (size > static_cast<ssize_t>(buffer_.size()) || size == 0) continue;  // longer than any message of a Program, or empty
      // ECONNREFUSED: somebody to whom we have sent is not there yet; what has come may stand behind it.
      if (size < 0 && (errno == ECONNREFUSED || errno == EINTR)) continue;
      return size < 0 ? uadp::Octets() : uadp::Octets(buffer_).first(static_cast<std::size_t>(size));
    }
  }

 private:
  FileDescriptor fd_;
  std::vector<sockaddr_in> destinations_;
  int interface_;  ///< 0: the kernel's choice
  std::array<std::byte, 1500> buffer_{};
  std::uint64_t failures_ = 0;
};

/// Joins a group, and sends to groups, on the interface.
bool set_up_multicast(int fd, const in_addr& group, int interface) {
  ip_mreqn request = {};
  request.imr_multiaddr = group;
  request.imr_ifindex = interface;
  if (!set_option(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, request)) return false;
  return interface == 0 || set_option(fd, IPPROTO_IP, IP_MULTICAST_IF, request);
}

}  // namespace

std::unique_ptr<Socket> open_socket(const UdpTransport& transport, std::string& problem) {
  const auto fail = [&problem](const std::string& what) {
    problem = what;
    return nullptr;
  };
  FileDescriptor fd(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!fd.is_open()) return fail(what_failed("a UDP socket"));
  int interface = 0;
  if (transport.interface) {
    interface = static_cast<int>(::if_nametoindex(transport.interface->c_str()));
    if (interface == 0) return fail(what_failed("interface " + *transport.interface));
  }
  // Not needed to send or receive, so a machine that does not grant them runs without.
  set_option(fd.number(), SOL_SOCKET, SO_PRIORITY, int{transport.pcp});
  set_option(fd.number(), IPPROTO_IP, IP_TOS, int{transport.pcp} << 5);
  if (!set_option(fd.number(), SOL_SOCKET, SO_REUSEADDR, 1)) return fail(what_failed("SO_REUSEADDR"));
  sockaddr_in own = {};
  own.sin_family = AF_INET;
  own.sin_port = htons(transport.port);
  own.sin_addr.s_addr = htonl(INADDR_ANY);
  if (::bind(fd.number(), reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) return fail(what_failed("UDP port " + std::to_string(transport.port)));
  std::vector<sockaddr_in> destinations;
  for (const std::string& text : transport.destinations) {
    sockaddr_in& to = destinations.emplace_back();
    if (!parse_address(text, transport.port, to)) return fail("not an IPv4 address, or address:port: " + text);
    if (IN_MULTICAST(ntohl(to.sin_addr.s_addr)) && !set_up_multicast(fd.number(), to.sin_addr, interface)) return fail(what_failed("multicast group " + text));
  }
  return std::make_unique<UdpSocket>(std::move(fd), std::move(destinations), interface);
}

}  // namespace takt::node
