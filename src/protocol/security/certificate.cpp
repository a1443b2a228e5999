// SPDX-License-Identifier: Apache-2.0
#include "security/certificate.hpp"

#include <openssl/asn1.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <ctime>
#include <stdexcept>

#include "security/openssl_handles.hpp"
#include "sim/check.hpp"

namespace takt::security {

/// OpenSSL's key within a PublicKey.
struct CertificateAccess {
  static EVP_PKEY* key_of(const PublicKey& key) { return key.key_.get(); }
};

namespace {

std::vector<std::byte> der_of(x509_st* certificate) {
  unsigned char* octets = nullptr;
  const int size = i2d_X509(certificate, &octets);
  TAKT_CHECK(size > 0, "a certificate that was read can be written");
  const auto* const first = reinterpret_cast<const std::byte*>(octets);
  std::vector<std::byte> der(first, first + size);
  OPENSSL_free(octets);
  return der;
}

std::int64_t seconds_of(const ASN1_TIME* time) {
  tm parts = {};
  return ASN1_TIME_to_tm(time, &parts) == 1 ? static_cast<std::int64_t>(::timegm(&parts)) : 0;
}

void add_extension(X509* certificate, int id, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
  X509_EXTENSION* const extension = X509V3_EXT_conf_nid(nullptr, &context, id, value.c_str());
  const bool is_added = extension != nullptr && X509_add_ext(certificate, extension, -1) == 1;
  X509_EXTENSION_free(extension);
  if (!is_added) throw std::runtime_error("OpenSSL takes no certificate with " + value);
}

/// In the text form of an extension commas divide, so a name with one would say something else.
void add_names(std::string& names, const char* kind, const std::vector<std::string>& of) {
  for (const std::string& each : of) {
    if (each.find_first_of(",\n\r") != std::string::npos)
      throw std::runtime_error("no name for a certificate: " + each);
    names += (names.empty() ? "" : ",") + std::string(kind) + each;
  }
}

}  // namespace

std::size_t first_der_octets(Octets octets) {
  const detail::ForgetErrors forget;
  const auto* at = reinterpret_cast<const unsigned char*>(octets.data());
  long length = 0;
  int tag = 0;
  int of = 0;
  if (octets.empty() || (ASN1_get_object(&at, &length, &tag, &of, static_cast<long>(octets.size())) & 0x80) != 0 ||
      length < 0)
    return 0;
  const auto head = static_cast<std::size_t>(reinterpret_cast<const std::byte*>(at) - octets.data());
  return head + static_cast<std::size_t>(length) <= octets.size() ? head + static_cast<std::size_t>(length) : 0;
}

Certificate::Certificate(std::shared_ptr<x509_st> certificate, PublicKey key)
    : certificate_(std::move(certificate)),
      der_(der_of(certificate_.get())),
      thumbprint_(sha1(der_)),
      key_(std::move(key)) {}

std::optional<Certificate> Certificate::take(x509_st* certificate) {
  if (certificate == nullptr) return std::nullopt;
  std::shared_ptr<x509_st> owned(certificate, X509_free);
  EVP_PKEY* const key = X509_get_pubkey(certificate);
  if (key == nullptr) return std::nullopt;
  PublicKey public_key{std::shared_ptr<EVP_PKEY>(key, EVP_PKEY_free)};
  if (!public_key.is_rsa()) return std::nullopt;
  return Certificate(std::move(owned), std::move(public_key));
}

std::optional<Certificate> Certificate::from_der(Octets octets) {
  const detail::ForgetErrors forget;
  const std::size_t size = first_der_octets(octets);
  const auto* at = reinterpret_cast<const unsigned char*>(octets.data());
  return size == 0 ? std::nullopt : take(d2i_X509(nullptr, &at, static_cast<long>(size)));
}

std::optional<Certificate> Certificate::from_pem(std::string_view text) {
  const detail::ForgetErrors forget;
  const detail::Bio bio = detail::bio_of(text);
  return bio ? take(PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr)) : std::nullopt;
}

std::string Certificate::to_pem() const {
  const detail::Bio bio(BIO_new(BIO_s_mem()));
  TAKT_CHECK(bio && PEM_write_bio_X509(bio.get(), certificate_.get()) == 1, "a certificate can be written");
  return detail::text_in(bio.get());
}

std::string Certificate::application_uri() const {
  auto* const names =
      static_cast<GENERAL_NAMES*>(X509_get_ext_d2i(certificate_.get(), NID_subject_alt_name, nullptr, nullptr));
  std::string uri;
  for (int i = 0; names != nullptr && i < sk_GENERAL_NAME_num(names) && uri.empty(); ++i) {
    const GENERAL_NAME* const name = sk_GENERAL_NAME_value(names, i);
    if (name->type != GEN_URI) continue;
    const ASN1_IA5STRING* const text = name->d.uniformResourceIdentifier;
    uri.assign(reinterpret_cast<const char*>(ASN1_STRING_get0_data(text)),
               static_cast<std::size_t>(ASN1_STRING_length(text)));
  }
  GENERAL_NAMES_free(names);
  return uri;
}

std::string Certificate::subject() const {
  const detail::Bio bio(BIO_new(BIO_s_mem()));
  if (!bio || X509_NAME_print_ex(bio.get(), X509_get_subject_name(certificate_.get()), 0, XN_FLAG_RFC2253) < 0)
    return {};
  return detail::text_in(bio.get());
}

std::int64_t Certificate::valid_from() const { return seconds_of(X509_get0_notBefore(certificate_.get())); }
std::int64_t Certificate::valid_until() const { return seconds_of(X509_get0_notAfter(certificate_.get())); }

bool Certificate::is_strong() const {
  int digest = NID_undef;
  int bits = 0;
  if (X509_get_signature_info(certificate_.get(), &digest, nullptr, &bits, nullptr) != 1) return false;
  const bool is_sha2 = digest == NID_sha256 || digest == NID_sha384 || digest == NID_sha512;
  return is_sha2 && key_.octets() >= 256 && key_.octets() <= 512;
}

bool Certificate::may_sign_and_encrypt() const {
  const std::uint32_t usage = X509_get_key_usage(certificate_.get());  // all bits where the extension is not there
  return (usage & KU_DIGITAL_SIGNATURE) != 0 && (usage & (KU_KEY_ENCIPHERMENT | KU_DATA_ENCIPHERMENT)) != 0;
}

bool Certificate::may_be_client() const {
  const std::uint32_t usage = X509_get_extended_key_usage(certificate_.get());
  return (usage & XKU_SSL_CLIENT) != 0;
}

bool Certificate::is_authority() const { return X509_check_ca(certificate_.get()) == 1; }

std::optional<std::int64_t> Certificate::path_length() const {
  const long length = X509_get_pathlen(certificate_.get());
  return length < 0 ? std::nullopt : std::optional<std::int64_t>(length);
}

bool Certificate::is_issued_by(const Certificate& issuer) const {
  const detail::ForgetErrors forget;
  return X509_NAME_cmp(X509_get_issuer_name(certificate_.get()), X509_get_subject_name(issuer.certificate_.get())) ==
             0 &&
         X509_verify(certificate_.get(), CertificateAccess::key_of(issuer.key_)) == 1;
}

std::optional<RevocationList> RevocationList::from_der(Octets octets) {
  const detail::ForgetErrors forget;
  const auto* at = reinterpret_cast<const unsigned char*>(octets.data());
  X509_CRL* const list = octets.empty() ? nullptr : d2i_X509_CRL(nullptr, &at, static_cast<long>(octets.size()));
  return list == nullptr ? std::nullopt : std::optional(RevocationList(std::shared_ptr<X509_CRL>(list, X509_CRL_free)));
}

std::optional<RevocationList> RevocationList::from_pem(std::string_view text) {
  const detail::ForgetErrors forget;
  const detail::Bio bio = detail::bio_of(text);
  X509_CRL* const list = bio ? PEM_read_bio_X509_CRL(bio.get(), nullptr, nullptr, nullptr) : nullptr;
  return list == nullptr ? std::nullopt : std::optional(RevocationList(std::shared_ptr<X509_CRL>(list, X509_CRL_free)));
}

bool RevocationList::is_issued_by(const Certificate& issuer) const {
  const detail::ForgetErrors forget;
  return X509_NAME_cmp(X509_CRL_get_issuer(list_.get()), X509_get_subject_name(issuer.certificate_.get())) == 0 &&
         X509_CRL_verify(list_.get(), CertificateAccess::key_of(issuer.key_)) == 1;
}

bool RevocationList::has(const Certificate& certificate) const {
  X509_REVOKED* revoked = nullptr;
  return X509_CRL_get0_by_cert(list_.get(), &revoked, certificate.certificate_.get()) == 1;
}

Certificate self_signed(const PrivateKey& key, const OwnCertificate& what) {
  const std::shared_ptr<X509> made(X509_new(), X509_free);
  EVP_PKEY* const pair = CertificateAccess::key_of(key.public_key());
  X509_NAME* const name = made ? X509_get_subject_name(made.get()) : nullptr;
  const auto* const common_name = reinterpret_cast<const unsigned char*>(what.common_name.data());
  const bool is_begun =
      made && X509_set_version(made.get(), X509_VERSION_3) == 1 &&
      ASN1_INTEGER_set_uint64(X509_get_serialNumber(made.get()), what.serial) == 1 &&
      ASN1_TIME_set(X509_getm_notBefore(made.get()), static_cast<time_t>(what.valid_from)) != nullptr &&
      ASN1_TIME_set(X509_getm_notAfter(made.get()), static_cast<time_t>(what.valid_until)) != nullptr &&
      X509_set_pubkey(made.get(), pair) == 1 &&
      X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_UTF8, common_name, static_cast<int>(what.common_name.size()), -1,
                                 0) == 1 &&
      X509_set_issuer_name(made.get(), name) == 1;
  if (!is_begun) throw std::runtime_error("OpenSSL takes no certificate of " + what.common_name);
  std::string names;
  add_names(names, "URI:", {what.application_uri});
  add_names(names, "DNS:", what.dns_names);
  add_names(names, "IP:", what.addresses);
  add_extension(made.get(), NID_basic_constraints, what.is_authority ? "critical,CA:TRUE" : "critical,CA:FALSE");
  add_extension(made.get(), NID_key_usage,
                what.is_authority
                    ? "critical,keyCertSign,cRLSign"
                    : "critical,digitalSignature,nonRepudiation,keyEncipherment,dataEncipherment,keyCertSign");
  if (!what.is_authority) add_extension(made.get(), NID_ext_key_usage, "serverAuth,clientAuth");
  add_extension(made.get(), NID_subject_alt_name, names);
  add_extension(made.get(), NID_subject_key_identifier, "hash");
  if (X509_sign(made.get(), pair, EVP_sha256()) == 0) throw std::runtime_error("OpenSSL signs no certificate");
  return Certificate(made, key.public_key());
}

}  // namespace takt::security
