// SPDX-License-Identifier: Apache-2.0
#include "node/launch_time.hpp"

#include <linux/net_tstamp.h>
#include <linux/rtnetlink.h>
#include <sys/socket.h>
#include <time.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include "node/socket.hpp"

namespace takt::node {
namespace {

/// The kinds of the queueing disciplines of an interface, as tc shows them.
std::vector<std::string> queueing_disciplines(int interface) {
  struct Request {
    nlmsghdr header;
    tcmsg body;
  };
  std::vector<std::string> kinds;
  const FileDescriptor fd(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE));
  Request request = {};
  request.header.nlmsg_len = sizeof request;
  request.header.nlmsg_type = RTM_GETQDISC;
  request.header.nlmsg_flags = NLM_F_REQUEST | NLM_F_DUMP;
  request.body.tcm_family = AF_UNSPEC;
  request.body.tcm_ifindex = interface;
  if (!fd.is_open() || ::send(fd.number(), &request, sizeof request, 0) < 0) return kinds;
  alignas(nlmsghdr) std::array<char, 16384> buffer;
  for (;;) {
    const ssize_t received = ::recv(fd.number(), buffer.data(), buffer.size(), 0);
    if (received <= 0) return kinds;
    auto left = static_cast<unsigned>(received);
    for (auto* header = reinterpret_cast<nlmsghdr*>(buffer.data()); NLMSG_OK(header, left);
         header = NLMSG_NEXT(header, left)) {
      if (header->nlmsg_type == NLMSG_DONE || header->nlmsg_type == NLMSG_ERROR) return kinds;
      const auto* const body = static_cast<const tcmsg*>(NLMSG_DATA(header));
      if (body->tcm_ifindex != interface) continue;
      auto octets = static_cast<unsigned>(header->nlmsg_len - NLMSG_LENGTH(sizeof(tcmsg)));
      const auto* attribute =
          reinterpret_cast<const rtattr*>(reinterpret_cast<const char*>(body) + NLMSG_ALIGN(sizeof(tcmsg)));
      for (; RTA_OK(attribute, octets); attribute = reinterpret_cast<const rtattr*>(
                                            reinterpret_cast<const char*>(attribute) + RTA_ALIGN(attribute->rta_len))) {
        if (attribute->rta_type == TCA_KIND)
          kinds.emplace_back(reinterpret_cast<const char*>(attribute) + RTA_LENGTH(0));
        octets -= static_cast<unsigned>(RTA_ALIGN(attribute->rta_len));
      }
    }
  }
}

}  // namespace

std::string enable_launch_times(int socket, ClockName clock, int interface) {
  if (interface == 0) return "the file names no interface";
  const std::string wanted = clock == ClockName::tai ? "etf" : "fq";
  bool is_there = false;
  std::string found;
  for (const std::string& kind : queueing_disciplines(interface)) {
    is_there = is_there || kind == wanted;
    found += (found.empty() ? "" : ", ") + kind;
  }
  if (!is_there)
    return "with this clock they need the queueing discipline " + wanted + "; the interface has " +
           (found.empty() ? "none" : found);
  sock_txtime setting = {};
  setting.clockid = clock == ClockName::tai ? CLOCK_TAI : CLOCK_MONOTONIC;
  if (::setsockopt(socket, SOL_SOCKET, SO_TXTIME, &setting, sizeof setting) != 0)
    return std::string("SO_TXTIME: ") + std::strerror(errno);
  return {};
}

bool send_at(int socket, uadp::Octets octets, const sockaddr* to, std::size_t to_octets, std::int64_t launch_ns) {
  iovec part = {const_cast<std::byte*>(octets.data()), octets.size()};
  msghdr message = {};
  message.msg_name = const_cast<sockaddr*>(to);
  message.msg_namelen = static_cast<socklen_t>(to_octets);
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(std::uint64_t))> control{};
  if (launch_ns != 0) {
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    cmsghdr* const header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_TXTIME;
    header->cmsg_len = CMSG_LEN(sizeof(std::uint64_t));
    std::memcpy(CMSG_DATA(header), &launch_ns, sizeof launch_ns);
  }
  return ::sendmsg(socket, &message, MSG_DONTWAIT | MSG_NOSIGNAL) == static_cast<ssize_t>(octets.size());
}

}  // namespace takt::node
