// SPDX-License-Identifier: Apache-2.0
// Recorded conversations of a stock client with a stock server (golden/), octet for octet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace takt::opcua::test {

std::vector<std::byte> octets_of(const std::string& hexadecimal);
std::string hexadecimal(const std::vector<std::byte>& octets);

struct RecordedKeys {
  std::uint32_t token = 0;
  std::vector<std::byte> client;  ///< signing key, encrypting key, initial vector
  std::vector<std::byte> server;
};

struct RecordedMessage {
  int number = 0;
  int connection = 0;
  bool from_client = false;
  std::string type;
  std::vector<std::byte> octets;
  std::vector<std::byte> clear;  ///< sequence header and body, of what was encrypted
  std::optional<RecordedKeys> keys;
  std::string encoding_id;  ///< "i=446"
};

/// `name` as in golden/NAME.jsonl.
std::vector<RecordedMessage> transcript(const std::string& name);
std::string golden_file(const std::string& name);

}  // namespace takt::opcua::test
