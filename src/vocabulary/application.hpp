// What JSON files say of applications with threads that publish and subscribe, wherever they run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "json/fields.hpp"

namespace takt::vocabulary {

enum class Protocol : std::uint8_t { opc_ua, dds };
enum class Pattern : std::uint8_t { counter, alternate };
enum class Overflow : std::uint8_t { overwrite_oldest, drop_newest, keep_latest };

/// What a thread publishes: the first field says it, all others are zero; or what another topic last said.
struct Payload {
  json::Source where;
  std::optional<Pattern> pattern;
  std::optional<std::string> copy_of;
  std::optional<std::uint32_t> instance;   ///< of a topic with keys, as the next
  std::optional<std::uint32_t> instances;
  bool operator==(const Payload&) const = default;
};

const json::Enumeration& describe(json::Type<Protocol>);
const json::Enumeration& describe(json::Type<Pattern>);
const json::Enumeration& describe(json::Type<Overflow>);
const json::Object& describe(json::Type<Payload>);

}  // namespace takt::vocabulary
