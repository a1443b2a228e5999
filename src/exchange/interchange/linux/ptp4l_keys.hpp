// SPDX-License-Identifier: Apache-2.0
// The options of ptp4l (linuxptp 3 and 4): what each means in takt, and what of it takt cannot do.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scenario/description/description.hpp"

namespace takt::interchange::linux_tc {

enum class ValueKind : std::uint8_t { whole, real, text };

/// What a reader has at hand when a key sets something.
struct Target {
  scenario::Gptp& gptp;
  scenario::GptpNode& node;
  scenario::Clock& clock;
  bool& has_clock;
  bool& never_grandmaster;
  bool& receiver_only;
  bool& is_gptp;
};

struct Key {
  std::string_view name;
  ValueKind kind = ValueKind::whole;
  double least = 0, most = 0;
  void (*set)(Target& target, double value, const std::string& text) = nullptr;  ///< null: has no meaning in takt
  std::string_view usual = {};      ///< of a key without `set`: the values with which takt does the same, "0|1"
  std::string_view otherwise = {};  ///< and what is lost with another; empty: the key changes no message and no clock
};

std::span<const Key> ptp4l_keys();

/// The name by which a key stands in the table: those of linuxptp 4 are those of 3 (serverOnly: masterOnly).
std::string_view ptp4l_key(std::string_view name);

/// Whether takt does the same with this value of a key without `set`.
bool is_usual(const Key& key, double value, std::string_view text);

}  // namespace takt::interchange::linux_tc
