// SPDX-License-Identifier: Apache-2.0
// Known answers of the standards: FIPS 180-4, RFC 4231, RFC 2202, NIST SP 800-38A.
#include "security/symmetric.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <string_view>

#include "security/random.hpp"

namespace takt::security::symmetric_test {
namespace {

std::vector<std::byte> from_hex(std::string_view hex) {
  std::vector<std::byte> octets;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    octets.push_back(static_cast<std::byte>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
  return octets;
}
std::string to_hex(Octets octets) {
  std::string hex;
  for (const std::byte octet : octets) {
    hex += "0123456789abcdef"[std::to_integer<unsigned>(octet) >> 4];
    hex += "0123456789abcdef"[std::to_integer<unsigned>(octet) & 15];
  }
  return hex;
}
Octets text(std::string_view characters) { return std::as_bytes(std::span(characters)); }
AesBlock block(std::string_view hex) {
  const auto octets = from_hex(hex);
  AesBlock result;
  std::copy(octets.begin(), octets.end(), result.begin());
  return result;
}

TEST(Digest, OfAbcAndOfNothing) {
  EXPECT_EQ(to_hex(sha1(text("abc"))), "a9993e364706816aba3e25717850c26c9cd0d89d");
  EXPECT_EQ(to_hex(sha256(text("abc"))), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(to_hex(sha256({})), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

// RFC 4231, test case 2; RFC 2202, test case 2.
TEST(Hmac, OfJefe) {
  Hmac with_sha256(Hash::sha256, text("Jefe"));
  std::array<std::byte, 32> mac;
  for (int again = 0; again < 3; ++again) {
    with_sha256.sign(text("what do ya want for nothing?"), mac);
    EXPECT_EQ(to_hex(mac), "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843")
        << "message " << again << " of the same key";
  }
  with_sha256.add(text("what do ya want "));
  with_sha256.add({});
  with_sha256.add(text("for nothing?"));
  with_sha256.finish(mac);
  EXPECT_EQ(to_hex(mac), "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");

  Hmac with_sha1(Hash::sha1, text("Jefe"));
  EXPECT_EQ(with_sha1.size(), 20u);
  with_sha1.sign(text("what do ya want for nothing?"), mac);
  EXPECT_EQ(to_hex(Octets(mac).first(20)), "effcdf6ae5eb2fa2d27416d5f184df9c259a7c79");
}

TEST(Hmac, TellsTheWholeCodeOnly) {
  Hmac hmac(Hash::sha256, text("Jefe"));
  std::array<std::byte, 32> mac;
  hmac.sign(text("halt"), mac);
  EXPECT_TRUE(hmac.verify(text("halt"), mac));
  EXPECT_FALSE(hmac.verify(text("hald"), mac));
  EXPECT_FALSE(hmac.verify(text("halt"), Octets(mac).first(31)));
  EXPECT_FALSE(hmac.verify(text("halt"), {}));
  for (std::size_t bit = 0; bit < 256; ++bit) {
    auto other = mac;
    other[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
    EXPECT_FALSE(hmac.verify(text("halt"), other)) << "bit " << bit;
  }
  Hmac moved = std::move(hmac);
  EXPECT_TRUE(moved.verify(text("halt"), mac));
}

// NIST SP 800-38A, F.5.1 and F.5.5.
TEST(AesCtr, CountsTheWholeBlock) {
  const std::string clear = "6bc1bee22e409f96e93d7e117393172aae2d8a571e03ac9c9eb76fac45af8e5130c81c46a35ce411";
  auto octets = from_hex(clear);
  AesCtr with_128(from_hex("2b7e151628aed2a6abf7158809cf4f3c"));
  const AesBlock counter = block("f0f1f2f3f4f5f6f7f8f9fafbfcfdfeff");
  with_128.apply(counter, octets);
  EXPECT_EQ(to_hex(octets), "874d6191b620e3261bef6864990db6ce9806f66b7970fdff8617187bb9fffdff5ae4df3edbd5d35e")
      << "the third block is cut";
  with_128.apply(counter, octets);
  EXPECT_EQ(to_hex(octets), clear) << "and back, with the same object";
  AesCtr with_256(from_hex("603deb1015ca71be2b73aef0857d77811f352c073b6108d72d9810a30914dff4"));
  with_256.apply(counter, octets);
  EXPECT_EQ(to_hex(octets).substr(0, 64), "601ec313775789a5b7a7f504bbf3d228f443e3ca4d62b59aca84e990cacaf5c5");
  with_256.apply(counter, {});
}

// NIST SP 800-38A, F.2.1, F.2.2 and F.2.5.
TEST(AesCbc, ChainsBlocks) {
  const std::string clear = "6bc1bee22e409f96e93d7e117393172aae2d8a571e03ac9c9eb76fac45af8e51";
  const AesBlock initial = block("000102030405060708090a0b0c0d0e0f");
  auto octets = from_hex(clear);
  AesCbc with_128(from_hex("2b7e151628aed2a6abf7158809cf4f3c"));
  with_128.encrypt(initial, octets);
  EXPECT_EQ(to_hex(octets), "7649abac8119b246cee98e9b12e9197d5086cb9b507219ee95db113a917678b2");
  with_128.decrypt(initial, octets);
  EXPECT_EQ(to_hex(octets), clear);
  AesCbc with_256(from_hex("603deb1015ca71be2b73aef0857d77811f352c073b6108d72d9810a30914dff4"));
  with_256.encrypt(initial, octets);
  EXPECT_EQ(to_hex(octets), "f58c4c04d6e5f1ba779eabfb5f7bfbd69cfc4e967edb808d679f777bc6702c7d");
  EXPECT_THROW(with_256.encrypt(initial, std::span(octets).first(31)), sim::InvariantBroken);
}

TEST(Keys, HaveTheirLengths) {
  EXPECT_THROW(AesCtr(from_hex("00")), sim::InvariantBroken);
  EXPECT_THROW(AesCbc(std::vector<std::byte>(24)), sim::InvariantBroken);
  EXPECT_THROW(Hmac(Hash::sha256, {}), sim::InvariantBroken);
}

TEST(Secret, IsClearedAndCompared) {
  std::vector<std::byte> octets(40, std::byte{7});
  wipe(octets);
  EXPECT_EQ(octets, std::vector<std::byte>(40));
  Secret key(text("a key"));
  Secret copy = key;
  EXPECT_TRUE(copy == key);
  Secret moved = std::move(key);
  EXPECT_TRUE(moved == copy);
  copy = Secret(text("a kez"));
  EXPECT_FALSE(moved == copy);
  copy = Secret(text("a ke"));
  EXPECT_FALSE(moved == copy);
  EXPECT_TRUE(Secret() == Secret(Octets()));
}

// Two draws of 128 bits are the same once in 2^128 runs of the test.
TEST(SystemRandom, Differs) {
  SystemRandom random;
  AesBlock first{};
  AesBlock second{};
  random.fill(first);
  random.fill(second);
  EXPECT_NE(first, second);
  EXPECT_NE(first, AesBlock{});
  random.fill({});
}

}  // namespace
}  // namespace takt::security::symmetric_test
