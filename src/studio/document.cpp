#include "studio/document.hpp"

#include <unistd.h>

#include <algorithm>
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

std::string Document::layout() const { return content_of(layout_path()).value_or(std::string()); }

std::string Document::keep_layout(std::string_view text) {
  const std::lock_guard lock(mutex_);
  if (text.empty()) {
    std::error_code error;
    std::filesystem::remove(layout_path(), error);
    return {};
  }
  return output::write_file(layout_path(), std::string(text));
}

std::shared_ptr<const std::string> Document::aside(std::string_view text) {
  const std::lock_guard lock(mutex_);
  const std::filesystem::path path(path_);
  std::string name = (path.parent_path() / ("." + path.filename().string() + ".asked-" + std::to_string(::getpid()) + "-" + std::to_string(++asides_))).string();
  if (!output::write_file(name, std::string(text)).empty()) return nullptr;
  return {new std::string(std::move(name)), [](const std::string* each) {
            std::error_code error;
            std::filesystem::remove(*each, error);
            delete each;
          }};
}

std::vector<std::string> Document::studies() const {
  constexpr std::size_t most = 200;
  constexpr std::uintmax_t greatest = 1'000'000;
  std::vector<std::string> found;
  const std::filesystem::path folder = std::filesystem::absolute(path_).parent_path();
  for (const std::filesystem::path& place : {folder, folder / "studies"}) {
    std::error_code error;
    for (std::filesystem::directory_iterator each(place, std::filesystem::directory_options::skip_permission_denied, error); !error && each != std::filesystem::directory_iterator(); each.increment(error)) {
      std::error_code other;
      if (found.size() == most || each->path().extension() != ".json" || !each->is_regular_file(other) || each->file_size(other) > greatest) continue;
      const auto content = content_of(each->path().string());
      if (content && content->find("\"factors\"") != std::string::npos && content->find("\"measures\"") != std::string::npos) found.push_back(std::filesystem::relative(each->path(), folder, other).string());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string Document::path_of(std::string_view beside) const { return (std::filesystem::path(path_).parent_path() / beside).string(); }

}  // namespace takt::studio
