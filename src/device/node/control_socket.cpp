// SPDX-License-Identifier: Apache-2.0
#include "node/control_socket.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace takt::node {
namespace {

constexpr std::size_t most_octets_of_request = 256;
constexpr std::size_t most_octets_of_answer = std::size_t{64} << 10;
constexpr int answer_timeout_ms = 5000;

bool address_of(const std::string& path, sockaddr_un& address, std::string& problem) {
  address = {};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) {
    problem =
        "the path of a control socket has 1 to " + std::to_string(sizeof address.sun_path - 1) + " octets: " + path;
    return false;
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  return true;
}

const sockaddr* general(const sockaddr_un& address) { return reinterpret_cast<const sockaddr*>(&address); }

/// A node that has stopped does not take connections; without a limit whoever connects would wait as long as it.
void limit_connecting(const FileDescriptor& fd) {
  const timeval limit = {answer_timeout_ms / 1000, 0};
  ::setsockopt(fd.number(), SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
}

/// The user of the node, or root: the mode of the socket says the same, but somebody may have changed that.
bool is_permitted(const FileDescriptor& client) {
  ucred peer = {};
  socklen_t size = sizeof peer;
  return ::getsockopt(client.number(), SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 &&
         (peer.uid == ::geteuid() || peer.uid == 0);
}

bool somebody_listens(const sockaddr_un& address) {
  const FileDescriptor probe(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
  limit_connecting(probe);
  return ::connect(probe.number(), general(address), sizeof address) == 0 || errno == EAGAIN;
}

std::string default_folder() {
  if (const char* const folder = std::getenv("XDG_RUNTIME_DIR"); folder != nullptr && *folder == '/') return folder;
  if (::geteuid() == 0) return "/run";
  return "/tmp/takt-" + std::to_string(::geteuid());
}

}  // namespace

std::string default_control_path(std::string_view node) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string name;
  for (const char c : node) {
    const auto octet = static_cast<unsigned char>(c);
    const bool is_plain =
        (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
    if (is_plain)
      name += c;
    else
      name += {'%', digits[octet >> 4], digits[octet & 15]};
  }
  return default_folder() + "/takt-" + name + ".sock";
}

std::unique_ptr<ControlSocket> ControlSocket::open(const std::string& path, std::string& problem) {
  sockaddr_un address;
  if (!address_of(path, address, problem)) return nullptr;
  // A folder of our own below /tmp; where others have put something else there, bind or the check of its owner fails.
  if (const std::string folder = path.substr(0, path.rfind('/')); folder.starts_with("/tmp/takt-")) {
    ::mkdir(folder.c_str(), 0700);
    struct stat status = {};
    if (::lstat(folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode) || status.st_uid != ::geteuid()) {
      problem = folder + " is not a folder of this user";
      return nullptr;
    }
  }
  if (somebody_listens(address)) {
    problem = "a node listens at " + path + " already";
    return nullptr;
  }
  struct stat status = {};
  if (::lstat(path.c_str(), &status) == 0 && S_ISSOCK(status.st_mode)) ::unlink(path.c_str());
  FileDescriptor listening(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const mode_t before = ::umask(0177);
  const bool is_bound = listening.is_open() && ::bind(listening.number(), general(address), sizeof address) == 0;
  ::umask(before);
  if (!is_bound || ::listen(listening.number(), static_cast<int>(most_clients)) != 0) {
    problem = what_failed("a control socket at " + path);
    return nullptr;
  }
  return std::unique_ptr<ControlSocket>(new ControlSocket(std::move(listening), path));
}

ControlSocket::~ControlSocket() { ::unlink(path_.c_str()); }

void ControlSocket::add_to(std::vector<pollfd>& waiting) const {
  waiting.push_back({listening_.number(), POLLIN, 0});
  for (const FileDescriptor& client : clients_) waiting.push_back({client.number(), POLLIN, 0});
}

void ControlSocket::accept_new() {
  for (;;) {
    FileDescriptor client(::accept4(listening_.number(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!client.is_open()) return;
    if (!is_permitted(client)) continue;
    if (clients_.size() == most_clients) clients_.erase(clients_.begin());
    clients_.push_back(std::move(client));
  }
}

std::optional<std::string> ControlSocket::next() {
  accept_new();
  std::array<char, most_octets_of_request> buffer;
  for (std::size_t i = 0; i < clients_.size();) {
    const ssize_t size = ::recv(clients_[i].number(), buffer.data(), buffer.size(), MSG_DONTWAIT | MSG_TRUNC);
    if (size < 0 && (errno == EAGAIN || errno == EINTR)) {
      ++i;
      continue;
    }
    asking_ = std::move(clients_[i]);
    clients_.erase(clients_.begin() + static_cast<std::ptrdiff_t>(i));
    if (size > 0 && static_cast<std::size_t>(size) <= buffer.size())
      return std::string(buffer.data(), static_cast<std::size_t>(size));
    if (size > 0) answer(R"({"error": "a request of more than 256 octets"})");
  }
  return std::nullopt;
}

/// What the client does not take at once is lost: the cycle does not wait for it.
void ControlSocket::answer(std::string_view text) {
  static_cast<void>(::send(asking_.number(), text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL));
  asking_ = FileDescriptor();
}

std::optional<std::string> ask_node(const std::string& node, std::string_view request, std::string& problem) {
  const std::string path = node.find('/') == std::string::npos ? default_control_path(node) : node;
  sockaddr_un address;
  if (!address_of(path, address, problem)) return std::nullopt;
  const FileDescriptor fd(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
  limit_connecting(fd);
  if (!fd.is_open() || ::connect(fd.number(), general(address), sizeof address) != 0) {
    problem = what_failed("no node at " + path);
    return std::nullopt;
  }
  if (::send(fd.number(), request.data(), request.size(), MSG_NOSIGNAL) < 0) {
    problem = what_failed("asking the node at " + path);
    return std::nullopt;
  }
  pollfd waiting{fd.number(), POLLIN, 0};
  std::string answer(most_octets_of_answer, '\0');
  const ssize_t size =
      ::poll(&waiting, 1, answer_timeout_ms) == 1 ? ::recv(fd.number(), answer.data(), answer.size(), MSG_DONTWAIT) : 0;
  if (size <= 0) {
    problem = "no answer from the node at " + path;
    return std::nullopt;
  }
  answer.resize(static_cast<std::size_t>(size));
  return answer;
}

}  // namespace takt::node
