#include "interchange/schedules/instances.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "interchange/schedules/formats.hpp"

namespace takt::interchange::schedules {
namespace {

enum class Content : std::uint8_t { other, neutral, tas_benchmark, tsnsched, bench_topology, bench_streams, tsnkit_tasks, tsnkit_topology, ecrts };

struct File {
  std::string path;
  Content content = Content::other;
  std::optional<json::Document> document;
  TextFile text;
};

std::string read_text(const std::string& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error || size > json::max_text_size) return {};
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

bool has(const json::Node& node, std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys)
    if (node.find(key) == nullptr) return false;
  return true;
}

Content content_of(const json::Node& root) {
  if (root.kind != json::Kind::object) return Content::other;
  const json::Node* const format = root.find("format");
  if (format != nullptr && format->text == "schedule-problem-1") return Content::neutral;
  if (has(root, {"streams", "nodes", "links/ports"})) return Content::tas_benchmark;
  if (has(root, {"switches", "devices", "flows"})) return Content::tsnsched;
  const json::Node* const nodes = root.find("nodes");
  if (nodes != nullptr && nodes->kind == json::Kind::array && (root.find("links") != nullptr || root.find("edges") != nullptr) && !nodes->items.empty() && nodes->items.front().find("is_switch") != nullptr)
    return Content::bench_topology;
  if (!root.members.empty() && root.members.front().value.kind == json::Kind::object && has(root.members.front().value, {"sources", "destinations", "cycle_time_ns"})) return Content::bench_streams;
  return Content::other;
}

File look_at(TextFile of) {
  File file;
  file.path = of.name;
  file.text = std::move(of);
  const std::string& path = file.path;
  const std::string_view text = file.text.text;
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return file;
  if (text[first] == '{') {
    json::Diagnostics unheard;
    file.document = json::parse(text, path, unheard);
    if (file.document) file.content = content_of(file.document->root());
    return file;
  }
  const std::string_view line = text.substr(first, text.find('\n', first) - first);
  if (line.find("stream") != std::string_view::npos && line.find("dst") != std::string_view::npos && line.find(',') != std::string_view::npos) file.content = Content::tsnkit_tasks;
  else if (line.find("link") != std::string_view::npos && line.find("t_proc") != std::string_view::npos) file.content = Content::tsnkit_topology;
  else if (text.find(".trafficClass") != std::string_view::npos && text.find(".path") != std::string_view::npos) file.content = Content::ecrts;
  return file;
}

bool is_network(Content content) { return content == Content::bench_topology || content == Content::tsnkit_topology; }
bool fits(Content network, Content streams) {
  return (network == Content::bench_topology && streams == Content::bench_streams) || (network == Content::tsnkit_topology && streams == Content::tsnkit_tasks);
}

}  // namespace

std::string stem_of(std::string_view path) { return std::filesystem::path(path).stem().string(); }

bool is_instance(const std::string& path) { return look_at({path, read_text(path)}).content != Content::other; }

InstanceReader::InstanceReader(std::vector<TextFile> texts) : texts_(std::move(texts)) {
  for (const TextFile& each : texts_) paths_.push_back(each.name);
}

TextFile InstanceReader::text(const std::string& path) const {
  for (const TextFile& each : texts_)
    if (each.name == path) return each;
  return {path, read_text(path)};
}

std::optional<schedule::Problem> InstanceReader::next(json::Diagnostics& diagnostics) {
  while (at_ < paths_.size()) {
    File file = look_at(text(paths_[at_++]));
    if (is_network(file.content)) {
      network_ = file.path;
      continue;
    }
    if (file.content == Content::other) {
      const std::size_t first = file.text.text.find_first_not_of(" \t\r\n");
      if (!file.document && first != std::string::npos && file.text.text[first] == '{') json::parse(file.text.text, file.path, diagnostics);
      else diagnostics.error({file.path, 0, 0, ""}, "not an instance of a format that is read here", {file.text.text.empty() ? "nothing that can be read" : "something else", "TAS_Benchmark, TSNBenchScenarios, tsnkit, TSNsched, ECRTS'25 or a neutral problem"});
      return std::nullopt;
    }
    std::optional<schedule::Problem> problem;
    if (file.content == Content::bench_streams || file.content == Content::tsnkit_tasks) {
      // The network that stands before it, or next to it behind.
      std::optional<File> network;
      if (at_ < paths_.size()) network = look_at(text(paths_[at_]));
      if (network && fits(network->content, file.content) && (!network_ || !fits(look_at(text(*network_)).content, file.content))) ++at_;
      else network = network_ ? std::optional(look_at(text(*network_))) : std::nullopt;
      if (!network || !fits(network->content, file.content)) {
        diagnostics.error({file.path, 0, 0, ""}, "streams without their network", {"no network beside them", file.content == Content::bench_streams ? "TOPOLOGY.top STREAMS.pat" : "TASK.csv TOPOLOGY.csv"});
        return std::nullopt;
      }
      if (file.content == Content::bench_streams) {
        network_ = network->path;
        problem = read_tsn_bench_scenario(*network->document, *file.document, diagnostics);
      } else {
        problem = read_tsnkit(file.text, network->text, diagnostics);
      }
    } else if (file.content == Content::neutral) {
      problem = read_neutral(*file.document, diagnostics);
    } else if (file.content == Content::tas_benchmark) {
      problem = read_tas_benchmark(*file.document, diagnostics);
    } else if (file.content == Content::tsnsched) {
      problem = read_tsnsched(*file.document, diagnostics);
    } else {
      problem = read_ecrts(file.text, diagnostics);
    }
    if (!diagnostics.has_errors() && problem->streams.empty()) diagnostics.error({file.path, 0, 0, ""}, "no streams to schedule");
    if (diagnostics.has_errors()) return std::nullopt;
    return problem;
  }
  return std::nullopt;
}

}  // namespace takt::interchange::schedules
