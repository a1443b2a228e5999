// SPDX-License-Identifier: Apache-2.0
// UADP over Ethernet (OPC 10000-14, 7.3.3): EtherType 0xB62C, with a VLAN tag if wanted. Needs CAP_NET_RAW.
#include <arpa/inet.h>
#include <linux/filter.h>
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
constexpr unsigned most_vlan = 0x0FFF;  // the VLAN's 12 bits of a tag

bool parse_mac(const std::string& text, MacAddress& address) {
  std::array<unsigned, 6> octets{};
  char rest = 0;
  for (const char* const format : {"%2x:%2x:%2x:%2x:%2x:%2x%c", "%2x-%2x-%2x-%2x-%2x-%2x%c"}) {
    if (std::sscanf(text.c_str(), format, &octets[0], &octets[1], &octets[2], &octets[3], &octets[4], &octets[5],
                    &rest) != 6)
      continue;
    std::transform(octets.begin(), octets.end(), address.begin(),
                   [](unsigned octet) { return static_cast<std::uint8_t>(octet); });
    return true;
  }
  return false;
}

void put16(std::byte* at, unsigned value) {
  at[0] = static_cast<std::byte>(value >> 8);
  at[1] = static_cast<std::byte>(value & 0xFF);
}
unsigned get16(const std::byte* at) { return std::to_integer<unsigned>(at[0]) << 8 | std::to_integer<unsigned>(at[1]); }

/// Which frames it takes.
struct Reception {
  MacAddress own{};
  MacAddress group{};                 ///< where its messages go to; heard if it is a group address
  std::optional<std::uint16_t> vlan;  ///< none: frames without a tag, or with one that tells a priority only
};

/// Frames with EtherType 0xB62C, perhaps behind one tag that a driver has left in place, that came for this machine.
/// The socket is one for all EtherTypes: the kernel takes the tag off, and forgets it, before it gives a frame to
/// sockets of one.
bool filter_frames(int fd) {
  constexpr auto packet_type = static_cast<std::uint32_t>(SKF_AD_OFF + SKF_AD_PKTTYPE);
  std::array<sock_filter, 9> program = {{
      BPF_STMT(BPF_LD | BPF_B | BPF_ABS, packet_type),
      BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, PACKET_OTHERHOST, 5, 0),
      BPF_STMT(BPF_LD | BPF_H | BPF_ABS, addresses_octets),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, wire::uadp_ether_type, 4, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, vlan_ether_type, 0, 2),
      BPF_STMT(BPF_LD | BPF_H | BPF_ABS, addresses_octets + 4),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, wire::uadp_ether_type, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, 0),
      BPF_STMT(BPF_RET | BPF_K, 0xFFFF),
  }};
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  return ::setsockopt(fd, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) == 0;
}

class EthernetSocket final : public Socket {
 public:
  /// `header` is all before the NetworkMessage.
  EthernetSocket(FileDescriptor fd, uadp::Octets header, int interface, const Reception& reception)
      : fd_(std::move(fd)), header_octets_(header.size()), interface_(interface), reception_(reception) {
    std::copy(header.begin(), header.end(), frame_.begin());
  }

  int file_descriptor() const override { return fd_.number(); }
  std::uint64_t send_failures() const override { return failures_; }
  std::string enable_launch_times(ClockName clock) override {
    return node::enable_launch_times(fd_.number(), clock, interface_);
  }

  void publish(uadp::Octets message, const pubsub::Destination&) override {
    if (message.size() > frame_.size() - header_octets_) {
      ++failures_;
      return;
    }
    std::copy(message.begin(), message.end(), frame_.begin() + static_cast<std::ptrdiff_t>(header_octets_));
    const std::size_t size = header_octets_ + message.size();
    if (!send_at(fd_.number(), uadp::Octets(frame_).first(size), nullptr, 0, launch_ns_)) ++failures_;
  }

  std::optional<Arrival> take() override {
    iovec part = {received_.data(), received_.size()};
    alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(tpacket_auxdata))> control{};
    msghdr header = {};
    header.msg_iov = &part;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    ssize_t size = 0;
    do size = ::recvmsg(fd_.number(), &header, MSG_DONTWAIT | MSG_TRUNC);
    while (size < 0 && errno == EINTR);
    if (size < 0) return std::nullopt;
    const auto octets = static_cast<std::size_t>(size);
    return octets > received_.size() ? Arrival{wire::Verdict::too_long, {}, sender()}
                                     : arrival(uadp::Octets(received_).first(octets), tag_of(header));
  }

 private:
  /// The VLAN of the tag that the kernel has taken off; none: there was no tag.
  static std::optional<std::uint16_t> tag_of(msghdr& header) {
    for (cmsghdr* each = CMSG_FIRSTHDR(&header); each != nullptr; each = CMSG_NXTHDR(&header, each)) {
      if (each->cmsg_level != SOL_PACKET || each->cmsg_type != PACKET_AUXDATA) continue;
      tpacket_auxdata data;
      std::memcpy(&data, CMSG_DATA(each), sizeof data);
      if ((data.tp_status & TP_STATUS_VLAN_VALID) != 0) return static_cast<std::uint16_t>(data.tp_vlan_tci & most_vlan);
    }
    return std::nullopt;
  }
  SenderAddress sender() const {
    SenderAddress address{SenderAddress::Kind::ethernet};
    std::memcpy(address.octets.data(), received_.data() + 6, 6);
    return address;
  }
  bool is_addressed() const {
    const auto is = [this](const MacAddress& address) {
      return std::memcmp(received_.data(), address.data(), address.size()) == 0;
    };
    return is(reception_.own) || ((reception_.group[0] & 1) != 0 && is(reception_.group));
  }
  Arrival arrival(uadp::Octets frame, std::optional<std::uint16_t> vlan) const {
    if (frame.size() < addresses_octets + 2) return {wire::Verdict::too_short, {}, {}};
    Arrival arrival{wire::Verdict::taken, {}, sender()};
    frame = frame.subspan(addresses_octets);
    // The kernel takes tags off before it gives frames away; not all drivers leave that to it.
    if (get16(frame.data()) == vlan_ether_type) {
      if (frame.size() < 6) return {wire::Verdict::too_short, {}, arrival.from};
      if (!vlan) vlan = static_cast<std::uint16_t>(get16(frame.data() + 2) & most_vlan);
      frame = frame.subspan(4);
    }
    const bool fits =
        vlan.value_or(0) == reception_.vlan.value_or(0);  // a tag of VLAN 0 tells a priority only (IEEE 802.1Q, 6.9)
    if (!is_addressed())
      arrival.verdict = wire::Verdict::address;
    else if (!fits)
      arrival.verdict = wire::Verdict::vlan;
    else if (frame.size() <= 2)
      arrival.verdict = wire::Verdict::too_short;
    else
      arrival.message = frame.subspan(2);
    return arrival;
  }

  FileDescriptor fd_;
  std::size_t header_octets_;
  int interface_;
  Reception reception_;
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
  // Of no protocol until it has its filter: nothing else is heard in between.
  FileDescriptor fd(::socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, 0));
  if (!fd.is_open()) return fail(what_failed("a packet socket (needs CAP_NET_RAW)"));
  if (!filter_frames(fd.number())) return fail(what_failed("a filter of frames"));
  const int on = 1;
  if (::setsockopt(fd.number(), SOL_PACKET, PACKET_AUXDATA, &on, sizeof on) != 0)
    return fail(what_failed("PACKET_AUXDATA"));
  ifreq request = {};
  std::strncpy(request.ifr_name, transport.interface.c_str(), IFNAMSIZ - 1);
  if (::ioctl(fd.number(), SIOCGIFHWADDR, &request) != 0) return fail(what_failed("interface " + transport.interface));

  sockaddr_ll own = {};
  own.sll_family = AF_PACKET;
  own.sll_protocol = htons(ETH_P_ALL);
  own.sll_ifindex = static_cast<int>(::if_nametoindex(transport.interface.c_str()));
  if (::bind(fd.number(), reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0)
    return fail(what_failed("interface " + transport.interface));
  const int priority = transport.pcp;
  ::setsockopt(fd.number(), SOL_SOCKET, SO_PRIORITY, &priority, sizeof priority);  // not needed to send
  if ((destination[0] & 1) != 0) {
    packet_mreq group = {};
    group.mr_ifindex = own.sll_ifindex;
    group.mr_type = PACKET_MR_MULTICAST;
    group.mr_alen = 6;
    std::copy(destination.begin(), destination.end(), group.mr_address);
    if (::setsockopt(fd.number(), SOL_PACKET, PACKET_ADD_MEMBERSHIP, &group, sizeof group) != 0)
      return fail(what_failed("group " + transport.destination));
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
  Reception reception{{}, destination, transport.vlan};
  std::memcpy(reception.own.data(), request.ifr_hwaddr.sa_data, reception.own.size());
  return std::make_unique<EthernetSocket>(std::move(fd), uadp::Octets(header).first(octets + 2), own.sll_ifindex,
                                          reception);
}

}  // namespace takt::node
