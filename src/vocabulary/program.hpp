// What JSON files say of a Program, wherever it runs: plain values and their tables.
#pragma once

#include <cstdint>
#include <string>

#include "handshake/participant.hpp"
#include "json/fields.hpp"
#include "program/method.hpp"

// Words of files for values of protocol code: a description is looked for in the namespace of what it describes.
namespace takt::handshake {
const json::Enumeration& describe(json::Type<Variant>);
const json::Enumeration& describe(json::Type<Subscription>);
}  // namespace takt::handshake
namespace takt::program {
const json::Enumeration& describe(json::Type<Method>);
}  // namespace takt::program

namespace takt::vocabulary {

using handshake::Subscription;
using handshake::Variant;
using program::Method;

enum class Publish : std::uint8_t { cyclic, on_change };
enum class DataType : std::uint8_t { boolean, sbyte, byte, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

struct DataField {
  DataType type = DataType::float64;
  std::uint16_t count = 1;
  bool operator==(const DataField&) const = default;
};

/// A data set that a participant publishes to those that hear it.
struct ProcessData {
  json::Source where;
  std::string name;
  std::string from;
  json::NameMap<DataField> fields;
  bool operator==(const ProcessData&) const = default;
};

const json::Enumeration& describe(json::Type<Publish>);
const json::Enumeration& describe(json::Type<DataType>);
const json::Object& describe(json::Type<DataField>);
const json::Object& describe(json::Type<ProcessData>);

}  // namespace takt::vocabulary
