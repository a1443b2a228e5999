// What JSON files say of a Program, wherever it runs: plain values and their tables.
#pragma once

#include <cstdint>
#include <string>

#include "json/fields.hpp"

namespace takt::vocabulary {

enum class Variant : std::uint8_t { robust, paper };
enum class Publish : std::uint8_t { cyclic, on_change };
enum class Subscription : std::uint8_t { star, all_to_all };
enum class DataType : std::uint8_t { boolean, sbyte, byte, int16, uint16, int32, uint32, int64, uint64, float32, float64 };
enum class Method : std::uint8_t { start, suspend, resume, halt, reset };

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

const json::Enumeration& describe(json::Type<Variant>);
const json::Enumeration& describe(json::Type<Publish>);
const json::Enumeration& describe(json::Type<Subscription>);
const json::Enumeration& describe(json::Type<DataType>);
const json::Enumeration& describe(json::Type<Method>);
const json::Object& describe(json::Type<DataField>);
const json::Object& describe(json::Type<ProcessData>);

}  // namespace takt::vocabulary
