// SPDX-License-Identifier: Apache-2.0
#include "output/result_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "json/csv.hpp"
#include "output/streaming_file.hpp"
#include "results/result_json.hpp"

namespace takt::output {
namespace {

using json::Column;
using json::Row;

std::vector<Row> rows_by_name(const json::Node& objects) {
  std::vector<Row> rows;
  for (const json::Member& member : objects.members) rows.push_back({{member.key}, &member.value});
  return rows;
}

std::string streams_csv(const json::Node& result) {
  static constexpr std::string_view first[] = {"stream"};
  static constexpr Column columns[] = {{"sent", "/sent"},
                                       {"copies", "/copies"},
                                       {"delivered", "/delivered"},
                                       {"dropped", "/dropped/*"},
                                       {"in_flight", "/in_flight"},
                                       {"min_ps", "/latency_ps/min"},
                                       {"mean_ps", "/latency_ps/mean"},
                                       {"p50_ps", "/latency_ps/p50"},
                                       {"p99_ps", "/latency_ps/p99"},
                                       {"max_ps", "/latency_ps/max"},
                                       {"stddev_ps", "/latency_ps/stddev"}};
  return json::csv(first, columns, rows_by_name(*result.find("streams")));
}

std::string reactions_csv(const json::Node& result) {
  static constexpr std::string_view first[] = {"program"};
  static constexpr Column columns[] = {{"kind", "/kind"},
                                       {"initiator", "/initiator"},
                                       {"cause", "/cause"},
                                       {"began_ps", "/began_ps"},
                                       {"completed_ps", "/completed_ps"},
                                       {"duration_ps", "/duration_ps"},
                                       {"superseded", "/superseded"}};
  std::vector<Row> rows;
  for (const json::Member& program : result.find("programs")->members)
    for (const json::Node& reaction : program.value.find("reactions")->items)
      rows.push_back({{program.key}, &reaction});
  return json::csv(first, columns, rows);
}

std::string ports_csv(const json::Node& result) {
  static constexpr Column columns[] = {{"node", "/node"},
                                       {"port", "/port"},
                                       {"peer", "/peer"},
                                       {"frames", "/frames"},
                                       {"dropped", "/dropped"},
                                       {"queue_peak", "/queue_peak"},
                                       {"utilisation", "/utilisation"}};
  std::vector<Row> rows;
  for (const json::Node& port : result.find("ports")->items) rows.push_back({{}, &port});
  return json::csv({}, columns, rows);
}

std::string queues_csv(const json::Node& result) {
  static constexpr Column columns[] = {{"node", "/node"},   {"port", "/port"},     {"peer", "/peer"},
                                       {"class", "/class"}, {"frames", "/frames"}, {"octets", "/octets"}};
  std::vector<Row> rows;
  for (const json::Node& queue : result.find("queues")->items) rows.push_back({{}, &queue});
  return json::csv({}, columns, rows);
}

std::string histograms_csv(const results::RunResult& result) {
  static constexpr std::string_view first[] = {"stream", "from_ps", "to_ps", "count"};
  std::vector<Row> rows;
  for (const results::StreamResult& s : result.streams)
    for (const results::HistogramBucket& b : s.histogram)
      rows.push_back(
          {{s.name, std::to_string(b.from.ps()), std::to_string(b.to.ps()), std::to_string(b.count)}, nullptr});
  return json::csv(first, {}, rows);
}

std::string failure(const std::string& path) { return fmt::format("{}: {}", path, std::strerror(errno)); }

}  // namespace

std::string write_file(const std::string& path, const std::string& content) {
  namespace fs = std::filesystem;
  std::error_code untold, error;
  fs::path to(path);
  const bool is_stream = fs::is_character_file(to, untold) || fs::is_fifo(to, untold);
  if (!is_stream && fs::is_symlink(to, untold))
    to = fs::weakly_canonical(to, error);  // what it names is replaced, not the link
  if (!error && to.has_parent_path()) fs::create_directories(to.parent_path(), error);
  if (error) return path + ": " + error.message();
  const std::string temporary = is_stream ? to.string() : to.string() + ".part";
  const int file = is_stream ? ::open(temporary.c_str(), O_WRONLY | O_CLOEXEC) : open_part(temporary, to.string());
  if (file < 0) return failure(temporary);
  std::size_t written = 0;
  bool good = true;
  while (good && written < content.size()) {
    const ssize_t n = ::write(file, content.data() + written, content.size() - written);
    if (n < 0 && errno == EINTR) continue;
    good = n > 0;
    if (good) written += static_cast<std::size_t>(n);
  }
  std::string problem = good && (is_stream || ::fsync(file) == 0) ? std::string() : failure(temporary);
  if (::close(file) != 0 && problem.empty()) problem = failure(temporary);
  if (is_stream) return problem;
  if (problem.empty() && ::rename(temporary.c_str(), to.c_str()) != 0) problem = failure(to.string());
  if (!problem.empty()) ::unlink(temporary.c_str());
  return problem;
}

std::string write_result_folder(WrittenFiles& folder, const results::RunResult& result,
                                const std::string& resolved_scenario) {
  std::error_code error;
  std::filesystem::create_directories(folder.folder(), error);
  if (error) return folder.folder() + ": " + error.message();
  const json::Node node = results::run_node(result);
  const std::pair<const char*, std::string> files[] = {
      {"scenario.json", resolved_scenario},   {"streams.csv", streams_csv(node)},
      {"reactions.csv", reactions_csv(node)}, {"ports.csv", ports_csv(node)},
      {"queues.csv", queues_csv(node)},       {"histograms.csv", histograms_csv(result)},
  };
  for (const auto& [name, content] : files) {
    if (std::string problem = write_file(folder.path_of(name), content); !problem.empty()) return problem;
    folder.add(name);
  }
  folder.add("result.json");
  if (std::string problem = folder.end(result.scenario, result.digest); !problem.empty()) return problem;
  return write_file(folder.path_of("result.json"), json::pretty(node));  // last: where it is, everything is
}

}  // namespace takt::output
