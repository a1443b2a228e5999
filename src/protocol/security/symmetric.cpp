// SPDX-License-Identifier: Apache-2.0
#include "security/symmetric.hpp"

#include <openssl/core_names.h>
#include <openssl/evp.h>
#include <openssl/params.h>

#include <algorithm>
#include <limits>

#include "sim/check.hpp"

namespace takt::security {
namespace {

const unsigned char* raw(Octets octets) { return reinterpret_cast<const unsigned char*>(octets.data()); }
unsigned char* raw(std::span<std::byte> octets) { return reinterpret_cast<unsigned char*>(octets.data()); }

int length_of(std::span<const std::byte> octets) {
  TAKT_CHECK(octets.size() <= static_cast<std::size_t>(std::numeric_limits<int>::max()),
             "a message is shorter than 2 GiB");
  return static_cast<int>(octets.size());
}

template <class Digest>
Digest digest(Octets octets, const EVP_MD* method) {
  Digest result;
  unsigned size = 0;
  TAKT_CHECK(EVP_Digest(octets.data(), octets.size(), raw(std::span<std::byte>(result)), &size, method, nullptr) == 1 &&
                 size == result.size(),
             "OpenSSL has SHA");
  return result;
}

/// A cipher with its key and no initial vector yet.
detail::Cipher make_cipher(const EVP_CIPHER* method, Octets key, bool encrypts) {
  detail::Cipher cipher(EVP_CIPHER_CTX_new());
  TAKT_CHECK(
      cipher != nullptr && EVP_CipherInit_ex2(cipher.get(), method, raw(key), nullptr, encrypts ? 1 : 0, nullptr) == 1,
      "OpenSSL has AES");
  EVP_CIPHER_CTX_set_padding(cipher.get(), 0);
  return cipher;
}

const EVP_CIPHER* of_length(Octets key, const EVP_CIPHER* with_16, const EVP_CIPHER* with_32) {
  TAKT_CHECK(key.size() == 16 || key.size() == 32, "a key of AES has 16 or 32 octets");
  return key.size() == 16 ? with_16 : with_32;
}

void run(evp_cipher_ctx_st* cipher, const AesBlock& initial, std::span<std::byte> octets) {
  if (octets.empty()) return;
  int size = 0;
  TAKT_CHECK(EVP_CipherInit_ex2(cipher, nullptr, nullptr, raw(Octets(initial)), -1, nullptr) == 1 &&
                 EVP_CipherUpdate(cipher, raw(octets), &size, raw(Octets(octets)), length_of(octets)) == 1 &&
                 size == length_of(octets),
             "AES takes whole blocks");
}

}  // namespace

Sha1Digest sha1(Octets octets) { return digest<Sha1Digest>(octets, EVP_sha1()); }
Sha256Digest sha256(Octets octets) { return digest<Sha256Digest>(octets, EVP_sha256()); }

void Hmac::Drop::operator()(evp_mac_ctx_st* context) const { EVP_MAC_CTX_free(context); }

Hmac::Hmac(Hash hash, Octets key) : hash_(hash) {
  TAKT_CHECK(!key.empty(), "a key has an octet");
  const std::unique_ptr<EVP_MAC, decltype(&EVP_MAC_free)> method(EVP_MAC_fetch(nullptr, OSSL_MAC_NAME_HMAC, nullptr),
                                                                 &EVP_MAC_free);
  context_.reset(method ? EVP_MAC_CTX_new(method.get()) : nullptr);
  char name[] = "SHA256";
  char short_name[] = "SHA1";
  const OSSL_PARAM parameters[] = {
      OSSL_PARAM_construct_utf8_string(OSSL_MAC_PARAM_DIGEST, hash == Hash::sha1 ? short_name : name, 0),
      OSSL_PARAM_construct_end()};
  TAKT_CHECK(context_ != nullptr && EVP_MAC_init(context_.get(), raw(key), key.size(), parameters) == 1,
             "OpenSSL has HMAC");
  begun_ = true;
}
Hmac::Hmac(Hmac&&) noexcept = default;
Hmac& Hmac::operator=(Hmac&&) noexcept = default;
Hmac::~Hmac() = default;

/// Without a key the context begins anew with the one that it has.
void Hmac::begin() {
  if (!begun_) TAKT_CHECK(EVP_MAC_init(context_.get(), nullptr, 0, nullptr) == 1, "HMAC begins anew");
  begun_ = true;
}

void Hmac::add(Octets octets) {
  begin();
  if (!octets.empty()) TAKT_CHECK(EVP_MAC_update(context_.get(), raw(octets), octets.size()) == 1, "HMAC takes octets");
}

void Hmac::finish(std::span<std::byte> mac) {
  begin();
  std::size_t written = 0;
  TAKT_CHECK(
      mac.size() >= size() && EVP_MAC_final(context_.get(), raw(mac), &written, mac.size()) == 1 && written == size(),
      "HMAC has its length");
  begun_ = false;
}

void Hmac::sign(Octets octets, std::span<std::byte> mac) {
  add(octets);
  finish(mac);
}

bool Hmac::verify(Octets octets, Octets mac) {
  std::array<std::byte, digest_octets(Hash::sha256)> expected;
  sign(octets, expected);
  return equal_in_constant_time(Octets(expected).first(size()), mac);
}

void detail::DropCipher::operator()(evp_cipher_ctx_st* context) const { EVP_CIPHER_CTX_free(context); }

AesCtr::AesCtr(Octets key) : cipher_(make_cipher(of_length(key, EVP_aes_128_ctr(), EVP_aes_256_ctr()), key, true)) {}
void AesCtr::apply(const AesBlock& counter, std::span<std::byte> octets) { run(cipher_.get(), counter, octets); }

AesCbc::AesCbc(Octets key)
    : encrypting_(make_cipher(of_length(key, EVP_aes_128_cbc(), EVP_aes_256_cbc()), key, true)),
      decrypting_(make_cipher(of_length(key, EVP_aes_128_cbc(), EVP_aes_256_cbc()), key, false)) {}

void AesCbc::encrypt(const AesBlock& initial_vector, std::span<std::byte> octets) {
  TAKT_CHECK(octets.size() % aes_block_octets == 0, "AES takes whole blocks");
  run(encrypting_.get(), initial_vector, octets);
}
void AesCbc::decrypt(const AesBlock& initial_vector, std::span<std::byte> octets) {
  TAKT_CHECK(octets.size() % aes_block_octets == 0, "AES takes whole blocks");
  run(decrypting_.get(), initial_vector, octets);
}

}  // namespace takt::security
