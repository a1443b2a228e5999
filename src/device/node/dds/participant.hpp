// SPDX-License-Identifier: Apache-2.0
// DDS as a real node sees it: serialized payloads go in and come out. Behind it stands an implementation of others.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gateway/key_layout.hpp"
#include "plant/dds.hpp"
#include "uadp/octets.hpp"

namespace takt::node {

/// What became of a sample. `timed_out`: it waited for room for max_blocking_time, in vain.
enum class SendOutcome : std::uint8_t { sent, timed_out, failed };

/// Writes samples of one topic. A sample is a serialized payload: encapsulation header and CDR.
class DdsWriter {
 public:
  virtual ~DdsWriter() = default;
  /// Waits until there is room, for max_blocking_time at most.
  virtual SendOutcome write(uadp::Octets payload) = 0;
  /// Readers that it has found. A volatile sample is for these alone.
  virtual std::uint32_t matched() const = 0;
};

/// No call takes more at once, so that it ends however fast others send.
inline constexpr std::size_t most_taken = 65'536;

/// Takes samples of one topic.
class DdsReader {
 public:
  virtual ~DdsReader() = default;
  /// The samples that had come, oldest first, `most_taken` of them at most. They are valid until the next call.
  virtual std::span<const std::vector<std::byte>> take() = 0;
  /// Writers that it has found.
  virtual std::uint32_t matched() const = 0;
};

/// Types are matched by their names; what a payload holds is the matter of who writes and who takes.
struct DdsTopic {
  std::string name;
  std::string type;
  plant::Qos qos;  ///< absent: as a scenario says
  gateway::KeyLayout key = {};
  std::function<bool(uadp::Octets)> passes =
      {};  ///< of a reader: samples for which it is false are left out before they count; nothing: none
};

/// A participant in a domain. Writers and readers are its, and go with it. Calls may come from several threads.
class DdsParticipant {
 public:
  virtual ~DdsParticipant() = default;
  /// Null, and `problem` says why, if the implementation refuses.
  virtual DdsWriter* add_writer(const DdsTopic& topic, std::string& problem) = 0;
  virtual DdsReader* add_reader(const DdsTopic& topic, std::string& problem) = 0;
};

/// Whether this build has an implementation, and if not, what to install.
bool has_dds();
inline constexpr const char* dds_needed =
    "takt built with Cyclone DDS (on Debian: install cyclonedds-dev and cyclonedds-tools, then configure and build "
    "again)";

/// Null, and `problem` says why, if it cannot be. `interface` "": as CYCLONEDDS_URI or the implementation says.
std::unique_ptr<DdsParticipant> open_dds(std::uint16_t domain, const std::string& interface, std::string& problem);

}  // namespace takt::node
