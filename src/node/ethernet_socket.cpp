// UADP over Ethernet (OPC 10000-14, 7.3.3): EtherType 0xB62C, with a VLAN tag if wanted. Needs CAP_NET_RAW.
#include <arpa/inet.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "node/launch_time.hpp"
#include "node/socket.hpp"

namespace takt::node {
namespace {

using MacAddress = std::array<std::uint8_t, 6>;

constexpr std::size_t addresses_octets = 12;
constexpr std::uint16_t vlan_ether_type = 0x8100;


bool parse_mac(const std::string& text, MacAddress& address) {
  std::array<unsigned, 6> octets{};
  char rest = 0;
  for (const char* const format : {"%2x:%2x:%2x:%2x:%2x:%2x%c", "%2x-%2x-%2x-%2x-%2x-%2x%c"}) {
    if (std::sscanf(text.c_str(), format, &octets[0], &octets[1], &octets[2], &octets[3], &octets[4], &octets[5], &rest) != 6) continue;
    std::transform(octets.begin(), octets.end(), address.begin(), [](unsigned octet) { return static_cast<std::uint8_t>(octet); });
    return true;
  }
  return false;
}

void put16(std::byte* at, unsigned value) {
  at[0] = static_cast<std::byte>(value >> 8);
  at[1] = static_cast<std::byte>(value & 0xFF);
}
unsigned get16(const std::byte* at) { return std::to_integer<unsigned>(at[0]) << 8 | std::to_integer<unsigned>(at[1]); }

class EthernetSocket final : public Socket {
 public:
  /// `header` is all before the NetworkMessage.
  EthernetSocket(FileDescriptor fd, uadp::Octets header, int interface) : fd_(std::move(fd)), header_octets_(header.size()), interface_(interface) {
    std::copy(header.begin(), header.end(), frame_.begin());
  }

  int file_descriptor() const override { return fd_.number(); }
  std::uint64_t send_failures() const override { return failures_; }
  std::string enable_launch_times(ClockName clock) override { return node::enable_launch_times(fd_.number(), clock, interface_); }

  void publish(uadp::Octets message, const pubsub::Destination&) override {
    if (message.size() > frame_.size() - header_octets_) {
      ++failures_;
      return;
    }
    std::copy(message.begin(), message.end(), frame_.begin() + static_cast<std::ptrdiff_t>(header_octets_));
    const std::size_t size = header_octets_ + message.size();
    if (!send_at(fd_.number(), uadp::Octets(frame_).first(size), nullptr, 0, launch_ns_)) ++failures_;
  }

  uadp::Octets next() override {
    for (;;) {
      const ssize_t size = ::recv(fd_.number(), received_.data(), received_.size(), MSG_DONTWAIT);
      if (size < 0 && errno == EINTR) continue;
      if (size < 0) return {};
      uadp::Octets frame = uadp::Octets(received_).first(static_cast<std::size_t>(size));
      if (frame.size() < addresses_octets + 6) continue;
      // The kernel takes tags off before it gives frames away; not all drivers leave that to it.
      frame = frame.subspan(addresses_octets);
      if (get16(frame.data()) == vlan_ether_type) frame = frame.subspan(4);
      if (get16(frame.data()) == wire::uadp_ether_type) return frame.subspan(2);
    }
  }

 private:
  FileDescriptor fd_;
  std::size_t header_octets_;
  int interface_;
  std::array<std::byte, 1518> frame_{};
  std::array<std::byte, 2048> received_{};
  std::uint64_t failures_ = 0;
};

}  // namespace

std::unique_ptr<Socket> open_socket(const EthernetTransport& transport, std::string& problem) {
  const auto fail = [&problem](const std::string& what) {
    problem = what;
    return nullptr;
  };
  MacAddress destination{};
  if (!parse_mac(transport.destination, destination)) return fail("not a MAC address: " + transport.destination);
  FileDescriptor fd(::socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, htons(wire::uadp_ether_type)));
  if (!fd.is_open()) return fail(what_failed("a packet socket (needs CAP_NET_RAW)"));
  ifreq request = {};
  std::strncpy(request.ifr_name, transport.interface.c_str(), IFNAMSIZ - 1);
  if (::ioctl(fd.number(), SIOCGIFHWADDR, &request) != 0) return fail(what_failed("interface " + transport.interface));

  sockaddr_ll own = {};
  own.sll_family = AF_PACKET;
  own.sll_protocol = htons(wire::uadp_ether_type);
  own.sll_ifindex = static_cast<int>(::if_nametoindex(transport.interface.c_str()));
  if (::bind(fd.number(), reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) return fail(what_failed("interface " + transport.interface));
  const int priority = transport.pcp;
  ::setsockopt(fd.number(), SOL_SOCKET, SO_PRIORITY, &priority, sizeof priority);  // not needed to send
  if ((destination[0] & 1) != 0) {
    packet_mreq group = {};
    group.mr_ifindex = own.sll_ifindex;
    group.mr_type = PACKET_MR_MULTICAST;
    group.mr_alen = 6;
    std::copy(destination.begin(), destination.end(), group.mr_address);
    if (::setsockopt(fd.number(), SOL_PACKET, PACKET_ADD_MEMBERSHIP, &group, sizeof group) != 0) return fail(what_failed("group " + transport.destination));
  }

  std::array<std::byte, 18> header{};
  std::memcpy(header.data(), destination.data(), 6);
  std::memcpy(header.data() + 6, request.ifr_hwaddr.sa_data, 6);
  std::size_t octets = addresses_octets;
  if (transport.vlan) {
    put16(header.data() + octets, vlan_ether_type);
    put16(header.data() + octets + 2, unsigned{transport.pcp} << 13 | *transport.vlan);
    octets += 4;
  }
  put16(header.data() + octets, wire::uadp_ether_type);
  return std::make_unique<EthernetSocket>(std::move(fd), uadp::Octets(header).first(octets + 2), own.sll_ifindex);
}

}  // namespace takt::node
