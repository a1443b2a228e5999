// SPDX-License-Identifier: Apache-2.0
#include "output/written_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <utility>

#include "json/document.hpp"
#include "json/node.hpp"
#include "output/result_folder.hpp"

namespace takt::output {
namespace {

namespace fs = std::filesystem;

constexpr const char* manifest = "files.json";

/// The name of a file in the folder itself, whatever somebody may have written into files.json.
bool is_plain(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && name != manifest && name.find('/') == std::string::npos &&
         name.find('\0') == std::string::npos;
}

std::string text_of(const json::Node& object, std::string_view key) {
  const json::Node* const found = object.find(key);
  return found != nullptr && found->kind == json::Kind::string ? found->text : std::string();
}

/// 0 where there is none.
std::uint32_t number_of(const json::Node& object, std::string_view key) {
  const json::Node* const found = object.find(key);
  const auto number = found != nullptr && found->kind == json::Kind::number ? json::integer_of(*found) : std::nullopt;
  return number && *number > 0 && *number <= std::numeric_limits<std::uint32_t>::max()
             ? static_cast<std::uint32_t>(*number)
             : 0;
}

const std::vector<json::Node>& items_of(const json::Node& object, std::string_view key) {
  static const std::vector<json::Node> none;
  const json::Node* const found = object.find(key);
  return found != nullptr && found->kind == json::Kind::array ? found->items : none;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// As many names as a line or two hold; tables are many and speak for themselves.
std::string shortened(const std::vector<std::string>& names) {
  constexpr std::size_t most_characters = 160;
  std::vector<std::string> shown;
  std::size_t tables = 0, more = 0, characters = 0;
  for (const std::string& name : names) {
    if (name.ends_with(".csv"))
      ++tables;
    else if ((characters += name.size()) <= most_characters)
      shown.push_back(name);
    else
      ++more;
  }
  if (more > 0) shown.push_back(fmt::format("{} more", more));
  if (tables > 0) shown.push_back(fmt::format("{} table{} (.csv)", tables, tables == 1 ? "" : "s"));
  return listed(shown);
}

}  // namespace

std::string_view opened_in(std::string_view name) {
  if (name == "timeline.json") return "in ui.perfetto.dev";
  if (name.ends_with(".html")) return "in a browser";
  if (name.ends_with(".gtkw")) return "in GTKWave";
  if (name.ends_with(".pcapng")) return "in Wireshark, with takt.lua of tools/wireshark";
  return {};
}

WrittenFiles::WrittenFiles(std::string folder, std::string command, std::string input)
    : folder_(std::move(folder)), command_(std::move(command)), input_(std::move(input)) {
  read();
}

std::string WrittenFiles::path_of(const std::string& name) const { return (fs::path(folder_) / name).string(); }

std::vector<WrittenFiles::Entry> WrittenFiles::entries_in(const std::string& folder) {
  std::ifstream stream((fs::path(folder) / manifest).string(), std::ios::binary);
  if (!stream) return {};
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  json::Diagnostics unread;
  const auto document = json::parse(text, manifest, unread);
  if (!document || document->root().kind != json::Kind::object) return {};
  std::vector<Entry> entries;
  for (const json::Node& node : items_of(document->root(), "written")) {
    Entry entry{text_of(node, "command"),
                {text_of(node, "takt"), number_of(node, "behaviour")},
                text_of(node, "scenario"),
                text_of(node, "digest"),
                {}};
    for (const json::Node& file : items_of(node, "files"))
      if (file.kind == json::Kind::string && is_plain(file.text)) entry.files.push_back(file.text);
    entries.push_back(std::move(entry));
  }
  return entries;
}

void WrittenFiles::read() {
  for (Entry& entry : entries_in(folder_)) {
    if (entry.command == command_)
      older_ = std::move(entry.files);
    else
      others_.push_back(std::move(entry));
  }
}

bool WrittenFiles::is_input(const std::string& name) const {
  std::error_code error;
  return !input_.empty() && fs::equivalent(path_of(name), input_, error) && !error;
}

std::string WrittenFiles::remove(const std::string& name) const {
  if (::unlink(path_of(name).c_str()) == 0 || errno == ENOENT) return {};
  return path_of(name) + ": " + std::strerror(errno);
}

std::string WrittenFiles::begin() {
  constexpr const char* last = "result.json";
  return std::ranges::find(older_, last) != older_.end() && !is_input(last) ? remove(last) : std::string();
}

void WrittenFiles::add(std::string name) {
  if (std::ranges::find(files_, name) == files_.end()) files_.push_back(std::move(name));
}

bool WrittenFiles::add_if_inside(const std::string& path) {
  std::error_code error;
  const fs::path parent = fs::absolute(path, error).parent_path();
  if (error || !fs::equivalent(parent, folder_, error) || error) return false;
  add(fs::path(path).filename().string());
  return true;
}

std::string WrittenFiles::end(const std::string& scenario, std::optional<std::uint64_t> digest) {
  for (const std::string& name : older_) {
    const bool is_of_another = std::ranges::any_of(
        others_, [&](const Entry& each) { return std::ranges::find(each.files, name) != each.files.end(); });
    if (is_of_another || is_input(name) || std::ranges::find(files_, name) != files_.end()) continue;
    std::error_code error;
    const fs::file_status there = fs::symlink_status(path_of(name), error);
    if (!fs::exists(there) || fs::is_directory(there)) continue;
    if (std::string problem = remove(name); !problem.empty()) return problem;
    removed_.push_back(name);
  }
  json::Node root = json::Node::object();
  json::Node& written = root.add("written", json::Node::array());
  const auto tell = [&](const Entry& entry) {
    json::Node node = json::Node::object();
    node.add("command", json::Node::of_string(entry.command));
    node.add("takt", json::Node::of_string(entry.maker.version));
    if (entry.maker.behaviour > 0) node.add("behaviour", json::Node::of_integer(entry.maker.behaviour));
    node.add("scenario", json::Node::of_string(entry.scenario));
    if (!entry.digest.empty()) node.add("digest", json::Node::of_string(entry.digest));
    json::Node& files = node.add("files", json::Node::array());
    for (const std::string& name : entry.files) files.items.push_back(json::Node::of_string(name));
    written.items.push_back(std::move(node));
  };
  for (const Entry& other : others_) tell(other);
  tell({command_, results::this_takt(), scenario, digest ? fmt::format("{:016x}", *digest) : "", files_});
  return write_file(path_of(manifest), json::pretty(root));
}

std::string WrittenFiles::summary() const {
  if (files_.empty())
    return removed_.empty() ? std::string()
                            : fmt::format("Removed from {}, of an older run: {}\n", folder_, shortened(removed_));
  std::string text = fmt::format("Written to {}: {}\n", folder_, shortened(files_));
  std::vector<std::pair<std::string_view, std::vector<std::string>>> ways;
  for (const std::string& name : files_) {
    const std::string_view how = opened_in(name);
    if (how.empty()) continue;
    auto way = std::ranges::find(ways, how, &decltype(ways)::value_type::first);
    if (way == ways.end()) way = ways.insert(ways.end(), {how, {}});
    way->second.push_back(name);
  }
  std::string open;
  for (const auto& [how, names] : ways) open += fmt::format("{}{} {}", open.empty() ? "" : "; ", shortened(names), how);
  if (!open.empty()) text += "To open: " + open + "\n";
  if (!removed_.empty()) text += "Removed, of an older run: " + shortened(removed_) + "\n";
  for (const Entry& other : others_)
    if (const std::string difference =
            other.files.empty()
                ? std::string()
                : results::difference_to(other.maker, fmt::format("What takt {} wrote there", other.command));
        !difference.empty())
      text += difference + ": do not compare it with these files, make it anew\n";
  return text;
}

std::string made_by_another(const std::string& file) {
  const fs::path path(file);
  for (const WrittenFiles::Entry& entry :
       WrittenFiles::entries_in(path.has_parent_path() ? path.parent_path().string() : "."))
    if (std::ranges::find(entry.files, path.filename().string()) != entry.files.end())
      return results::difference_to(entry.maker, file);
  return {};
}

}  // namespace takt::output
