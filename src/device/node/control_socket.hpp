// SPDX-License-Identifier: Apache-2.0
// The control socket of a node: a Unix socket on which other processes of the machine call methods and ask for the
// status.
//
// SOCK_SEQPACKET; a request is one word, its answer one JSON object, and the node closes the connection behind it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "node/socket.hpp"

struct pollfd;

namespace takt::node {

/// Where a node of this name listens if its file does not say: takt-NAME.sock in $XDG_RUNTIME_DIR, as root in /run,
/// otherwise in /tmp/takt-UID. Octets of the name that have no place in a file name are written as %XX.
std::string default_control_path(std::string_view node);

class ControlSocket {
 public:
  /// Null, and `problem` says why, if it cannot be had: the path is too long, or somebody listens there already. A
  /// socket that a killed node has left is replaced. Only the user of the node, and root, may use it: its mode says so,
  /// and the credentials of each client.
  static std::unique_ptr<ControlSocket> open(const std::string& path, std::string& problem);
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  static constexpr std::size_t most_clients = 8;
  /// What poll has to wait for: the socket and its clients.
  void add_to(std::vector<pollfd>& waiting) const;

  /// The next request that has come, without waiting; `answer` must follow. Nothing if there is none.
  std::optional<std::string> next();
  void answer(std::string_view text);

 private:
  ControlSocket(FileDescriptor listening, std::string path)
      : listening_(std::move(listening)), path_(std::move(path)) {}
  void accept_new();

  FileDescriptor listening_;
  std::string path_;
  std::vector<FileDescriptor> clients_;  ///< oldest first; one that says nothing has to go when there are too many
  FileDescriptor asking_;
};

/// Asks a node. `node` is its name or, with a slash, the path of its socket. Nothing, and `problem` says why, if there
/// is no answer.
std::optional<std::string> ask_node(const std::string& node, std::string_view request, std::string& problem);

}  // namespace takt::node
