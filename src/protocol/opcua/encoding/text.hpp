// SPDX-License-Identifier: Apache-2.0
// Strings, octets and arrays as OPC UA has them (OPC 10000-6, 5.2): there is a null one beside the empty one. Services
// take both for the same; what was decoded keeps the difference, so that it is written as it was read.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace takt::opcua {

/// A String: UTF-8, not checked.
struct Text {
  std::string value;
  bool is_empty_not_null = false;  ///< asked only where there is no text

  Text() = default;
  Text(std::string text) : value(std::move(text)), is_empty_not_null(true) {}  // NOLINT: a text is a text
  Text(std::string_view text) : Text(std::string(text)) {}                     // NOLINT
  Text(const char* text) : Text(std::string(text)) {}                          // NOLINT
  bool empty() const { return value.empty(); }
  bool is_null() const { return value.empty() && !is_empty_not_null; }
  operator std::string_view() const { return value; }  // NOLINT
  friend bool operator==(const Text& a, const Text& b) { return a.value == b.value; }
  friend auto operator<=>(const Text& a, const Text& b) { return a.value <=> b.value; }
  friend bool operator==(const Text& a, std::string_view b) { return a.value == b; }
  friend bool operator==(const Text& a, const char* b) { return a.value == b; }
  friend bool operator==(const Text& a, const std::string& b) { return a.value == b; }
};

/// A ByteString.
struct Bytes {
  std::vector<std::byte> value;
  bool is_empty_not_null = false;

  Bytes() = default;
  Bytes(std::vector<std::byte> octets) : value(std::move(octets)), is_empty_not_null(true) {}  // NOLINT
  bool empty() const { return value.empty(); }
  bool is_null() const { return value.empty() && !is_empty_not_null; }
  friend bool operator==(const Bytes& a, const Bytes& b) { return a.value == b.value; }
  friend auto operator<=>(const Bytes& a, const Bytes& b) { return a.value <=> b.value; }
};

/// An array of a structure's field.
template <class T>
struct List : std::vector<T> {
  bool is_empty_not_null = false;

  using std::vector<T>::vector;
  List(std::vector<T> elements) : std::vector<T>(std::move(elements)), is_empty_not_null(true) {}  // NOLINT
  bool is_null() const { return this->empty() && !is_empty_not_null; }
};

}  // namespace takt::opcua
