// SPDX-License-Identifier: Apache-2.0
#include "output/streaming_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

namespace takt::output {

int open_part(const std::string& temporary, const std::string& target) {
  struct stat status = {};
  const bool replaces = ::stat(target.c_str(), &status) == 0 && S_ISREG(status.st_mode);
  ::unlink(temporary.c_str());  // of a process that was killed
  const int file =
      ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, replaces ? 0600 : 0644);
  if (file >= 0 && replaces) ::fchmod(file, status.st_mode & 0777);
  return file;
}

StreamingFile::StreamingFile(std::string path) : path_(std::move(path)), temporary_(path_ + ".part") {
  buffer_.reserve(buffer_size);
  file_ = open_part(temporary_, path_);
  if (file_ < 0) fail(temporary_);
}

StreamingFile::~StreamingFile() {
  if (file_ < 0) return;
  ::close(file_);
  ::unlink(temporary_.c_str());
}

void StreamingFile::write(std::string_view text) {
  if (!problem_.empty()) return;
  buffer_.append(text);
  if (buffer_.size() >= buffer_size) flush();
}

std::string StreamingFile::close() {
  if (file_ < 0) return problem_;
  flush();
  if (problem_.empty() && ::fsync(file_) != 0) fail(temporary_);
  if (::close(std::exchange(file_, -1)) != 0) fail(temporary_);
  if (problem_.empty() && ::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_);
  if (!problem_.empty()) ::unlink(temporary_.c_str());
  return problem_;
}

void StreamingFile::flush() {
  std::size_t written = 0;
  while (problem_.empty() && written < buffer_.size()) {
    const ssize_t n = ::write(file_, buffer_.data() + written, buffer_.size() - written);
    if (n > 0) written += static_cast<std::size_t>(n);
    if (n < 0 && errno != EINTR) fail(temporary_);
  }
  buffer_.clear();
}

void StreamingFile::fail(const std::string& path) {
  if (problem_.empty()) problem_ = path + ": " + std::strerror(errno);
}

}  // namespace takt::output
