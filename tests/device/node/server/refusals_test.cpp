// SPDX-License-Identifier: Apache-2.0
// What a server says of whom it refuses, and what it keeps of them.
#include "node/server/refusals.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "node/notices.hpp"
#include "node/server/pki.hpp"

namespace takt::node {
namespace {

namespace fs = std::filesystem;

sim::LocalTime at_s(std::int64_t seconds) { return sim::LocalTime::from_ps(seconds * 1'000'000'000'000); }

TEST(Refusals, TheFirstIsToldAndTheRestCounted) {
  Refusals refusals;
  EXPECT_EQ(refusals.take("10.0.0.7", "a sign-in", "", at_s(1)), "server: refused from 10.0.0.7: a sign-in");
  for (int i = 0; i < 300; ++i) EXPECT_FALSE(refusals.take("10.0.0.7", "a sign-in", "", at_s(2)));
  EXPECT_FALSE(refusals.due(at_s(60)));
  EXPECT_EQ(refusals.due(at_s(61)), "server: refused from 10.0.0.7: a sign-in: 300 more within a minute");
  EXPECT_FALSE(refusals.due(at_s(200)));
  EXPECT_EQ(refusals.count(), 301u);
}

// Three hundred names of one host do not hide what another kind, or another host, is refused for.
TEST(Refusals, NamesOfStrangersHideNothing) {
  Refusals refusals;
  int told = 0;
  for (int i = 0; i < 300; ++i)
    told += refusals.take("10.0.0.7", "a certificate", "CN=s" + std::to_string(i), at_s(1)) ? 1 : 0;
  EXPECT_EQ(told, 5);
  EXPECT_TRUE(refusals.take("10.0.0.7", "a sign-in", "", at_s(1)));
  EXPECT_TRUE(refusals.take("10.0.0.8", "a certificate", "CN=newcomer", at_s(1)));
}

TEST(Refusals, HostsWithoutNumberAreBounded) {
  Refusals refusals;
  for (int i = 0; i < 10'000; ++i)
    for (int twice = 0; twice < 2; ++twice)
      refusals.take("10.0." + std::to_string(i / 250) + "." + std::to_string(i % 250), "a sign-in", "", at_s(i));
  std::uint64_t summaries = 0;
  while (refusals.due(at_s(20'000))) ++summaries;
  EXPECT_EQ(summaries, 257u);  // each that has a place, and the others together
}

TEST(Notices, TextsOfStrangersAreCutAndPlain) {
  EXPECT_EQ(cut_text(std::string(20'000, 'x')).size(), 203u);
  const std::string path = fs::temp_directory_path() / ("takt-notices-" + std::to_string(::getpid()));
  std::FILE* const file = std::fopen(path.c_str(), "w+");
  Notices notices(file);
  notices.say("CN=a\nb\x1b[2J");
  notices.finish("");
  std::fclose(file);
  std::ifstream text(path);
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "takt: CN=a\\x0ab\\x1b[2J");
  fs::remove(path);
}

// A pipe that is full: what does not fit is left out, nobody waits for its reader, and the end comes in half a second.
TEST(Notices, NobodyWaitsForTheReader) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  std::FILE* const file = ::fdopen(ends[1], "w");
  const auto begin = std::chrono::steady_clock::now();
  Notices notices(file);
  for (int i = 0; i < 10'000; ++i) notices.say(std::string(300, 'x'));
  notices.finish("the end\n");
  EXPECT_LT(std::chrono::steady_clock::now() - begin,
            std::chrono::seconds(30));  // and not for ever; half a second on a machine at rest
  ::close(ends[0]);
  std::fclose(file);
}

TEST(Pki, RejectedCertificatesMakeRoom) {
  const fs::path folder = fs::temp_directory_path() / ("takt-pki-" + std::to_string(::getpid()));
  fs::create_directories(folder / "rejected");
  Pki pki(folder);
  const security::PrivateKey key = security::PrivateKey::generate(2048);
  const auto certificate = [&](const std::string& name) {
    security::OwnCertificate own;
    own.application_uri = "urn:" + name;
    own.common_name = name;
    own.valid_from = 1'700'000'000;
    own.valid_until = 1'900'000'000;
    return security::self_signed(key, own);
  };
  const auto kept = [&] {
    return std::distance(fs::directory_iterator(folder / "rejected"), fs::directory_iterator());
  };
  const auto newcomer = certificate("newcomer");
  pki.keep_rejected(newcomer, "10.0.0.8");
  const auto name = fs::directory_iterator(folder / "rejected")->path();
  for (int i = 0; i < 100; ++i) pki.keep_rejected(certificate("s" + std::to_string(i)), "10.0.0.7");
  EXPECT_EQ(kept(), static_cast<std::ptrdiff_t>(Pki::most_rejected));
  EXPECT_TRUE(fs::exists(name)) << "of the host with most, one goes";
  fs::remove_all(folder);
}

// Whoever may write there decides who is trusted.
TEST(Pki, FilesThatOthersMayWriteAreNotTrusted) {
  const fs::path folder = fs::temp_directory_path() / ("takt-pki-open-" + std::to_string(::getpid()));
  Pki pki(folder);
  security::SystemRandom random;
  security::OwnCertificate own;
  own.application_uri = "urn:a";
  own.common_name = "a";
  own.valid_from = 1'700'000'000;
  std::string problem;
  ASSERT_TRUE(pki.identity(own, random, problem)) << problem;
  const fs::path trusted = folder / "trusted/certs/a.der";
  fs::copy_file(folder / "own/certs/certificate.der", trusted);
  std::vector<std::string> passed_over;
  EXPECT_EQ(pki.trust_list(passed_over).trusted.size(), 1u);
  EXPECT_TRUE(passed_over.empty());
  fs::permissions(trusted, fs::perms::group_write, fs::perm_options::add);
  EXPECT_TRUE(pki.trust_list(passed_over).trusted.empty());
  EXPECT_EQ(passed_over.size(), 1u);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace takt::node
