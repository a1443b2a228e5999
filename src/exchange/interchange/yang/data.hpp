// SPDX-License-Identifier: Apache-2.0
// Instance data as a tree by the schema, whatever text it came from: JSON (RFC 7951) or XML.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "interchange/import.hpp"
#include "interchange/yang/schema.hpp"

namespace takt::interchange::yang {

/// A node. Entries of a list, and values of a list of leaves, are children of the same name one after the other.
struct Data {
  const Schema* schema = nullptr;
  json::Place place;
  std::string text;  ///< of leaves, as XML has it ("true", "128"); of identities with their module
  std::vector<Data> children;
  bool is_deleted = false;  ///< a NETCONF operation takes it away

  const Data* find(std::string_view name) const;
  const Data* find(std::string_view module, std::string_view name) const;
  /// The value of a leaf, or nothing.
  std::optional<std::uint64_t> number(std::string_view name) const;
  std::optional<std::int64_t> signed_number(std::string_view name) const;
  std::optional<std::string> value(std::string_view name) const;
  bool is_true(std::string_view name) const;

  /// For writing: a child by its name, made if there is none; a new entry of a list; a leaf. CHECKs that the schema has
  /// it.
  Data& make(std::string_view name, std::string_view module = {});
  Data& add(std::string_view name, std::string_view module = {});
  void set(std::string_view name, std::string value, std::string_view module = {});
};

/// Reads a file. Every mistake is told: what the schema does not have, values of the wrong kind or out of range,
/// entries with one key, what is mandatory. What belongs to modules that takt does not know is a remark.
class DataReader {
 public:
  DataReader(Imported& imported, json::Diagnostics& diagnostics) : imported_(imported), diagnostics_(diagnostics) {}
  /// The dialect of a file by its names; null, and reported, if it mixes both.
  std::optional<Dialect> dialect_of(const InputFile& file);
  std::optional<Data> read(const InputFile& file, Dialect dialect);

 private:
  friend class JsonToData;
  friend class XmlToData;
  Imported& imported_;
  json::Diagnostics& diagnostics_;
};

/// What JSON and XML have in common: a leaf's value by its type.
class LeafCheck {
 public:
  LeafCheck(json::Diagnostics& diagnostics) : diagnostics_(diagnostics) {}
  /// `text` is the value without quotes or white space around; of identities with the module's name.
  bool check(const Schema& schema, const std::string& text, const json::Place& place);
  /// Mandatory leaves, keys that come twice.
  void check_children(const Data& data);

 private:
  json::Diagnostics& diagnostics_;
};

std::string to_json(const Data& root);
std::string to_xml(const Data& root);

/// "five" of 5, and back.
std::string_view digit_word(unsigned digit);
std::optional<unsigned> word_digit(std::string_view word);

}  // namespace takt::interchange::yang
