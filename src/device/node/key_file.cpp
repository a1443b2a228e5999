// SPDX-License-Identifier: Apache-2.0
#include "node/key_file.hpp"

#include <utility>

#include "node/message_security.hpp"
#include "node/private_file.hpp"

namespace takt::node {
namespace {

constexpr std::size_t least_secret = 32;

int digit_of(char c) {
  return c >= '0' && c <= '9'   ? c - '0'
         : c >= 'a' && c <= 'f' ? c - 'a' + 10
         : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                : -1;
}

/// The octets; the digits are cleared. Nothing if some are none.
std::optional<security::Secret> from_hex(std::string& digits) {
  security::Secret octets(digits.size() / 2);
  bool is_sound = digits.size() % 2 == 0;
  for (std::size_t i = 0; is_sound && i < octets.size(); ++i) {
    const int high = digit_of(digits[2 * i]);
    const int low = digit_of(digits[2 * i + 1]);
    is_sound = high >= 0 && low >= 0;
    if (is_sound) octets.octets()[i] = static_cast<std::byte>(high << 4 | low);
  }
  wipe(digits);
  return is_sound ? std::optional(std::move(octets)) : std::nullopt;
}

}  // namespace

const json::Object& describe(json::Type<KeyFile>) {
  using json::optional;
  using json::required;
  static constexpr json::Field fields[] = {
      required<&KeyFile::group>("group", "The SecurityGroup."),
      optional<&KeyFile::policy>("policy", "The same as that of the programs."),
      optional<&KeyFile::secret>(
          "secret", "Hexadecimal digits, 64 at least, the same at all nodes: each key is derived from it. Or"),
      optional<&KeyFile::keys>(
          "keys", "the keys, each 104 (aes128-ctr) or 136 (aes256-ctr) hexadecimal digits, one behind the other.",
          {.min_items = 1, .max_items = 4096}),
      optional<&KeyFile::first_token>("first_token", "SecurityTokenId of the first key.", {.min = 1}),
      optional<&KeyFile::first_at>(
          "first_at",
          "When its time begins: seconds since 1970 on CLOCK_REALTIME, or on CLOCK_TAI if the nodes share that.",
          {.min = 0, .max = 4'000'000'000}),
  };
  static constexpr std::string_view members[] = {"secret", "keys"};
  static constexpr json::Group groups[] = {json::exactly_one_of(members)};
  static constexpr json::Object table =
      json::object<KeyFile>("keys", "Keys of a SecurityGroup.", fields, {.groups = groups});
  return table;
}

security::KeyRing LoadedKeys::ring(sim::Duration lifetime) const {
  return {policy, schedule(lifetime), source->clone()};
}

std::optional<LoadedKeys> load_keys(const std::string& path, const json::Place& named_at,
                                    json::Diagnostics& diagnostics) {
  const std::size_t errors_before = diagnostics.errors();
  auto text = read_private(path, "keys", named_at, diagnostics);
  if (!text) return std::nullopt;
  KeyFile file;
  const auto document = json::parse(*text, path, diagnostics);
  wipe(*text);
  if (!document || !json::decode(*document, file, diagnostics)) return std::nullopt;
  const auto refuse = [&](const json::Place& place, const std::string& expected) {
    diagnostics.error(place, "not a key", {"something else, which is not shown", expected});
  };
  LoadedKeys loaded{file.group, file.policy, file.first_token, file.first_at * 1'000'000'000, nullptr};
  if (file.secret) {
    auto secret = from_hex(*file.secret);
    if (!secret || secret->size() < least_secret)
      refuse(file.where.at("secret"), "64 hexadecimal digits or more, in pairs");
    else
      loaded.source = std::make_shared<security::DerivedKeys>(file.policy, file.group, std::move(*secret));
  }
  std::vector<security::Secret> keys;
  for (std::size_t i = 0; i < file.keys.size(); ++i) {
    auto key = from_hex(file.keys[i]);
    const std::size_t octets = security::key_octets(file.policy);
    if (!key || key->size() != octets)
      refuse(file.where.at("keys", i), std::to_string(2 * octets) + " hexadecimal digits");
    else
      keys.push_back(std::move(*key));
  }
  if (!file.secret) loaded.source = std::make_shared<security::ListedKeys>(file.first_token, std::move(keys));
  return diagnostics.errors() == errors_before ? std::optional(std::move(loaded)) : std::nullopt;
}

}  // namespace takt::node
