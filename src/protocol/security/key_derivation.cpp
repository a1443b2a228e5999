// SPDX-License-Identifier: Apache-2.0
#include "security/key_derivation.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <charconv>

#include "sim/check.hpp"

namespace takt::security {
namespace {

constexpr std::size_t most_memory = std::size_t{64} << 20;
constexpr std::string_view digits = "0123456789abcdef";

std::string hexadecimal(Octets octets) {
  std::string text;
  for (const std::byte each : octets)
    text += {digits[static_cast<unsigned>(each) >> 4], digits[static_cast<unsigned>(each) & 15]};
  return text;
}

std::optional<std::vector<std::byte>> octets_of(std::string_view text) {
  std::vector<std::byte> octets;
  if (text.size() % 2 != 0) return std::nullopt;
  for (std::size_t i = 0; i < text.size(); i += 2) {
    const std::size_t high = digits.find(text[i]);
    const std::size_t low = digits.find(text[i + 1]);
    if (high == std::string_view::npos || low == std::string_view::npos) return std::nullopt;
    octets.push_back(static_cast<std::byte>(high << 4 | low));
  }
  return octets;
}

/// The part before the next '$', which is taken off.
std::string_view part(std::string_view& text) {
  const std::size_t at = std::min(text.find('$'), text.size());
  const std::string_view taken = text.substr(0, at);
  text.remove_prefix(std::min(at + 1, text.size()));
  return taken;
}

bool read(std::string_view text, unsigned least, unsigned most, unsigned& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() && number >= least && number <= most;
}

Sha256Digest scrypt(std::string_view password, Octets salt, unsigned log2_n, unsigned r, unsigned p) {
  Sha256Digest hash{};
  const int done = EVP_PBE_scrypt(password.data(), password.size(), reinterpret_cast<const unsigned char*>(salt.data()),
                                  salt.size(), std::uint64_t{1} << log2_n, r, p, most_memory,
                                  reinterpret_cast<unsigned char*>(hash.data()), hash.size());
  TAKT_CHECK(done == 1, "scrypt works within its memory");
  return hash;
}

}  // namespace

Secret p_sha256(Octets secret, Octets seed, std::size_t octets) {
  Secret made(octets);
  Hmac hmac(Hash::sha256, secret);
  Sha256Digest a{};
  hmac.sign(seed, a);
  for (std::size_t at = 0; at < octets; at += a.size()) {
    Sha256Digest part{};
    hmac.add(a);
    hmac.add(seed);
    hmac.finish(part);
    std::copy_n(part.begin(), std::min(part.size(), octets - at),
                made.octets().begin() + static_cast<std::ptrdiff_t>(at));
    wipe(part);
    Sha256Digest next{};
    hmac.sign(a, next);
    a = next;
  }
  return made;
}

std::optional<PasswordHash> PasswordHash::parse(std::string_view text) {
  PasswordHash made;
  if (part(text) != "scrypt" || !read(part(text), 10, 15, made.log2_n_) || !read(part(text), 1, 8, made.r_) ||
      !read(part(text), 1, 4, made.p_))
    return std::nullopt;
  const auto salt = octets_of(part(text));
  const auto hash = octets_of(text);
  if (!salt || salt->size() < 8 || salt->size() > 64 || !hash || hash->size() != made.hash_.size()) return std::nullopt;
  made.salt_ = *salt;
  std::copy(hash->begin(), hash->end(), made.hash_.begin());
  return made;
}

PasswordHash PasswordHash::of(std::string_view password, Octets salt) {
  PasswordHash made;
  made.salt_.assign(salt.begin(), salt.end());
  made.hash_ = scrypt(password, salt, made.log2_n_, made.r_, made.p_);
  return made;
}

std::string PasswordHash::text() const {
  return "scrypt$" + std::to_string(log2_n_) + "$" + std::to_string(r_) + "$" + std::to_string(p_) + "$" +
         hexadecimal(salt_) + "$" + hexadecimal(hash_);
}

bool PasswordHash::matches(std::string_view password) const {
  return equal_in_constant_time(scrypt(password, salt_, log2_n_, r_, p_), hash_);
}

}  // namespace takt::security
