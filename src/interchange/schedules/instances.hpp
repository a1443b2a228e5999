// Instances from files: what a file is, its content says.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "json/diagnostics.hpp"
#include "schedule/problem.hpp"

namespace takt::interchange::schedules {

/// A text with its name, for diagnostics.
struct TextFile {
  std::string name;
  std::string text;
};

/// Whether the file is an instance of a scheduling problem, or a part of one, in a format that is read here; false: something else, a scenario perhaps.
bool is_instance(const std::string& path);

/// Reads files one after the other. Formats that keep network and streams apart need two: a network counts for all sets of streams that follow, or, if it comes first, for the set of
/// streams before it.
class InstanceReader {
 public:
  explicit InstanceReader(std::vector<std::string> paths) : paths_(std::move(paths)) {}
  explicit InstanceReader(std::vector<TextFile> texts);
  /// The next instance; nothing at the end, or where something is wrong with it, which is told.
  std::optional<schedule::Problem> next(json::Diagnostics& diagnostics);
  bool is_at_end() const { return at_ >= paths_.size(); }

 private:
  TextFile text(const std::string& path) const;

  std::vector<std::string> paths_;
  std::vector<TextFile> texts_;          ///< instead of files
  std::size_t at_ = 0;
  std::optional<std::string> network_;   ///< path of the network that counts
};

}  // namespace takt::interchange::schedules
