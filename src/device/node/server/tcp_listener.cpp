// SPDX-License-Identifier: Apache-2.0
#include "node/server/tcp_listener.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cerrno>

namespace takt::node {

TcpConnection::Came TcpConnection::receive(std::span<std::byte> buffer, std::size_t& octets) const {
  const ssize_t size = ::recv(fd_.number(), buffer.data(), buffer.size(), MSG_DONTWAIT);
  octets = size > 0 ? static_cast<std::size_t>(size) : 0;
  if (size > 0) return Came::octets;
  return size < 0 && (errno == EAGAIN || errno == EINTR) ? Came::nothing : Came::end;
}

std::optional<std::size_t> TcpConnection::send(std::span<const std::byte> octets) const {
  const ssize_t size = ::send(fd_.number(), octets.data(), octets.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (size >= 0) return static_cast<std::size_t>(size);
  return errno == EAGAIN || errno == EINTR ? std::optional<std::size_t>(0) : std::nullopt;
}

void TcpConnection::end_sending() const { ::shutdown(fd_.number(), SHUT_WR); }

std::optional<TcpConnection> TcpConnection::connect(const EndpointAddress& to, std::string& problem) {
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(to.port);
  if (::inet_pton(AF_INET, to.address.c_str(), &address.sin_addr) != 1) {
    problem = to.address + ": no IPv4 address";
    return std::nullopt;
  }
  FileDescriptor fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (fd.is_open() && (::connect(fd.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ||
                       errno == EINPROGRESS)) {
    const int on = 1;
    ::setsockopt(fd.number(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return TcpConnection(std::move(fd), to.address + ":" + std::to_string(to.port));
  }
  problem = what_failed("no connection");
  return std::nullopt;
}

std::string TcpConnection::problem() const {
  const int told = errno;  // by the call that failed, which the socket forgets then
  int error = 0;
  socklen_t size = sizeof error;
  ::getsockopt(fd_.number(), SOL_SOCKET, SO_ERROR, &error, &size);
  errno = error != 0 ? error : told != 0 ? told : ECONNRESET;
  return what_failed("no connection");
}

std::unique_ptr<TcpListener> TcpListener::open(const EndpointAddress& endpoint, std::string& problem) {
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(endpoint.port);
  const std::string what = "a server at " + endpoint.address + ":" + std::to_string(endpoint.port);
  if (::inet_pton(AF_INET, endpoint.address.c_str(), &address.sin_addr) != 1) {
    problem = what + ": no IPv4 address";
    return nullptr;
  }
  FileDescriptor fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int on = 1;
  ::setsockopt(fd.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  const bool listens = fd.is_open() &&
                       ::bind(fd.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
                       ::listen(fd.number(), 64) == 0;
  if (!listens) {
    problem = what_failed(what);
    return nullptr;
  }
  return std::unique_ptr<TcpListener>(new TcpListener(std::move(fd)));
}

std::optional<TcpConnection> TcpListener::accept() const {
  sockaddr_in from = {};
  socklen_t size = sizeof from;
  FileDescriptor fd(::accept4(fd_.number(), reinterpret_cast<sockaddr*>(&from), &size, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (!fd.is_open()) return std::nullopt;
  const int on = 1;
  ::setsockopt(fd.number(), IPPROTO_TCP, TCP_NODELAY, &on,
               sizeof on);  // answers are short, and somebody waits for them
  std::array<char, INET_ADDRSTRLEN> text{};
  ::inet_ntop(AF_INET, &from.sin_addr, text.data(), text.size());
  return TcpConnection(std::move(fd), std::string(text.data()) + ":" + std::to_string(ntohs(from.sin_port)));
}

}  // namespace takt::node
