// SPDX-License-Identifier: Apache-2.0
// What an import format gets and gives: files with their text, a scenario, and what was changed, lost or ignored on the
// way. Mistakes go to diagnostics, each with file, line, column and what was expected; one mistake is enough for no
// scenario.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interchange/interfaces.hpp"
#include "interchange/settings.hpp"
#include "json/diagnostics.hpp"
#include "scenario/description/description.hpp"

namespace takt::interchange {

/// The largest text that an import reads.
inline constexpr std::size_t max_input_octets = std::size_t{64} << 20;

struct InputFile {
  std::string name;    ///< for diagnostics
  std::string device;  ///< the node that it is of: what the user says, or device_of_file()
  std::string text;
};

/// The device that a file is called after: its name up to the first dot, or an IP address with its dots
/// ("192.168.0.1.qdisc.json").
std::string device_of_file(std::string_view name);

enum class RemarkKind : std::uint8_t {
  changed,  ///< said in another way, which means the same from some time on
  lost,     ///< takt does otherwise
  ignored,  ///< has no meaning in takt
  odd,      ///< taken as it stands, and probably not meant
};

struct Remark {
  RemarkKind kind = RemarkKind::ignored;
  json::Place place;
  std::string text;
};

struct ImportRequest {
  std::span<const InputFile> files;
  const scenario::Scenario* base = nullptr;  ///< of formats with into_base: the network that the devices are in
  Settings settings = {};
};

struct Imported {
  std::optional<scenario::Scenario> scenario;
  std::optional<std::string> device;  ///< instead: the text of a file with a type of device
  std::vector<Remark> remarks;
  InterfaceNames interfaces;  ///< as the devices call them, where an export would call one of a node otherwise
  std::map<std::string, json::Place> origins;  ///< where in the files what stands at a pointer of the scenario was said
  void remark(RemarkKind kind, json::Place place, std::string text);
};

/// `file:line:column: lost: text`, without a newline.
std::string to_text(const Remark& remark);

/// The scenario as people would write it: what has its default is left out.
std::string sparse_text(const scenario::Scenario& scenario);

/// The time from which on a base time is that of a running clock and not of a run that begins at 0.
inline constexpr std::int64_t earliest_running_clock_ns = 1'000'000'000;

}  // namespace takt::interchange
