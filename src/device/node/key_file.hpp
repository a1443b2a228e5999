// SPDX-License-Identifier: Apache-2.0
// The keys of a SecurityGroup in a file that only its owner may read.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "json/fields.hpp"
#include "security/key_ring.hpp"
#include "sim/time.hpp"

namespace takt::node {

/// As it is written. What it holds is no part of any diagnostic.
struct KeyFile {
  json::Source where;
  std::string group;
  security::MessagePolicy policy = security::MessagePolicy::aes128_ctr;
  std::optional<std::string> secret;  ///< in hexadecimal digits; keys without end are derived from it
  std::vector<std::string> keys;      ///< or these, one behind the other
  std::uint32_t first_token = 1;
  std::int64_t first_at = 0;  ///< seconds since 1970
};
const json::Object& describe(json::Type<KeyFile>);

struct LoadedKeys {
  std::string group;
  security::MessagePolicy policy = security::MessagePolicy::aes128_ctr;
  std::uint32_t first_token = 1;
  std::int64_t first_ns = 0;
  std::shared_ptr<const security::KeySource> source;

  security::KeySchedule schedule(sim::Duration lifetime) const { return {first_token, first_ns, lifetime.ps() / 1000}; }
  security::KeyRing ring(sim::Duration lifetime) const;
};

/// Nothing if there was a mistake: also if others than the owner may read or write the file, or it belongs to somebody
/// else (root may own it).
std::optional<LoadedKeys> load_keys(const std::string& path, const json::Place& named_at,
                                    json::Diagnostics& diagnostics);

}  // namespace takt::node
