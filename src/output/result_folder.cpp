#include "output/result_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "results/result_json.hpp"

namespace takt::output {
namespace {

/// RFC 4180: quoted where a separator, quote or line break stands inside.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string streams_csv(const results::RunResult& result) {
  std::string out = "stream,sent,copies,delivered,dropped,in_flight,min_ps,mean_ps,p50_ps,p99_ps,max_ps,stddev_ps\n";
  for (const results::StreamResult& s : result.streams) {
    out += fmt::format("{},{},{},{},{},{}", cell(s.name), s.sent, s.copies, s.delivered, s.dropped_in_all(), s.in_flight);
    if (s.latency)
      out += fmt::format(",{},{},{},{},{},{}\n", s.latency->min.ps(), s.latency->mean.ps(), s.latency->p50.ps(), s.latency->p99.ps(), s.latency->max.ps(),
                         s.latency->stddev.ps());
    else
      out += ",,,,,,\n";
  }
  return out;
}

std::string reactions_csv(const results::RunResult& result) {
  std::string out = "program,kind,initiator,cause,began_ps,completed_ps,duration_ps,superseded\n";
  for (const results::ProgramResult& p : result.programs)
    for (const results::ReactionResult& r : p.reactions)
      out += fmt::format("{},{},{},{},{},{},{},{}\n", cell(p.name), r.kind, cell(r.initiator), r.cause, r.began.ps(),
                         r.completed ? std::to_string(r.completed->ps()) : "", r.completed ? std::to_string(r.duration()->ps()) : "", r.superseded ? 1 : 0);
  return out;
}

std::string ports_csv(const results::RunResult& result) {
  std::string out = "node,port,peer,frames,dropped,queue_peak,utilisation\n";
  for (const results::PortResult& p : result.ports)
    out += fmt::format("{},{},{},{},{},{},{:.9f}\n", cell(p.node), p.port, cell(p.peer), p.frames, p.dropped, p.queue_peak, p.utilisation);
  return out;
}

std::string histograms_csv(const results::RunResult& result) {
  std::string out = "stream,from_ps,to_ps,count\n";
  for (const results::StreamResult& s : result.streams)
    for (const results::HistogramBucket& b : s.histogram) out += fmt::format("{},{},{},{}\n", cell(s.name), b.from.ps(), b.to.ps(), b.count);
  return out;
}

std::string failure(const std::string& path) { return fmt::format("{}: {}", path, std::strerror(errno)); }

}  // namespace

std::string write_file(const std::string& path, const std::string& content) {
  const std::string temporary = path + ".part";
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) return failure(temporary);
  std::size_t written = 0;
  bool good = true;
  while (good && written < content.size()) {
    const ssize_t n = ::write(file, content.data() + written, content.size() - written);
    if (n < 0 && errno == EINTR) continue;
    good = n > 0;
    if (good) written += static_cast<std::size_t>(n);
  }
  std::string problem = good && ::fsync(file) == 0 ? std::string() : failure(temporary);
  if (::close(file) != 0 && problem.empty()) problem = failure(temporary);
  if (problem.empty() && ::rename(temporary.c_str(), path.c_str()) != 0) problem = failure(path);
  if (!problem.empty()) ::unlink(temporary.c_str());
  return problem;
}

std::string write_result_folder(const std::string& folder, const results::RunResult& result, const std::string& resolved_scenario) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return folder + ": " + error.message();
  const std::filesystem::path base(folder);
  const std::pair<const char*, std::string> files[] = {
      {"scenario.json", resolved_scenario},      {"streams.csv", streams_csv(result)}, {"reactions.csv", reactions_csv(result)},
      {"ports.csv", ports_csv(result)},          {"histograms.csv", histograms_csv(result)},
      {"result.json", results::run_json(result)},  // last: where it is, everything is
  };
  for (const auto& [name, content] : files)
    if (std::string problem = write_file((base / name).string(), content); !problem.empty()) return problem;
  return {};
}

}  // namespace takt::output
