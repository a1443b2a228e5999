#include "studio/document.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "output/result_folder.hpp"

namespace takt::studio {
namespace {

std::optional<std::string> content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

}  // namespace

std::optional<std::string> Document::saved(std::string& problem) const {
  problem.clear();
  std::error_code error;
  if (!std::filesystem::exists(path_, error)) return std::nullopt;
  auto content = content_of(path_);
  if (!content) problem = path_ + ": " + std::strerror(errno);
  return content;
}

std::optional<std::string> Document::draft() const { return content_of(draft_path()); }

std::string Document::keep_draft(std::string_view text) {
  const std::lock_guard lock(mutex_);
  if (content_of(path_) == text) {
    std::error_code error;
    std::filesystem::remove(draft_path(), error);
    return {};
  }
  return output::write_file(draft_path(), std::string(text));
}

std::string Document::save(std::string_view text) {
  const std::lock_guard lock(mutex_);
  if (std::string problem = output::write_file(path_, std::string(text)); !problem.empty()) return problem;
  std::error_code error;
  std::filesystem::remove(draft_path(), error);
  return {};
}

}  // namespace takt::studio
