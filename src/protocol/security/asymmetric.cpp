// SPDX-License-Identifier: Apache-2.0
#include "security/asymmetric.hpp"

#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rsa.h>

#include <algorithm>
#include <stdexcept>

#include "security/openssl_handles.hpp"
#include "sim/check.hpp"

namespace takt::security {
namespace {

using detail::characters;
using detail::writable;

bool set_padding(EVP_PKEY_CTX* context, SignatureScheme scheme) {
  if (scheme == SignatureScheme::pkcs1_sha256) return EVP_PKEY_CTX_set_rsa_padding(context, RSA_PKCS1_PADDING) > 0;
  return EVP_PKEY_CTX_set_rsa_padding(context, RSA_PKCS1_PSS_PADDING) > 0 &&
         EVP_PKEY_CTX_set_rsa_pss_saltlen(context, RSA_PSS_SALTLEN_DIGEST) > 0;
}

bool set_padding(EVP_PKEY_CTX* context, EncryptionScheme scheme) {
  const EVP_MD* const digest = scheme == EncryptionScheme::oaep_sha1 ? EVP_sha1() : EVP_sha256();
  return EVP_PKEY_CTX_set_rsa_padding(context, RSA_PKCS1_OAEP_PADDING) > 0 &&
         EVP_PKEY_CTX_set_rsa_oaep_md(context, digest) > 0 && EVP_PKEY_CTX_set_rsa_mgf1_md(context, digest) > 0;
}

}  // namespace

std::size_t PublicKey::octets() const { return static_cast<std::size_t>(EVP_PKEY_get_size(key_.get())); }
bool PublicKey::is_rsa() const { return EVP_PKEY_is_a(key_.get(), "RSA") == 1; }

bool PublicKey::verify(SignatureScheme scheme, Octets octets, Octets signature) const {
  const detail::ForgetErrors forget;
  const detail::DigestContext context(EVP_MD_CTX_new());
  EVP_PKEY_CTX* key = nullptr;
  if (!context || EVP_DigestVerifyInit(context.get(), &key, EVP_sha256(), nullptr, key_.get()) <= 0 ||
      !set_padding(key, scheme))
    return false;
  return EVP_DigestVerify(context.get(), characters(signature), signature.size(), characters(octets), octets.size()) ==
         1;
}

std::optional<std::vector<std::byte>> PublicKey::encrypt(EncryptionScheme scheme, Octets clear) const {
  const detail::ForgetErrors forget;
  const detail::KeyContext context(EVP_PKEY_CTX_new(key_.get(), nullptr));
  if (!context || octets() <= padding_octets(scheme) || EVP_PKEY_encrypt_init(context.get()) <= 0 ||
      !set_padding(context.get(), scheme))
    return std::nullopt;
  std::vector<std::byte> cipher;
  const std::size_t block = clear_octets(scheme);
  for (std::size_t at = 0; at < clear.size(); at += block) {
    const Octets part = clear.subspan(at, std::min(block, clear.size() - at));
    std::vector<std::byte> out(octets());
    std::size_t size = out.size();
    if (EVP_PKEY_encrypt(context.get(), writable(out), &size, characters(part), part.size()) <= 0 || size != out.size())
      return std::nullopt;
    cipher.insert(cipher.end(), out.begin(), out.end());
  }
  return cipher;
}

PrivateKey PrivateKey::generate(unsigned bits) {
  TAKT_CHECK(bits >= 2048 && bits <= 4096, "keys of 2048 to 4096 bits");
  EVP_PKEY* const key = EVP_RSA_gen(bits);
  if (key == nullptr) throw std::runtime_error("OpenSSL makes no RSA key");
  return PrivateKey(std::shared_ptr<EVP_PKEY>(key, EVP_PKEY_free));
}

std::optional<PrivateKey> PrivateKey::from_pem(std::string_view text) {
  const detail::ForgetErrors forget;
  const detail::Bio bio = detail::bio_of(text);
  // An empty password instead of a question on the terminal.
  EVP_PKEY* const key = bio ? PEM_read_bio_PrivateKey(bio.get(), nullptr, nullptr, const_cast<char*>("")) : nullptr;
  if (key == nullptr) return std::nullopt;
  PrivateKey made{std::shared_ptr<EVP_PKEY>(key, EVP_PKEY_free)};
  if (!made.public_.is_rsa()) return std::nullopt;
  return made;
}

std::string PrivateKey::to_pem() const {
  const detail::Bio bio(BIO_new(BIO_s_mem()));
  TAKT_CHECK(bio && PEM_write_bio_PrivateKey(bio.get(), public_.key_.get(), nullptr, nullptr, 0, nullptr, nullptr) == 1,
             "a key can be written");
  return detail::text_in(bio.get());
}

std::vector<std::byte> PrivateKey::sign(SignatureScheme scheme, Octets octets) const {
  const detail::DigestContext context(EVP_MD_CTX_new());
  EVP_PKEY_CTX* key = nullptr;
  std::vector<std::byte> signature(public_.octets());
  std::size_t size = signature.size();
  const bool is_signed =
      context && EVP_DigestSignInit(context.get(), &key, EVP_sha256(), nullptr, public_.key_.get()) > 0 &&
      set_padding(key, scheme) &&
      EVP_DigestSign(context.get(), writable(signature), &size, characters(octets), octets.size()) > 0;
  TAKT_CHECK(is_signed && size == signature.size(), "a private RSA key signs");
  return signature;
}

std::optional<Secret> PrivateKey::decrypt(EncryptionScheme scheme, Octets cipher) const {
  const detail::ForgetErrors forget;
  const std::size_t block = public_.octets();
  const detail::KeyContext context(EVP_PKEY_CTX_new(public_.key_.get(), nullptr));
  if (!context || cipher.empty() || cipher.size() % block != 0 || block <= padding_octets(scheme) ||
      EVP_PKEY_decrypt_init(context.get()) <= 0 || !set_padding(context.get(), scheme))
    return std::nullopt;
  Secret clear(cipher.size());
  std::size_t used = 0;
  Secret out(block);
  for (std::size_t at = 0; at < cipher.size(); at += block) {
    std::size_t size = block;
    if (EVP_PKEY_decrypt(context.get(), writable(out.octets()), &size, characters(cipher.subspan(at)), block) <= 0)
      return std::nullopt;
    std::copy_n(out.octets().begin(), size, clear.octets().begin() + static_cast<std::ptrdiff_t>(used));
    used += size;
  }
  return Secret(Octets(clear.octets()).first(used));
}

}  // namespace takt::security
