// SPDX-License-Identifier: Apache-2.0
// Our own certificate, and whom we trust.
#include <gtest/gtest.h>

#include "opcua/channel/policy.hpp"
#include "opcua/channel/trust_list.hpp"
#include "security/key_derivation.hpp"
#include "transcript.hpp"

namespace takt::opcua {
namespace {

using security::Certificate;

constexpr std::int64_t now = 1'800'000'000;

const security::PrivateKey& key() {
  static const security::PrivateKey made = security::PrivateKey::generate(2048);
  return made;
}

security::OwnCertificate description() {
  security::OwnCertificate what;
  what.application_uri = "urn:test:takt:left";
  what.common_name = "left";
  what.dns_names = {"localhost"};
  what.addresses = {"127.0.0.1"};
  what.valid_from = now - 10;
  what.valid_until = now + 10;
  return what;
}

TEST(OwnCertificate, SaysWhatItWasMadeFor) {
  const Certificate made = self_signed(key(), description());
  const auto again = Certificate::from_der(made.der());
  ASSERT_TRUE(again);
  EXPECT_EQ(again->application_uri(), "urn:test:takt:left");
  EXPECT_EQ(again->subject(), "CN=left");
  EXPECT_EQ(again->valid_from(), now - 10);
  EXPECT_EQ(again->valid_until(), now + 10);
  EXPECT_TRUE(again->is_strong());
  EXPECT_TRUE(again->may_sign_and_encrypt());
  EXPECT_TRUE(again->may_be_client());
  EXPECT_FALSE(again->is_authority());
  EXPECT_EQ(Certificate::from_pem(made.to_pem()), made);
  EXPECT_EQ(security::first_der_octets(made.der()), made.der().size());
}

TEST(OwnCertificate, NamesThatWouldSaySomethingElseAreRefused) {
  auto what = description();
  what.dns_names = {"a,URI:urn:other"};
  EXPECT_THROW(self_signed(key(), what), std::runtime_error);
}

TEST(Keys, SignAndDecryptByEveryScheme) {
  const std::vector<std::byte> text(500, std::byte{0x31});
  const auto again = security::PrivateKey::from_pem(key().to_pem());
  ASSERT_TRUE(again);
  for (const PolicyInfo& policy : policies) {
    const auto signature = key().sign(policy.signature, text);
    EXPECT_TRUE(again->public_key().verify(policy.signature, text, signature));
    EXPECT_FALSE(again->public_key().verify(policy.signature, Octets(text).first(499), signature));
    const auto cipher = key().public_key().encrypt(policy.encryption, text);
    ASSERT_TRUE(cipher);
    EXPECT_EQ(cipher->size() % 256, 0u);
    const auto clear = again->decrypt(policy.encryption, *cipher);
    ASSERT_TRUE(clear);
    EXPECT_EQ(std::vector<std::byte>(clear->octets().begin(), clear->octets().end()), text);
    auto broken = *cipher;
    broken[300] ^= std::byte{1};
    EXPECT_FALSE(again->decrypt(policy.encryption, broken));
    EXPECT_FALSE(again->decrypt(policy.encryption, Octets(*cipher).first(255)));
  }
  EXPECT_FALSE(security::PrivateKey::from_pem("no key"));
}

TEST(Trust, ByTheListAndInOrder) {
  const Certificate own = self_signed(key(), description());
  TrustList trust;
  EXPECT_EQ(check_certificate(own, trust, now).status, StatusCode::BadSecurityChecksFailed);
  trust.trusted.push_back(own);
  EXPECT_EQ(check_certificate(own, trust, now).status, StatusCode::Good);
  EXPECT_EQ(check_certificate(own, trust, now + 11).status, StatusCode::BadCertificateTimeInvalid);
  EXPECT_EQ(check_certificate(own, trust, now - 11).status, StatusCode::BadCertificateTimeInvalid);
  // A stranger learns nothing of the rest.
  EXPECT_EQ(check_certificate(own, {}, now + 11).status, StatusCode::BadSecurityChecksFailed);
}

// The same name and another key: a self-signed certificate vouches for none but itself.
TEST(Trust, NotByTheName) {
  TrustList trust;
  trust.trusted.push_back(self_signed(key(), description()));
  const Certificate other = self_signed(security::PrivateKey::generate(2048), description());
  EXPECT_EQ(check_certificate(other, trust, now).status, StatusCode::BadSecurityChecksFailed);
  EXPECT_FALSE(other.is_issued_by(trust.trusted[0]));
}

TEST(Certificates, WhatIsNoneIsNone) {
  const Certificate own = self_signed(key(), description());
  for (std::size_t size = 0; size < own.der().size(); size += 7)
    EXPECT_FALSE(Certificate::from_der(own.der().first(size))) << size;
  EXPECT_FALSE(Certificate::from_der(test::octets_of("308200")));
  EXPECT_FALSE(Certificate::from_pem(test::golden_file("client.key.pem")));
}

// The vector for P_SHA256 that is passed around for TLS 1.2; its octets were computed here with Python's hmac.
TEST(KeyDerivation, PSha256) {
  const auto secret = test::octets_of("9bbe436ba940f017b17652849a71db35");
  const auto seed = test::octets_of(
      "74657374206c6162656c"
      "a0ba9f936cda311827a6f796ffd5198c");
  const auto made = security::p_sha256(secret, seed, 100);
  EXPECT_EQ(test::hexadecimal({made.octets().begin(), made.octets().end()}).substr(0, 64),
            "e3f229ba727be17b8d122620557cd453c2aab21d07c3d495329b52d4e61edb5a");
}

TEST(Passwords, MatchTheirHashOnly) {
  const std::vector<std::byte> salt(16, std::byte{9});
  const auto hash = security::PasswordHash::of("secret", salt);
  const auto again = security::PasswordHash::parse(hash.text());
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->matches("secret"));
  EXPECT_FALSE(again->matches("secret "));
  EXPECT_FALSE(again->matches(""));
  for (const char* const text :
       {"", "secret", "scrypt$30$8$1$00$00", "scrypt$14$8$1$0011223344556677$00", "bcrypt$14$8$1$0011223344556677$00"})
    EXPECT_FALSE(security::PasswordHash::parse(text)) << text;
}

}  // namespace
}  // namespace takt::opcua
