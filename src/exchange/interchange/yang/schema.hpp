// SPDX-License-Identifier: Apache-2.0
// What takt knows of YANG modules: the nodes that it reads and writes, with their types, as tables. Two dialects: the
// published modules (802.1Qcw-2023 and its relatives), and the drafts of 2018 that most devices speak. Descriptions of
// state are known so that they can be passed over.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace takt::interchange::yang {

enum class Type : std::uint8_t {
  container,
  list,  ///< entries with a key
  uint8,
  uint16,
  uint32,
  uint64,  ///< in JSON a text (RFC 7951)
  int8,
  int16,
  int32,
  int64,
  boolean,
  text,
  choice,    ///< an enumeration
  identity,  ///< in JSON with the name of its module
  empty,
  mac,       ///< 02-00-5e-00-00-01
  anything,  ///< any subtree, not looked at
};

struct Schema {
  std::string_view module;  ///< name
  std::string_view name;
  Type type = Type::anything;
  std::span<const Schema> children = {};
  std::string_view key = {};      ///< of lists; several with blanks between
  std::string_view choices = {};  ///< "zero|one", of enumerations; of identities the module and names:
                                  ///< "ieee802-dot1q-sched:set-gate-states|.."
  bool is_mandatory = false;
  std::uint64_t least = 0;
  std::uint64_t most = ~std::uint64_t{0};
  bool is_leaf_list = false;
  bool is_state = false;  ///< read, and of no account for what is configured
  bool is_key(std::string_view child) const {
    return (" " + std::string(key) + " ").find(" " + std::string(child) + " ") != std::string::npos;
  }
  const Schema* find(std::string_view which_module, std::string_view which_name) const;
};

/// The names of modules and their namespaces.
std::string_view namespace_of(std::string_view module);
/// The module of a namespace; empty if takt does not know it.
std::string_view module_of(std::string_view name_space);
bool is_known(std::string_view module);
std::vector<std::string_view> known_modules();

enum class Dialect : std::uint8_t { published, of_2018 };

/// A container without a name whose children are what may stand at the top.
const Schema& root_of(Dialect dialect);

}  // namespace takt::interchange::yang
