// SPDX-License-Identifier: Apache-2.0
#include "output/writable.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

namespace takt::output {
namespace {

namespace fs = std::filesystem;

std::string failure(const fs::path& path, int error) { return path.string() + ": " + std::strerror(error); }

/// What of a folder's path was not there; away again at the end.
class MadeFolders {
 public:
  explicit MadeFolders(const fs::path& folder) {
    std::vector<fs::path> missing;
    std::error_code unknown;
    for (fs::path each = folder; !each.empty() && !fs::exists(each, unknown) && each != each.parent_path();
         each = each.parent_path())
      missing.push_back(each);
    for (; !missing.empty(); missing.pop_back()) {
      if (::mkdir(missing.back().c_str(), 0755) == 0)
        made_.push_back(missing.back());
      else if (errno != EEXIST) {  // "a/.." is there as soon as "a" is
        problem_ = failure(missing.back(), errno);
        return;
      }
    }
    if (!fs::is_directory(folder, unknown)) problem_ = failure(folder, ENOTDIR);
  }
  MadeFolders(const MadeFolders&) = delete;
  MadeFolders& operator=(const MadeFolders&) = delete;
  ~MadeFolders() {
    for (; !made_.empty(); made_.pop_back()) ::rmdir(made_.back().c_str());
  }

  const std::string& problem() const { return problem_; }

 private:
  std::vector<fs::path> made_;
  std::string problem_;
};

/// A new file with one octet, since a full disk still has names. One that another command is about to write is left
/// alone.
std::string try_file(const fs::path& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (file < 0) return errno == EEXIST && ::access(path.c_str(), W_OK) == 0 ? std::string() : failure(path, errno);
  std::string problem = ::write(file, "\n", 1) == 1 ? std::string() : failure(path, errno);
  ::close(file);
  ::unlink(path.c_str());
  return problem;
}

/// Nothing is written: a device that takes nothing says so without it. Who opens a pipe only to close it ends it for
/// its reader.
std::string try_device(const fs::path& path, mode_t mode) {
  if (S_ISFIFO(mode)) return ::access(path.c_str(), W_OK) == 0 ? std::string() : failure(path, errno);
  if (!S_ISCHR(mode)) return path.string() + ": neither a file nor a pipe";
  const int file = ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (file < 0) return failure(path, errno);
  std::string problem = ::write(file, "", 0) == 0 ? std::string() : failure(path, errno);
  ::close(file);
  return problem;
}

/// In a folder such as /tmp a file is replaced by its owner only.
bool is_kept(const fs::path& folder, const struct stat& file) {
  struct stat around {};
  return ::stat(folder.c_str(), &around) == 0 && (around.st_mode & S_ISVTX) != 0 && ::geteuid() != 0 &&
         file.st_uid != ::geteuid() && around.st_uid != ::geteuid();
}

}  // namespace

std::string why_no_folder(const std::string& path) {
  fs::path folder(path);
  if (!folder.has_filename() && folder.has_parent_path()) folder = folder.parent_path();  // "out/"
  const MadeFolders made(folder);
  return made.problem().empty() ? try_file(folder / "takt.part") : made.problem();
}

std::string why_no_file(const std::string& path) {
  struct stat is {};
  const fs::path folder = fs::path(path).parent_path();
  if (::stat(path.c_str(), &is) == 0) {
    if (S_ISDIR(is.st_mode)) return failure(path, EISDIR);
    if (!S_ISREG(is.st_mode)) return try_device(path, is.st_mode);
    if (is_kept(folder.empty() ? "." : folder, is)) return failure(path, EPERM);
  }
  if (!fs::path(path).has_filename()) return failure(path, path.empty() ? ENOENT : EISDIR);
  const MadeFolders made(folder.empty() ? "." : folder);
  return made.problem().empty() ? try_file(path + ".part") : made.problem();
}

}  // namespace takt::output
