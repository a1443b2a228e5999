// SPDX-License-Identifier: Apache-2.0
#include "schedule_instances/instances.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "schedule_instances/formats.hpp"
#include "sim/check.hpp"

namespace takt::schedule_instances {
namespace {

struct File {
  std::string path;
  Content content = Content::other;
  std::optional<json::Document> document;
  std::optional<XmlElement> element;  ///< the one at the top
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
  if (nodes != nullptr && nodes->kind == json::Kind::array &&
      (root.find("links") != nullptr || root.find("edges") != nullptr) && !nodes->items.empty() &&
      nodes->items.front().find("is_switch") != nullptr)
    return Content::bench_topology;
  if (!root.members.empty() && root.members.front().value.kind == json::Kind::object &&
      has(root.members.front().value, {"sources", "destinations", "cycle_time_ns"}))
    return Content::bench_streams;
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
  if (text[first] == '<') {
    json::Diagnostics unheard;
    auto elements = parse_xml(text, path, unheard);
    if (!elements || elements->size() != 1) return file;
    file.element = std::move(elements->front());
    if (file.element->name == "graphml")
      file.content = Content::graphml_network;
    else if (file.element->name == "Applications" ||
             std::ranges::any_of(file.element->children,
                                 [](const XmlElement& each) { return each.name.ends_with("Application"); }))
      file.content = Content::graphml_applications;
    return file;
  }
  const std::string_view line = text.substr(first, text.find('\n', first) - first);
  if (line.find("stream") != std::string_view::npos && line.find("dst") != std::string_view::npos &&
      line.find(',') != std::string_view::npos)
    file.content = Content::tsnkit_tasks;
  else if (line.find("link") != std::string_view::npos && line.find("t_proc") != std::string_view::npos)
    file.content = Content::tsnkit_topology;
  else if (text.find(".trafficClass") != std::string_view::npos && text.find(".path") != std::string_view::npos)
    file.content = Content::ecrts;
  return file;
}

/// Of formats that keep network and streams apart.
struct Pair {
  Content network;
  Content streams;
  const char* files;  ///< in words
};
constexpr Pair pairs[] = {
    {Content::bench_topology, Content::bench_streams, "TOPOLOGY.top STREAMS.pat"},
    {Content::tsnkit_topology, Content::tsnkit_tasks, "TASK.csv TOPOLOGY.csv"},
    {Content::graphml_network, Content::graphml_applications, "NETWORK.graphml APPLICATIONS.xml"},
};
const Pair* pair_of_streams(Content content) {
  const Pair* const found = std::ranges::find(pairs, content, &Pair::streams);
  return found == std::end(pairs) ? nullptr : found;
}
bool is_network(Content content) { return std::ranges::find(pairs, content, &Pair::network) != std::end(pairs); }
bool fits(Content network, Content streams) {
  const Pair* const pair = pair_of_streams(streams);
  return pair != nullptr && pair->network == network;
}

void report_problems(const File& file, json::Diagnostics& diagnostics) {
  const std::size_t first = file.text.text.find_first_not_of(" \t\r\n");
  const char begins = first == std::string::npos ? '\0' : file.text.text[first];
  if (begins == '{' && !file.document)
    json::parse(file.text.text, file.path, diagnostics);
  else if (begins == '<' && !file.element)
    parse_xml(file.text.text, file.path, diagnostics);
  if (diagnostics.has_errors()) return;
  diagnostics.error(
      {file.path, 1, 1, ""}, "not an instance of a format that is read here",
      {file.text.text.empty() ? "nothing that can be read" : "something else",
       "TAS_Benchmark, TSNBenchScenarios, tsnkit, TSNsched, ECRTS'25, GraphML with applications or a neutral problem"});
}

Instance read_file(const File& file, const std::optional<File>& network, const GraphmlAssumptions& assumptions,
                   json::Diagnostics& diagnostics) {
  switch (file.content) {
    case Content::bench_streams:
      return read_tsn_bench_scenario(*network->document, *file.document, diagnostics);
    case Content::tsnkit_tasks:
      return read_tsnkit(file.text, network->text, diagnostics);
    case Content::graphml_applications:
      return read_graphml(*network->element, *file.element, stem_of(file.path), assumptions, diagnostics);
    case Content::neutral:
      return read_neutral(*file.document, diagnostics);
    case Content::tas_benchmark:
      return read_tas_benchmark(*file.document, diagnostics);
    case Content::tsnsched:
      return read_tsnsched(*file.document, diagnostics);
    case Content::ecrts:
      return read_ecrts(file.text, diagnostics);
    case Content::other:
    case Content::bench_topology:
    case Content::tsnkit_topology:
    case Content::graphml_network:
      break;
  }
  TAKT_CHECK(false, "only streams and whole instances are read");
  return {};
}

}  // namespace

Content content_of(const TextFile& file) { return look_at(file).content; }

std::string stem_of(std::string_view path) { return std::filesystem::path(path).stem().string(); }

bool is_instance(const std::string& path) { return content_of({path, read_text(path)}) != Content::other; }

InstanceReader::InstanceReader(std::vector<TextFile> texts, GraphmlAssumptions assumptions)
    : assumptions_(assumptions), texts_(std::move(texts)) {
  for (const TextFile& each : texts_) paths_.push_back(each.name);
}

TextFile InstanceReader::text(const std::string& path) const {
  for (const TextFile& each : texts_)
    if (each.name == path) return each;
  return {path, read_text(path)};
}

std::optional<schedule::Problem> InstanceReader::next(json::Diagnostics& diagnostics) {
  auto instance = next_instance(diagnostics);
  return instance ? std::optional(std::move(instance->problem)) : std::nullopt;
}

std::optional<Instance> InstanceReader::next_instance(json::Diagnostics& diagnostics) {
  while (at_ < paths_.size()) {
    File file = look_at(text(paths_[at_++]));
    if (is_network(file.content)) {
      network_ = file.path;
      continue;
    }
    if (file.content == Content::other) {
      report_problems(file, diagnostics);
      return std::nullopt;
    }
    std::optional<File> network;
    if (const Pair* const pair = pair_of_streams(file.content)) {
      // The network that stands before it, or next to it behind.
      if (at_ < paths_.size()) network = look_at(text(paths_[at_]));
      if (network && fits(network->content, file.content) &&
          (!network_ || !fits(look_at(text(*network_)).content, file.content)))
        ++at_;
      else
        network = network_ ? std::optional(look_at(text(*network_))) : std::nullopt;
      if (!network || !fits(network->content, file.content)) {
        diagnostics.error({file.path, 1, 1, ""}, "streams without their network",
                          {"no network beside them", pair->files});
        return std::nullopt;
      }
      network_ = network->path;
    }
    Instance instance = read_file(file, network, assumptions_, diagnostics);
    instance.places.whole = {file.path, 1, 1, ""};
    if (!diagnostics.has_errors() && instance.problem.streams.empty())
      diagnostics.error({file.path, 1, 1, ""}, "no streams to schedule");
    if (diagnostics.has_errors()) return std::nullopt;
    return instance;
  }
  return std::nullopt;
}

}  // namespace takt::schedule_instances
