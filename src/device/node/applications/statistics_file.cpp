// SPDX-License-Identifier: Apache-2.0
#include "node/applications/statistics_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace takt::node {
namespace {

std::string temporary_of(const std::string& path) { return path + ".tmp"; }

bool is_plain(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  return !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
}

std::string write_to(const std::string& path, const std::string& text) {
  std::FILE* const file = std::fopen(path.c_str(), "w");
  if (file == nullptr) return std::strerror(errno);
  std::string problem = std::fputs(text.c_str(), file) >= 0 ? "" : std::strerror(errno);
  if (std::fclose(file) != 0 && problem.empty()) problem = std::strerror(errno);
  return problem;
}

}  // namespace

std::string statistics_problem(const std::string& path) {
  if (std::filesystem::is_directory(path)) return std::strerror(EISDIR);
  if (!is_plain(path)) return ::access(path.c_str(), W_OK) == 0 ? "" : std::strerror(errno);
  const std::string problem = write_to(temporary_of(path), "");
  if (problem.empty()) ::unlink(temporary_of(path).c_str());
  return problem;
}

bool check_statistics(const ApplicationsConfig& config, json::Diagnostics& diagnostics) {
  if (!config.statistics) return true;
  const std::string problem = statistics_problem(*config.statistics);
  if (problem.empty()) return true;
  diagnostics.error(
      config.where.at("statistics"), "a file that cannot be written",
      {json::quote(*config.statistics) + ": " + problem, "a path in a folder that is there and may be written to"});
  return false;
}

std::string write_statistics(const std::string& path, const std::string& text) {
  if (!is_plain(path)) return write_to(path, text);
  const std::string temporary = temporary_of(path);
  std::string problem = write_to(temporary, text);
  if (problem.empty() && std::rename(temporary.c_str(), path.c_str()) != 0) problem = std::strerror(errno);
  if (!problem.empty()) ::unlink(temporary.c_str());
  return problem;
}

}  // namespace takt::node
