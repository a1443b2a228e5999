// SPDX-License-Identifier: Apache-2.0
// Instances from files: what a file is, its content says.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "schedule_instances/builder.hpp"
#include "json/diagnostics.hpp"
#include "schedule/problem.hpp"

namespace takt::schedule_instances {

/// A text with its name, for diagnostics.
struct TextFile {
  std::string name;
  std::string text;
};

/// What files of GraphML and applications do not say.
struct GraphmlAssumptions {
  std::int64_t rate = 1'000'000'000;       ///< of all links, bit/s
  schedule::Ps hyperperiod = 500'000'000;  ///< to which the frequency of a time-triggered application refers
  bool with_avb = false;                   ///< applications of AVB are scheduled, too: a burst each 125 us or 250 us
};

enum class Content : std::uint8_t {
  other,
  neutral,
  tas_benchmark,
  tsnsched,
  bench_topology,
  bench_streams,
  tsnkit_tasks,
  tsnkit_topology,
  ecrts,
  graphml_network,
  graphml_applications
};
Content content_of(const TextFile& file);

/// Whether the file is an instance of a scheduling problem, or a part of one, in a format that is read here; false:
/// something else, a scenario perhaps.
bool is_instance(const std::string& path);

/// Reads files one after the other. Formats that keep network and streams apart need two: a network counts for all sets
/// of streams that follow, or, if it comes first, for the set of streams before it.
class InstanceReader {
 public:
  explicit InstanceReader(std::vector<std::string> paths) : paths_(std::move(paths)) {}
  explicit InstanceReader(std::vector<TextFile> texts, GraphmlAssumptions assumptions = {});
  /// The next instance; nothing at the end, or where something is wrong with it, which is told.
  std::optional<schedule::Problem> next(json::Diagnostics& diagnostics);
  /// The same, with the places of its parts.
  std::optional<Instance> next_instance(json::Diagnostics& diagnostics);
  bool is_at_end() const { return at_ >= paths_.size(); }

 private:
  TextFile text(const std::string& path) const;

  std::vector<std::string> paths_;
  GraphmlAssumptions assumptions_;
  std::vector<TextFile> texts_;  ///< instead of files
  std::size_t at_ = 0;
  std::optional<std::string> network_;  ///< path of the network that counts
};

}  // namespace takt::schedule_instances
