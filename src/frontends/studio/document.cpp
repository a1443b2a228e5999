// SPDX-License-Identifier: Apache-2.0
#include "studio/document.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>

#include "output/result_folder.hpp"
#include "sim/digest.hpp"

namespace takt::studio {
namespace {

std::optional<std::string> content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r\n") == std::string_view::npos; }

}  // namespace

std::optional<std::string> Document::saved(std::string& problem) const {
  problem.clear();
  std::error_code error;
  if (!std::filesystem::exists(path_, error)) return std::nullopt;
  auto content = content_of(path_);
  if (!content) problem = path_ + ": " + std::strerror(errno);
  return content;
}

std::string Document::digest_of(std::string_view text) {
  std::uint64_t hash = sim::hash_of(std::as_bytes(std::span(text)));
  std::string digits(16, '0');
  for (std::size_t place = digits.size(); place-- > 0; hash >>= 4) digits[place] = "0123456789abcdef"[hash & 15];
  return digits;
}

std::string Document::digest() const {
  const std::lock_guard lock(digest_mutex_);
  struct stat file {};
  if (::stat(path_.c_str(), &file) != 0) {
    known_ = {};
    return digest_ = {};
  }
  const Known now{std::int64_t{file.st_mtim.tv_sec} * 1'000'000'000 + file.st_mtim.tv_nsec,
                  static_cast<std::uint64_t>(file.st_size), file.st_ino};
  if (now == known_) return digest_;
  const auto content = content_of(path_);
  known_ = content ? now : Known{};
  return digest_ = content ? digest_of(*content) : std::string();
}

std::optional<std::string> Document::draft() const { return content_of(draft_path()); }

bool Document::is_newer_than_draft() const {
  std::error_code of_file;
  std::error_code of_draft;
  const auto file = std::filesystem::last_write_time(path_, of_file);
  const auto draft = std::filesystem::last_write_time(draft_path(), of_draft);
  return !of_file && !of_draft && file > draft;
}

std::string Document::keep_draft(std::string_view text, std::string_view base) {
  const std::lock_guard lock(mutex_);
  if (is_blank(text)) return {};
  std::error_code error;
  if (content_of(path_) == text) {
    std::filesystem::remove(draft_path(), error);
    return {};
  }
  if (std::string problem = output::write_file(draft_path(), std::string(text)); !problem.empty()) return problem;
  // It rests on an older file: its time says so, also to the engine that comes after this one.
  if (base != digest())
    if (const auto file = std::filesystem::last_write_time(path_, error); !error)
      std::filesystem::last_write_time(draft_path(), file - std::chrono::seconds(1), error);
  return {};
}

Document::Saved Document::save(std::string_view text, std::string_view base, bool may_empty) {
  const std::lock_guard lock(mutex_);
  const auto content = content_of(path_);
  if (content && *content != text && digest_of(*content) != base) return {.is_conflict = true};
  if (content && !is_blank(*content) && is_blank(text) && !may_empty) return {.empties = true};
  if (std::string problem = output::write_file(path_, std::string(text)); !problem.empty())
    return {.problem = std::move(problem)};
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
  std::string name = (path.parent_path() / ("." + path.filename().string() + ".asked-" + std::to_string(::getpid()) +
                                            "-" + std::to_string(++asides_)))
                         .string();
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
    for (std::filesystem::directory_iterator each(place, std::filesystem::directory_options::skip_permission_denied,
                                                  error);
         !error && each != std::filesystem::directory_iterator(); each.increment(error)) {
      std::error_code other;
      if (found.size() == most || each->path().extension() != ".json" || !each->is_regular_file(other) ||
          each->file_size(other) > greatest)
        continue;
      const auto content = content_of(each->path().string());
      if (content && content->find("\"factors\"") != std::string::npos &&
          content->find("\"measures\"") != std::string::npos)
        found.push_back(std::filesystem::relative(each->path(), folder, other).string());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string Document::path_of(std::string_view beside) const {
  return (std::filesystem::path(path_).parent_path() / beside).string();
}

}  // namespace takt::studio
