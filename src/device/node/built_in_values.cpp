// SPDX-License-Identifier: Apache-2.0
#include "node/built_in_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "json/diagnostics.hpp"
#include "uadp/builtin_type.hpp"

namespace takt::node {
namespace {

using uadp::BuiltInType;

/// Integers are rounded and kept within their range.
template <class T>
void store(std::byte* at, double value) {
  if constexpr (std::is_floating_point_v<T>) {
    uadp::store_little_endian(at, static_cast<T>(value));
  } else {
    const double low = static_cast<double>(std::numeric_limits<T>::min());
    const double high = static_cast<double>(std::numeric_limits<T>::max());
    const double rounded = std::round(value);
    // The upper end of 64 bits is no double: the nearest one is beyond the type.
    uadp::store_little_endian(at, rounded >= high  ? std::numeric_limits<T>::max()
                                  : rounded <= low ? std::numeric_limits<T>::min()
                                                   : static_cast<T>(rounded));
  }
}

template <class T>
std::string text(const std::byte* at) {
  const T value = uadp::load_little_endian<T>(at);
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::isfinite(value)) return "null";  // JSON has no such numbers
  }
  if constexpr (sizeof(T) == 1)
    return fmt::format("{}", static_cast<int>(value));
  else
    return fmt::format("{}", value);
}

struct TypeCodec {
  BuiltInType type;
  void (*store)(std::byte*, double);
  std::string (*text)(const std::byte*);
};

constexpr TypeCodec codecs[] = {
    {BuiltInType::Boolean, [](std::byte* at, double value) { *at = static_cast<std::byte>(value >= 0.5); },
     [](const std::byte* at) { return std::string(*at != std::byte{0} ? "true" : "false"); }},
    {BuiltInType::SByte, store<std::int8_t>, text<std::int8_t>},
    {BuiltInType::Byte, store<std::uint8_t>, text<std::uint8_t>},
    {BuiltInType::Int16, store<std::int16_t>, text<std::int16_t>},
    {BuiltInType::UInt16, store<std::uint16_t>, text<std::uint16_t>},
    {BuiltInType::Int32, store<std::int32_t>, text<std::int32_t>},
    {BuiltInType::UInt32, store<std::uint32_t>, text<std::uint32_t>},
    {BuiltInType::Int64, store<std::int64_t>, text<std::int64_t>},
    {BuiltInType::UInt64, store<std::uint64_t>, text<std::uint64_t>},
    {BuiltInType::Float, store<float>, text<float>},
    {BuiltInType::Double, store<double>, text<double>},
};

const TypeCodec& codec_of(BuiltInType type) {
  return *std::find_if(std::begin(codecs), std::end(codecs),
                       [type](const TypeCodec& each) { return each.type == type; });
}

}  // namespace

double value_of(const Source& source, double message, std::int64_t time_ns) {
  switch (source.kind) {
    case SourceKind::constant:
      return source.value;
    case SourceKind::counter:
      return source.value + source.step * message;
    case SourceKind::sine:
      break;
  }
  const std::int64_t period_ns = std::max<std::int64_t>(source.period.ps() / 1000, 1);
  const double phase = static_cast<double>(time_ns % period_ns) / static_cast<double>(period_ns);
  return source.value + source.amplitude * std::sin(2 * std::numbers::pi * phase);
}

BuiltInValues::BuiltInValues(const Config& config, const wire::ProgramShape& shape, Log& log, bool is_named)
    : program_(is_named ? "\"program\": " + json::quote(shape.name) + ", " : std::string()),
      log_values_every_(config.log_values_every),
      log_(&log) {
  for (const wire::DataSetShape& from : shape.data_sets) {
    DataSet& data_set = data_sets_.emplace_back();
    data_set.name = from.name;
    std::size_t at = 0;
    for (const wire::FieldShape& field : from.fields) {
      data_set.fields.push_back({field.name, field.type, field.count, at, {}});
      at += uadp::fixed_octets(field.type) * field.count;
      for (const Source& source : config.sources)
        if (source.data_set == from.name && source.program.value_or(shape.name) == shape.name &&
            (!source.field || *source.field == field.name))
          data_set.fields.back().sources = {source};
    }
  }
}

void BuiltInValues::produce(std::size_t number, std::int64_t time_ns, std::span<std::byte> fields) {
  DataSet& data_set = data_sets_[number];
  for (const Field& field : data_set.fields) {
    if (field.sources.empty()) continue;
    const double value = value_of(field.sources.front(), data_set.messages, time_ns);
    const TypeCodec& codec = codec_of(field.type);
    for (std::size_t i = 0; i < field.count; ++i)
      codec.store(fields.data() + field.at + i * uadp::fixed_octets(field.type), value);
  }
  ++data_set.messages;
}

void BuiltInValues::consume(std::size_t number, std::int64_t time_ns, uadp::Octets fields) {
  DataSet& data_set = data_sets_[number];
  if (!log_values_every_ || time_ns < data_set.next_log_ns) return;
  data_set.next_log_ns = time_ns + log_values_every_->ps() / 1000;
  std::string line = fmt::format("{{\"time_ns\": {}, {}\"event\": \"data\", \"data_set\": {}, \"fields\": {{", time_ns,
                                 program_, json::quote(data_set.name));
  for (const Field& field : data_set.fields) {
    if (&field != &data_set.fields.front()) line += ", ";
    line += json::quote(field.name) + ": ";
    if (field.count > 1) line += '[';
    for (std::size_t i = 0; i < field.count; ++i)
      line += (i == 0 ? "" : ", ") +
              codec_of(field.type).text(fields.data() + field.at + i * uadp::fixed_octets(field.type));
    if (field.count > 1) line += ']';
  }
  line += "}}\n";
  log_->write(line);
}

}  // namespace takt::node
