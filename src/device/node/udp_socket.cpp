// SPDX-License-Identifier: Apache-2.0
// UADP over UDP and IPv4 (OPC 10000-14, 7.3.2).
#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
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

/// What an interface is, to tell what was sent to it.
struct Interface {
  int index = 0;  ///< 0: any
  int loopback = 0;
  std::vector<in_addr_t> addresses;  ///< as they were when the socket was opened

  /// Came by it to one of its addresses or to a group that was joined on it; or from this machine to one of its
  /// addresses.
  bool takes(const in_pktinfo& way) const {
    if (index == 0) return true;
    const bool is_own = std::find(addresses.begin(), addresses.end(), way.ipi_addr.s_addr) != addresses.end();
    if (way.ipi_ifindex == index) return is_own || IN_MULTICAST(ntohl(way.ipi_addr.s_addr));
    return way.ipi_ifindex == loopback && is_own;
  }
};

std::vector<in_addr_t> addresses_of(const std::string& interface) {
  std::vector<in_addr_t> found;
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return found;
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next)
    if (each->ifa_addr != nullptr && each->ifa_addr->sa_family == AF_INET && interface == each->ifa_name)
      found.push_back(reinterpret_cast<const sockaddr_in*>(each->ifa_addr)->sin_addr.s_addr);
  ::freeifaddrs(all);
  return found;
}

class UdpSocket final : public Socket {
 public:
  UdpSocket(FileDescriptor fd, std::vector<sockaddr_in> destinations, Interface interface)
      : fd_(std::move(fd)), destinations_(std::move(destinations)), interface_(std::move(interface)) {}

  int file_descriptor() const override { return fd_.number(); }
  std::uint64_t send_failures() const override { return failures_; }
  std::string enable_launch_times(ClockName clock) override {
    return node::enable_launch_times(fd_.number(), clock, interface_.index);
  }

  void publish(uadp::Octets message, const pubsub::Destination&) override {
    for (const sockaddr_in& to : destinations_)
      if (!send_at(fd_.number(), message, reinterpret_cast<const sockaddr*>(&to), sizeof to, launch_ns_)) ++failures_;
  }

  std::optional<Arrival> take() override {
    sockaddr_in sender = {};
    iovec part = {buffer_.data(), buffer_.size()};
    alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(in_pktinfo))> control{};
    msghdr header = {};
    header.msg_name = &sender;
    header.msg_namelen = sizeof sender;
    header.msg_iov = &part;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    // ECONNREFUSED: somebody to whom we have sent is not there yet; what has come may stand behind it. Anybody can say
    // so, and again and again.
    constexpr int most_tries = 8;
    ssize_t size = -1;
    for (int i = 0; i < most_tries && size < 0; ++i) {
      size = ::recvmsg(fd_.number(), &header, MSG_DONTWAIT | MSG_TRUNC);
      if (size < 0 && errno != EINTR && errno != ECONNREFUSED) break;
    }
    if (size < 0) return std::nullopt;
    Arrival arrival;
    arrival.from = address_of(sender);
    const auto octets = static_cast<std::size_t>(size);
    if (!is_addressed_to_us(header))
      arrival.verdict = wire::Verdict::address;
    else if (octets == 0)
      arrival.verdict = wire::Verdict::empty;
    else if (octets > buffer_.size())
      arrival.verdict = wire::Verdict::too_long;  // than any message of a Program
    else
      arrival.message = uadp::Octets(buffer_).first(octets);
    return arrival;
  }

 private:
  static SenderAddress address_of(const sockaddr_in& sender) {
    SenderAddress address{SenderAddress::Kind::udp};
    std::memcpy(address.octets.data(), &sender.sin_addr, 4);
    std::memcpy(address.octets.data() + 4, &sender.sin_port, 2);
    return address;
  }
  bool is_addressed_to_us(msghdr& header) const {
    if (interface_.index == 0) return true;
    for (cmsghdr* each = CMSG_FIRSTHDR(&header); each != nullptr; each = CMSG_NXTHDR(&header, each)) {
      if (each->cmsg_level != IPPROTO_IP || each->cmsg_type != IP_PKTINFO) continue;
      in_pktinfo way;
      std::memcpy(&way, CMSG_DATA(each), sizeof way);
      return interface_.takes(way);
    }
    return false;
  }

  FileDescriptor fd_;
  std::vector<sockaddr_in> destinations_;
  Interface interface_;
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
  Interface interface;
  if (transport.interface) {
    interface.index = static_cast<int>(::if_nametoindex(transport.interface->c_str()));
    if (interface.index == 0) return fail(what_failed("interface " + *transport.interface));
    interface.loopback = static_cast<int>(::if_nametoindex("lo"));
    interface.addresses = addresses_of(*transport.interface);
    if (!set_option(fd.number(), IPPROTO_IP, IP_PKTINFO, 1)) return fail(what_failed("IP_PKTINFO"));
  }
  // A socket of any address would hear what other processes of the machine have joined, too.
  if (!set_option(fd.number(), IPPROTO_IP, IP_MULTICAST_ALL, 0)) return fail(what_failed("IP_MULTICAST_ALL"));
  // Not needed to send or receive, so a machine that does not grant them runs without.
  set_option(fd.number(), SOL_SOCKET, SO_PRIORITY, int{transport.pcp});
  set_option(fd.number(), IPPROTO_IP, IP_TOS, int{transport.pcp} << 5);
  if (!set_option(fd.number(), SOL_SOCKET, SO_REUSEADDR, 1)) return fail(what_failed("SO_REUSEADDR"));
  sockaddr_in own = {};
  own.sin_family = AF_INET;
  own.sin_port = htons(transport.port);
  own.sin_addr.s_addr = htonl(INADDR_ANY);
  if (::bind(fd.number(), reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0)
    return fail(what_failed("UDP port " + std::to_string(transport.port)));
  std::vector<sockaddr_in> destinations;
  for (const std::string& text : transport.destinations) {
    sockaddr_in& to = destinations.emplace_back();
    if (!parse_address(text, transport.port, to)) return fail("not an IPv4 address, or address:port: " + text);
    if (IN_MULTICAST(ntohl(to.sin_addr.s_addr)) && !set_up_multicast(fd.number(), to.sin_addr, interface.index))
      return fail(what_failed("multicast group " + text));
  }
  return std::make_unique<UdpSocket>(std::move(fd), std::move(destinations), std::move(interface));
}

}  // namespace takt::node
