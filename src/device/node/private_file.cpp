// SPDX-License-Identifier: Apache-2.0
#include "node/private_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "node/socket.hpp"
#include "security/secret.hpp"

namespace takt::node {
namespace {

constexpr std::size_t longest_private_file = std::size_t{1} << 20;

/// What is in the way of trusting the file; "" if nothing is.
std::string distrust(int file) {
  struct stat status = {};
  if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return "no regular file";
  if (status.st_uid != ::geteuid() && status.st_uid != 0) return "a file of another user";
  if ((status.st_mode & 077) != 0) return "a file that others than its owner may read or write";
  return static_cast<std::size_t>(status.st_size) > longest_private_file ? "a file of more than 1 MiB" : "";
}

}  // namespace

void wipe(std::string& text) { security::wipe(std::as_writable_bytes(std::span(text))); }

std::string beside(const json::Place& named_at, const std::string& path) {
  const std::size_t slash = named_at.file.rfind('/');
  return (path.starts_with('/') || slash == std::string::npos ? "" : named_at.file.substr(0, slash + 1)) + path;
}

std::optional<std::string> read_private(const std::string& path, const std::string& what, const json::Place& named_at,
                                        json::Diagnostics& diagnostics) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  const std::string problem = file.is_open() ? distrust(file.number()) : what_failed("a file that cannot be read");
  if (!problem.empty()) {
    diagnostics.error(named_at, what + " in " + json::quote(path),
                      {problem, "a file of this user or of root with mode 0600 or 0400"});
    return std::nullopt;
  }
  std::string text(longest_private_file, '\0');
  std::size_t size = 0;
  for (ssize_t taken = 1; taken > 0 && size<text.size(); size += taken> 0 ? static_cast<std::size_t>(taken) : 0)
    taken = ::read(file.number(), text.data() + size, text.size() - size);
  text.resize(size);
  return text;
}

}  // namespace takt::node
