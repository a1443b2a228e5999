#include "node/socket.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace takt::node {

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}

FileDescriptor::~FileDescriptor() {
  if (number_ >= 0) ::close(number_);
}

std::string what_failed(const std::string& what) { return what + ": " + std::strerror(errno); }

}  // namespace takt::node
