// SPDX-License-Identifier: Apache-2.0
// All recordings of a run, on one thread or divided, as the octets of their files.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>

#include "output/recording.hpp"
#include "scenario/division/divided_run.hpp"

namespace takt::output::test {

using Files = std::map<std::string, std::string>;

/// Everything that can be recorded of the scenario.
inline RecordingOptions all_of(const scenario::Resolved& resolved) {
  RecordingOptions options;
  options.pcap = {"all"};
  options.timeline = options.waves = options.frames = true;
  options.clocks = resolved.scenario.clocks.gptp.has_value();
  return options;
}

/// What Recording::files() are after all has been written, which goes away then; and the digest of the run.
inline Files read_files(const Recording& recording, const std::filesystem::path& folder, const scenario::Run& run) {
  Files files{{"digest", std::to_string(run.simulation().digest().value())}};
  for (const std::string& name : recording.files()) {
    std::ifstream file(folder / name, std::ios::binary);
    EXPECT_TRUE(file) << name;
    std::ostringstream text;
    text << file.rdbuf();
    files[name] = text.str();
  }
  std::filesystem::remove_all(folder);
  return files;
}

inline std::filesystem::path folder_of_recordings() {
  return std::filesystem::temp_directory_path() / ("takt-recorded-" + std::to_string(::getpid()));
}

/// What is recorded of a run on one thread, written every so many events.
inline Files recorded_whole(const scenario::Resolved& resolved, const RecordingOptions& options,
                            std::uint64_t tie_shuffle = 0, std::uint64_t events_a_slice = 100'000) {
  scenario::Run run(resolved, tie_shuffle);
  json::Diagnostics diagnostics;
  Recording recording(options, folder_of_recordings().string(), run, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
  EXPECT_EQ(recording.open(), "");
  while (!run.advance(events_a_slice)) recording.write_until(run.simulation().now());
  EXPECT_EQ(recording.close(), "");
  return read_files(recording, folder_of_recordings(), run);
}

/// The same of a divided one, written so often.
inline Files recorded_divided(const scenario::Resolved& resolved, const scenario::Division& division,
                              const RecordingOptions& options, std::uint64_t tie_shuffle = 0, int slices = 5) {
  scenario::DividedRun run(resolved, division, tie_shuffle);
  json::Diagnostics diagnostics;
  Recording recording(options, folder_of_recordings().string(), run, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
  EXPECT_EQ(recording.open(), "");
  for (int slice = 1; slice <= slices; ++slice) {
    run.advance(slice == slices ? run.end() : sim::TrueTime::from_ps(run.end().ps() / slices * slice));
    recording.write_until(run.now());
  }
  const scenario::Run& gathered = run.gathered();
  EXPECT_EQ(recording.close(), "");
  return read_files(recording, folder_of_recordings(), gathered);
}

/// Empty, or which files differ, and where.
inline std::string difference(const Files& expected, const Files& found) {
  std::string text;
  for (const auto& [name, content] : expected) {
    const auto other = found.find(name);
    if (other == found.end()) {
      text += name + " is missing\n";
      continue;
    }
    if (other->second == content) continue;
    const std::size_t at = static_cast<std::size_t>(
        std::mismatch(content.begin(),
                      content.begin() + static_cast<std::ptrdiff_t>(std::min(content.size(), other->second.size())),
                      other->second.begin())
            .first -
        content.begin());
    const std::size_t from = at > 150 ? at - 150 : 0;
    text += name + " differs at " + std::to_string(at) + ", sizes " + std::to_string(content.size()) + " and " +
            std::to_string(other->second.size());
    if (!name.ends_with("pcapng"))
      text += "\n--- expected\n" + content.substr(from, 300) + "\n--- found\n" + other->second.substr(from, 300);
    text += "\n";
  }
  return text + (expected.size() == found.size() ? "" : "another number of files\n");
}

}  // namespace takt::output::test
