// SPDX-License-Identifier: Apache-2.0
// TaktInterop::Sample (sample.idl) in CDR, as takt writes and reads it.
#pragma once

#include <string>
#include <vector>

#include "dds/message/cdr_reader.hpp"
#include "dds/message/cdr_writer.hpp"
#include "dds/message/submessage.hpp"

namespace takt::dds::test {

struct InteropSample {
  std::int32_t id = 0;
  std::int64_t count = 0;
  std::string text;
  bool operator==(const InteropSample&) const = default;
};

inline const std::string interop_type = "TaktInterop::Sample";

inline std::vector<std::byte> encode(const InteropSample& sample) {
  std::vector<std::byte> buffer(64 + sample.text.size());
  CdrWriter writer(buffer);
  writer.put(sample.id);
  writer.put(sample.count);
  writer.put(std::string_view(sample.text));
  const Octets octets = writer.finish();
  return {octets.begin(), octets.end()};
}

/// Whether it could be read.
inline bool decode(Octets payload, InteropSample& sample) {
  CdrReader reader(payload);
  sample.id = reader.get<std::int32_t>();
  sample.count = reader.get<std::int64_t>();
  sample.text = reader.get_string();
  return !reader.failed();
}

/// The key is the id; it is the first member, so what holds the key alone is read alike.
inline KeyHash key_of(std::int32_t id) {
  KeyHash key{};
  for (std::size_t i = 0; i < 4; ++i)
    key[i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(id) >> (8 * (3 - i)));
  return key;
}
inline KeyHash key_of_payload(PayloadKind, Octets payload) {
  CdrReader reader(payload);
  return key_of(reader.get<std::int32_t>());
}

}  // namespace takt::dds::test
