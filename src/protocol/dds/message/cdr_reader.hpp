// SPDX-License-Identifier: Apache-2.0
// Reads CDR (DDS-XTypes 7.4) of both versions and byte orders; bounded by the octets that are there.
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

#include "dds/message/encapsulation.hpp"

namespace takt::dds {

/// Reads the members of a final type in their order. What is not there reads as 0 or as nothing and makes failed() true
/// for good; so does a representation that is not read at all (representation() names it).
class CdrReader {
 public:
  explicit CdrReader(Octets payload) : CdrReader(open_encapsulation(payload)) {}
  explicit CdrReader(const Encapsulated& payload)
      : representation_(payload.representation),
        reader_(payload.content, payload.order),
        greatest_alignment_(payload.representation == Representation::cdr2 ? 4 : 8) {
    if (representation_ != Representation::cdr && representation_ != Representation::cdr2) reader_.fail();
  }

  Representation representation() const { return representation_; }

  template <Number T>
  T get() {
    reader_.align(std::min(sizeof(T), greatest_alignment_));
    return reader_.get<T>();
  }
  /// 0 is false, 1 is true, all else fails.
  bool get_bool() {
    const auto value = reader_.get<std::uint8_t>();
    if (value > 1) reader_.fail();
    return value == 1;
  }
  /// A view of the text. An octet 0 ends it and is counted; length 0 is taken for "".
  std::string_view get_string() {
    const auto length = get<std::uint32_t>();
    if (length == 0) return {};
    const Octets octets = reader_.take(length);
    if (octets.empty()) return {};
    const std::string_view text(reinterpret_cast<const char*>(octets.data()), octets.size() - 1);
    if (octets.back() == std::byte{0} && text.find('\0') == std::string_view::npos) return text;
    reader_.fail();
    return {};
  }
  template <Number T>
  void get_array(std::span<T> elements) {
    for (T& element : elements) element = get<T>();
  }
  /// How many elements follow, each of at least `least_size` octets: believed only as far as octets are there.
  std::size_t begin_sequence(std::size_t least_size) {
    const auto count = get<std::uint32_t>();
    if (count <= reader_.left() / least_size) return count;
    reader_.fail();
    return 0;
  }
  template <Number T>
  std::vector<T> get_sequence() {
    std::vector<T> elements(begin_sequence(sizeof(T)));
    get_array(std::span<T>(elements));
    return elements;
  }

  bool failed() const { return reader_.failed(); }
  std::size_t left() const { return reader_.left(); }

 private:
  Representation representation_;
  Reader reader_;
  std::size_t greatest_alignment_;
};

}  // namespace takt::dds
