// SPDX-License-Identifier: Apache-2.0
#include "transcript.hpp"

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace takt::opcua::test {
namespace {

const std::string folder = TAKT_SOURCE_DIR "/tests/protocol/opcua/golden/";

std::vector<std::byte> derived(const nlohmann::json& keys) {
  std::vector<std::byte> all;
  for (const char* const part : {"signingKey", "encryptingKey", "initializationVector"}) {
    const auto octets = octets_of(keys.at(part).get<std::string>());
    all.insert(all.end(), octets.begin(), octets.end());
  }
  return all;
}

}  // namespace

std::vector<std::byte> octets_of(const std::string& text) {
  std::vector<std::byte> octets;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    octets.push_back(static_cast<std::byte>(std::stoul(text.substr(i, 2), nullptr, 16)));
  return octets;
}

std::string hexadecimal(const std::vector<std::byte>& octets) {
  const std::string digits = "0123456789abcdef";
  std::string text;
  for (const std::byte each : octets)
    text += {digits[static_cast<unsigned>(each) >> 4], digits[static_cast<unsigned>(each) & 15]};
  return text;
}

std::vector<RecordedMessage> transcript(const std::string& name) {
  std::vector<RecordedMessage> messages;
  std::ifstream file(folder + name + ".jsonl");
  for (std::string line; std::getline(file, line);) {
    const auto json = nlohmann::json::parse(line);
    RecordedMessage message;
    message.number = json.at("n");
    message.connection = json.at("connection");
    message.from_client = json.at("dir") == "client to server";
    message.type = json.at("type");
    message.octets = octets_of(json.at("hex"));
    message.clear = octets_of(json.value("clearHex", std::string()));
    message.encoding_id = json.value("encodingId", std::string());
    if (json.contains("derivedKeys"))
      message.keys = RecordedKeys{json["derivedKeys"].at("tokenId"), derived(json["derivedKeys"].at("client")),
                                  derived(json["derivedKeys"].at("server"))};
    messages.push_back(std::move(message));
  }
  return messages;
}

std::string golden_file(const std::string& name) {
  std::ifstream file(folder + name);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace takt::opcua::test
