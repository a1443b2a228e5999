// SPDX-License-Identifier: Apache-2.0
// Connections of TCP as the server needs them: none of its calls waits.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "node/server_config.hpp"
#include "node/socket.hpp"

namespace takt::node {

class TcpConnection {
 public:
  TcpConnection(FileDescriptor fd, std::string source) : fd_(std::move(fd)), source_(std::move(source)) {}
  /// To a server; it may be there only when something can be sent. Nothing, and `problem` says why, if that cannot be.
  static std::optional<TcpConnection> connect(const EndpointAddress& to, std::string& problem);

  int file_descriptor() const { return fd_.number(); }
  /// "127.0.0.1:53412".
  const std::string& source() const { return source_; }
  /// Octets that have come: some, none so far, or the end.
  enum class Came : std::uint8_t { octets, nothing, end };
  Came receive(std::span<std::byte> buffer, std::size_t& octets) const;
  /// How many were taken; nothing if the connection is gone.
  std::optional<std::size_t> send(std::span<const std::byte> octets) const;
  /// What is wrong with it, as far as the operating system says.
  std::string problem() const;
  /// No more will be sent; what was, arrives.
  void end_sending() const;

 private:
  FileDescriptor fd_;
  std::string source_;
};

class TcpListener {
 public:
  /// Null, and `problem` says why.
  static std::unique_ptr<TcpListener> open(const EndpointAddress& address, std::string& problem);
  int file_descriptor() const { return fd_.number(); }
  /// The next one that has connected, if there is one.
  std::optional<TcpConnection> accept() const;

 private:
  explicit TcpListener(FileDescriptor fd) : fd_(std::move(fd)) {}
  FileDescriptor fd_;
};

}  // namespace takt::node
