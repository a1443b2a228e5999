// SPDX-License-Identifier: Apache-2.0
#include "uadp/store_number.hpp"

#include <algorithm>
#include <iterator>

#include "uadp/octets.hpp"

namespace takt::uadp {
namespace {

template <class T>
void store(std::byte* at, std::uint64_t number) {
  store_little_endian(at, static_cast<T>(number));
}

struct Store {
  BuiltInType type;
  void (*store)(std::byte*, std::uint64_t);
};

constexpr Store stores[] = {
    {BuiltInType::Boolean, [](std::byte* at, std::uint64_t number) { *at = static_cast<std::byte>(number & 1); }},
    {BuiltInType::SByte, store<std::int8_t>},
    {BuiltInType::Byte, store<std::uint8_t>},
    {BuiltInType::Int16, store<std::int16_t>},
    {BuiltInType::UInt16, store<std::uint16_t>},
    {BuiltInType::Int32, store<std::int32_t>},
    {BuiltInType::UInt32, store<std::uint32_t>},
    {BuiltInType::Int64, store<std::int64_t>},
    {BuiltInType::UInt64, store<std::uint64_t>},
    {BuiltInType::Float, store<float>},
    {BuiltInType::Double, store<double>},
};

}  // namespace

bool store_number(BuiltInType type, std::byte* at, std::uint64_t number) {
  const auto* const found =
      std::find_if(std::begin(stores), std::end(stores), [&](const Store& each) { return each.type == type; });
  if (found != std::end(stores)) found->store(at, number);
  return found != std::end(stores);
}

}  // namespace takt::uadp
