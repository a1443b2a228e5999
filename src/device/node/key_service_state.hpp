// SPDX-License-Identifier: Apache-2.0
// What who pulls keys has seen of its key service, and what `takt ctl status` says of that. Nothing of a key.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "json/type.hpp"
#include "security/key_ring.hpp"

namespace takt::node {

/// As it was behind the last pull. Times are those of CLOCK_BOOTTIME.
struct KeyServiceState {
  std::string endpoint;
  std::optional<std::string> answered_by;  ///< address and port; nothing: it has given no keys yet
  std::int64_t answered_ns = 0;            ///< when it gave keys last
  security::KeySchedule schedule;          ///< of these
  std::size_t keys = 0;                    ///< from its first token on; 0: none have come
  std::uint64_t pulls = 0;
  std::uint64_t wished = 0;            ///< of them: because of what was heard
  std::uint64_t failures = 0;          ///< of them: without keys
  std::optional<std::string> problem;  ///< why the last one failed; nothing: it did not
};

/// What is told of it at an instant.
struct KeyServiceStatus {
  std::string service;
  std::optional<std::string> answered_by;
  std::optional<std::int64_t> silent_ns;
  std::uint32_t token = 0;
  std::uint64_t keys = 0;
  std::int64_t ends_in_ns = 0;
  std::uint64_t pulls = 0;
  std::uint64_t wished = 0;
  std::uint64_t failures = 0;
  std::optional<std::string> problem;
};
KeyServiceStatus status_of(const KeyServiceState& state, std::int64_t now_ns);
const json::Record& describe(json::Type<KeyServiceStatus>);

}  // namespace takt::node
