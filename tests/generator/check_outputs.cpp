// SPDX-License-Identifier: Apache-2.0
#include "tests/generator/check_outputs.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "interchange/format.hpp"
#include "interchange/linux/script.hpp"
#include "xml/xml.hpp"
#include "json/document.hpp"
#include "output/recording.hpp"
#include "output/result_folder.hpp"
#include "output/text_report.hpp"
#include "report/run_page.hpp"
#include "results/result_json.hpp"
#include "scenario/run/run.hpp"

namespace takt::generator {
namespace {

namespace fs = std::filesystem;

struct Mistake : std::runtime_error {
  using std::runtime_error::runtime_error;
};
void expect_output(bool holds, const std::string& message) {
  if (!holds) throw Mistake(message);
}

/// A folder that is gone afterwards.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("takt-outputs-" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  std::string name() const { return path_.string(); }
  std::string text_of(const std::string& file) const {
    std::ostringstream text;
    text << std::ifstream(path_ / file, std::ios::binary).rdbuf();
    return text.str();
  }

 private:
  fs::path path_;
};

/// The rows of a table by RFC 4180, the heading first.
std::vector<std::vector<std::string>> rows_of(const std::string& text, const std::string& file) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row(1);
  bool is_quoted = false, was_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_quoted) {
      if (c != '"')
        row.back() += c;
      else if (i + 1 < text.size() && text[i + 1] == '"')
        row.back() += text[++i];
      else
        is_quoted = false;
    } else if (c == '"') {
      expect_output(row.back().empty() && !was_quoted, file + ": a quote within a field");
      is_quoted = was_quoted = true;
    } else if (c == ',' || c == '\n') {
      was_quoted = false;
      if (c == ',') {
        row.emplace_back();
        continue;
      }
      rows.push_back(std::move(row));
      row.assign(1, {});
    } else {
      expect_output(!was_quoted && c != '\r',
                    file + ": text behind a quoted field, or a field that needs quotes and has none");
      row.back() += c;
    }
  }
  expect_output(!is_quoted && row.size() == 1 && row[0].empty(), file + ": it does not end with its last row");
  for (const auto& each : rows)
    expect_output(each.size() == rows.front().size(), file + ": a row of " + std::to_string(each.size()) +
                                                          " fields, the heading has " +
                                                          std::to_string(rows.front().size()));
  return rows;
}

class Outputs {
 public:
  Outputs(const scenario::Resolved& resolved, const results::RunResult& result) : r_(resolved), result_(result) {
    for (const models::NodePlan& node : r_.plan.nodes) nodes_.insert(node.name);
    for (const models::StreamPlan& stream : r_.plan.streams) streams_.insert(stream.name);
    all_.insert(nodes_.begin(), nodes_.end());
    all_.insert(streams_.begin(), streams_.end());
  }

  void read_back() {
    read_report();
    read_result();
    read_folder();
    read_page();
    for (const interchange::ExportFormat& format : interchange::export_formats()) read_export(format);
  }

 private:
  /// No table moves a name out of a line.
  void read_report() {
    for (const std::string& text : {output::run_report(result_), output::check_report(r_)})
      expect_output(
          std::ranges::none_of(text, [](char c) { return c != '\n' && static_cast<unsigned char>(c) < 0x20; }),
          "a report has control characters");
  }

  void read_json(const std::string& text, const std::string& file) {
    json::Diagnostics diagnostics;
    expect_output(json::parse(text, file, diagnostics).has_value(), diagnostics.to_text());
  }

  void read_result() {
    json::Diagnostics diagnostics;
    const auto document = json::parse(results::run_json(result_), "result.json", diagnostics);
    expect_output(document.has_value(), diagnostics.to_text());
    const json::Node* const streams = document->root().find("streams");
    for (const results::StreamResult& stream : result_.streams)
      expect_output(streams != nullptr && streams->find(stream.name) != nullptr,
                    "result.json has no stream " + json::quote(stream.name));
  }

  void read_folder() {
    const Folder folder;
    output::RecordingOptions wanted;
    wanted.timeline = wanted.waves = wanted.frames = true;
    wanted.clocks = r_.scenario.clocks.gptp.has_value();
    scenario::Run run(r_);
    json::Diagnostics diagnostics;
    output::Recording recording(wanted, folder.name(), run, diagnostics);
    expect_output(!diagnostics.has_errors(), diagnostics.to_text());
    expect_output(recording.open().empty(), "the recording is not opened");
    run.advance();
    expect_output(recording.close().empty(), "the recording is not closed");
    output::WrittenFiles written(folder.name(), "run", "");
    expect_output(
        written.begin().empty() && output::write_result_folder(written, result_, json::encode(r_.scenario)).empty(),
        "the folder is not written");
    for (const auto& entry : fs::directory_iterator(folder.name())) read_file(folder, entry.path().filename().string());
  }

  void read_file(const Folder& folder, const std::string& file) {
    const std::string text = folder.text_of(file);
    if (file.ends_with(".json")) read_json(text, file);
    if (file.ends_with(".vcd")) read_waves(text, file);
    if (!file.ends_with(".csv")) return;
    const auto rows = rows_of(text, file);
    for (std::size_t column = 0; column < rows.front().size(); ++column) {
      const std::string& head = rows.front()[column];
      const std::set<std::string>* const known = head == "stream"                          ? &streams_
                                                 : head == "node" || head == "grandmaster" ? &nodes_
                                                                                           : nullptr;
      for (std::size_t row = 1; row < rows.size() && known != nullptr; ++row)
        expect_output(rows[row][column].empty() || known->contains(rows[row][column]),
                      file + ": no " + head + " is called " + json::quote(rows[row][column]));
    }
  }

  /// A variable has one word as its name, and its bits behind it.
  static void read_waves(const std::string& text, const std::string& file) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line) && !line.starts_with("$enddefinitions");) {
      std::istringstream words(line);
      std::vector<std::string> all;
      for (std::string word; words >> word;) all.push_back(word);
      if (all.empty() || (all[0] != "$var" && all[0] != "$scope")) continue;
      if (all[0] == "$var" && all.size() == 7 && all[5].starts_with('[')) all.erase(all.begin() + 5);
      expect_output(all.back() == "$end" && all.size() == (all[0] == "$var" ? 6u : 4u),
                    file + ": " + json::quote(line));
    }
  }

  void read_page() {
    report::Replay replay(r_, result_);
    replay.advance([] { return false; });
    const std::string page = report::run_page(r_, result_, replay);
    for (const std::string& name : all_)
      expect_output(name.find('<') == std::string::npos || page.find(name) == std::string::npos,
                    "the page has a name as HTML: " + json::quote(name));
  }

  void read_export(const interchange::ExportFormat& format) {
    std::string mistake;
    const auto settings = interchange::Settings::read({}, format.settings, mistake);
    expect_output(settings.has_value(), mistake);
    const interchange::Exported made = format.write({r_, {}, *settings});
    for (const interchange::OutputFile& file : made.files) {
      const std::string name = std::string(format.name) + " " + json::quote(file.name);
      const fs::path path(file.name);
      const bool leads_out = path.is_absolute() || std::ranges::find(path, fs::path("..")) != path.end();
      expect_output(!file.name.empty() && !leads_out, name + ": no name for a file of the folder");
      json::Diagnostics diagnostics;
      if (file.name.ends_with(".json"))
        expect_output(json::parse(file.content, name, diagnostics).has_value(), diagnostics.to_text());
      if (file.name.ends_with(".xml") || file.name.ends_with(".graphml") || file.name.ends_with(".svg"))
        expect_output(parse_xml(file.content, name, diagnostics).has_value(), diagnostics.to_text());
      if (file.name.ends_with(".csv")) rows_of(file.content, name);
      if (!file.name.ends_with(".sh")) continue;
      std::vector<interchange::Remark> remarks;
      static_cast<void>(interchange::linux_tc::commands_of(file.content, name, remarks, diagnostics));
      expect_output(!diagnostics.has_errors(), diagnostics.to_text());
    }
  }

  const scenario::Resolved& r_;
  const results::RunResult& result_;
  std::set<std::string> nodes_, streams_, all_;
};

}  // namespace

std::string mistake_in_outputs(const scenario::Resolved& resolved, const results::RunResult& result) {
  try {
    Outputs(resolved, result).read_back();
  } catch (const Mistake& mistake) {
    return mistake.what();
  }
  return {};
}

}  // namespace takt::generator
