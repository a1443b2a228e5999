// SPDX-License-Identifier: Apache-2.0
// One value without its type: the encoding of OPC 10000-6, 5.2.2, which RawData fields and the insides of Variants use.
#pragma once

#include <algorithm>
#include <bit>
#include <concepts>
#include <type_traits>

#include "uadp/builtin_type.hpp"
#include "uadp/octets.hpp"

namespace takt::uadp {

/// The value at `at`; fixed_octets of its type must be there. Any octet but 0 is a true Boolean.
template <FixedScalar T>
T load_value(const std::byte* at) {
  if constexpr (std::same_as<T, bool>) {
    return *at != std::byte{0};
  } else if constexpr (std::same_as<T, DateTime>) {
    return DateTime{load_little_endian<std::int64_t>(at)};
  } else if constexpr (std::same_as<T, Status>) {
    return Status{load_little_endian<std::uint32_t>(at)};
  } else if constexpr (std::same_as<T, Guid>) {
    Guid guid;
    std::copy_n(at, guid.octets.size(), guid.octets.begin());
    return guid;
  } else {
    return load_little_endian<T>(at);
  }
}

template <FixedScalar T>
void store_value(std::byte* at, const T& value) {
  if constexpr (std::same_as<T, bool>) {
    *at = static_cast<std::byte>(value ? 1 : 0);
  } else if constexpr (std::same_as<T, DateTime>) {
    store_little_endian(at, value.ticks);
  } else if constexpr (std::same_as<T, Status>) {
    store_little_endian(at, value.code);
  } else if constexpr (std::same_as<T, Guid>) {
    std::copy(value.octets.begin(), value.octets.end(), at);
  } else {
    store_little_endian(at, value);
  }
}

/// Its values have in memory the octets of their encoding: several may be copied as one.
template <FixedScalar T>
inline constexpr bool is_encoded_as_it_is =
    std::is_arithmetic_v<T> && !std::same_as<T, bool> && std::endian::native == std::endian::little;

/// Int32 length and the octets; the longest is 2^31 - 1.
inline void put_length_and_octets(Writer& writer, Octets octets) {
  writer.put(static_cast<std::int32_t>(octets.size()));
  writer.put_octets(octets);
}

template <Scalar T>
void put_value(Writer& writer, const T& value) {
  if constexpr (std::same_as<T, std::string_view>) {
    put_length_and_octets(writer, std::as_bytes(std::span(value.data(), value.size())));
  } else if constexpr (std::same_as<T, ByteStringView>) {
    put_length_and_octets(writer, value.octets);
  } else {
    std::array<std::byte, fixed_octets(BuiltIn<T>::type)> octets;
    store_value(octets.data(), value);
    writer.put_octets(octets);
  }
}

/// An Int32 length and as many octets. Length -1 is a null string and gives none; other negative lengths are malformed.
Octets get_length_and_octets(Reader& reader);

template <Scalar T>
T get_value(Reader& reader) {
  if constexpr (std::same_as<T, std::string_view>) {
    const Octets octets = get_length_and_octets(reader);
    return {reinterpret_cast<const char*>(octets.data()), octets.size()};
  } else if constexpr (std::same_as<T, ByteStringView>) {
    return {get_length_and_octets(reader)};
  } else {
    const Octets octets = reader.take(fixed_octets(BuiltIn<T>::type));
    return octets.empty() ? T{} : load_value<T>(octets.data());
  }
}

/// Deepest nesting of Variants, DataValues and DiagnosticInfos that is accepted.
inline constexpr int most_nested = 16;

/// Steps over one value of any built-in type and so finds where it ends. The reader fails for what is malformed.
void skip_value(Reader& reader, BuiltInType type, int depth = 0);

}  // namespace takt::uadp
