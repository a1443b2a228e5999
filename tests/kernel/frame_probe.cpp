// SPDX-License-Identifier: Apache-2.0
// Sends tagged frames, and says which came and when: the two ends of tests in a kernel (kernel_test.py).
//
//   frame_probe send INTERFACE VLAN PRIORITY COUNT GAP_US    frames of 60 octets to 03:00:5e:00:00:77, with SO_PRIORITY
//   and that tag frame_probe hear INTERFACE SECONDS                       a line for each: priority, VLAN and the time
//   of CLOCK_TAI in ns
#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

namespace {

constexpr std::uint16_t own_ether_type = 0x88B5;  // for local experiments

std::int64_t tai_ns() {
  timespec now{};
  clock_gettime(CLOCK_TAI, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

int packet_socket(const char* interface) {
  const int handle = socket(AF_PACKET, SOCK_RAW, htons(ETH_P_ALL));
  sockaddr_ll at{};
  at.sll_family = AF_PACKET;
  at.sll_protocol = htons(ETH_P_ALL);
  at.sll_ifindex = static_cast<int>(if_nametoindex(interface));
  if (handle < 0 || at.sll_ifindex == 0 || bind(handle, reinterpret_cast<sockaddr*>(&at), sizeof at) != 0) {
    std::perror(interface);
    std::exit(2);
  }
  return handle;
}

int send_frames(char** arguments) {
  const int handle = packet_socket(arguments[0]);
  const auto vlan = static_cast<std::uint16_t>(std::atoi(arguments[1]));
  const int priority = std::atoi(arguments[2]);
  setsockopt(handle, SOL_SOCKET, SO_PRIORITY, &priority, sizeof priority);
  std::array<unsigned char, 64> frame{3, 0, 0x5E, 0, 0, 0x77, 2, 0, 0x5E, 0, 0, 1, 0x81, 0};
  const auto tag = static_cast<std::uint16_t>(priority << 13 | vlan);
  frame[14] = static_cast<unsigned char>(tag >> 8);
  frame[15] = static_cast<unsigned char>(tag & 0xFF);
  frame[16] = own_ether_type >> 8;
  frame[17] = own_ether_type & 0xFF;
  for (int left = std::atoi(arguments[3]); left > 0; --left) {
    if (send(handle, frame.data(), frame.size(), 0) < 0) std::perror("send");
    usleep(static_cast<useconds_t>(std::atoi(arguments[4])));
  }
  return 0;
}

int hear_frames(char** arguments) {
  const int handle = packet_socket(arguments[0]);
  const int on = 1;
  setsockopt(handle, SOL_PACKET, PACKET_AUXDATA, &on, sizeof on);
  timeval patience{0, 100'000};
  setsockopt(handle, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  std::printf("listening\n");
  std::fflush(stdout);
  const std::int64_t end = tai_ns() + std::atoll(arguments[1]) * 1'000'000'000;
  while (tai_ns() < end) {
    std::array<unsigned char, 2048> octets{};
    alignas(cmsghdr) std::array<char, 256> control{};
    iovec into{octets.data(), octets.size()};
    msghdr message{};
    message.msg_iov = &into;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t length = recvmsg(handle, &message, 0);
    if (length < 18) continue;
    const std::int64_t now = tai_ns();
    int tag = -1;  // the kernel takes the tag off and says it beside the frame
    for (cmsghdr* each = CMSG_FIRSTHDR(&message); each != nullptr; each = CMSG_NXTHDR(&message, each)) {
      if (each->cmsg_level != SOL_PACKET || each->cmsg_type != PACKET_AUXDATA) continue;
      tpacket_auxdata aux{};
      std::memcpy(&aux, CMSG_DATA(each), sizeof aux);
      if ((aux.tp_status & TP_STATUS_VLAN_VALID) != 0) tag = aux.tp_vlan_tci;
    }
    std::size_t type_at = 12;
    if (octets[12] == 0x81 && octets[13] == 0) {
      tag = octets[14] << 8 | octets[15];
      type_at = 16;
    }
    if ((octets[type_at] << 8 | octets[type_at + 1]) != own_ether_type) continue;
    std::printf("heard %d %d %lld\n", tag < 0 ? -1 : tag >> 13, tag < 0 ? -1 : tag & 0xFFF,
                static_cast<long long>(now));
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count == 7 && std::strcmp(arguments[1], "send") == 0) return send_frames(arguments + 2);
  if (count == 4 && std::strcmp(arguments[1], "hear") == 0) return hear_frames(arguments + 2);
  std::fprintf(stderr, "usage: frame_probe send INTERFACE VLAN PRIORITY COUNT GAP_US | hear INTERFACE SECONDS\n");
  return 2;
}
