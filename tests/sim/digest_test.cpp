// SPDX-License-Identifier: Apache-2.0
#include "sim/digest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>
#include <vector>

namespace takt::sim {
namespace {

struct Record {
  std::uint32_t kind;
  std::uint64_t who;
  std::int64_t when;
  std::uint64_t what;
};

std::uint64_t digest_of(const std::vector<Record>& records) {
  Digest digest;
  for (const Record& r : records) digest.add(r.kind, r.who, TrueTime::from_ps(r.when), r.what);
  return digest.value();
}

TEST(Digest, EmptyIsZero) { EXPECT_EQ(Digest().value(), 0u); }

TEST(Digest, TheOrderOfRecordsDoesNotMatter) {
  std::vector<Record> records = {{1, 2, 3, 4}, {2, 2, 3, 4}, {1, 2, 3, 5}, {1, 9, 3, 4}};
  const std::uint64_t expected = digest_of(records);
  std::sort(records.begin(), records.end(),
            [](const Record& a, const Record& b) { return a.what + a.who > b.what + b.who; });
  do {
    EXPECT_EQ(digest_of(records), expected);
  } while (std::next_permutation(records.begin(), records.end(), [](const Record& a, const Record& b) {
    return std::tuple(a.kind, a.who, a.what) < std::tuple(b.kind, b.who, b.what);
  }));
}

// All 4^4 records with small arguments differ, so every argument counts and none can stand in for another.
TEST(Digest, EveryArgumentCounts) {
  std::set<std::uint64_t> seen;
  for (std::uint32_t kind = 0; kind < 4; ++kind)
    for (std::uint64_t who = 0; who < 4; ++who)
      for (std::int64_t when = 0; when < 4; ++when)
        for (std::uint64_t what = 0; what < 4; ++what) seen.insert(digest_of({{kind, who, when, what}}));
  EXPECT_EQ(seen.size(), 256u);
}

// A key that was made before says the same as kind and place.
TEST(Digest, KeysStandForKindAndPlace) {
  for (std::uint32_t kind = 0; kind < 4; ++kind)
    for (std::uint64_t who = 0; who < 4; ++who) {
      Digest digest;
      digest.add(Digest::key_of(kind, who), TrueTime::from_ps(7), 9);
      EXPECT_EQ(digest.value(), digest_of({{kind, who, 7, 9}}));
    }
}

TEST(Digest, ContentsDoNotSwapBetweenRecords) {
  // The same places, times and contents, differently combined.
  EXPECT_NE(digest_of({{1, 1, 10, 5}, {1, 2, 20, 6}}), digest_of({{1, 1, 10, 6}, {1, 2, 20, 5}}));
  EXPECT_NE(digest_of({{1, 1, 10, 5}, {1, 2, 20, 6}}), digest_of({{1, 1, 20, 5}, {1, 2, 10, 6}}));
  EXPECT_NE(digest_of({{1, 1, 10, 5}, {2, 2, 10, 6}}), digest_of({{2, 1, 10, 5}, {1, 2, 10, 6}}));
}

TEST(Digest, CountsHowOftenARecordCame) {
  const Record record{1, 2, 3, 4};
  std::set<std::uint64_t> seen = {0};
  for (std::size_t n = 1; n <= 64; ++n) seen.insert(digest_of(std::vector<Record>(n, record)));
  EXPECT_EQ(seen.size(), 65u);
}

// Changing one bit of any argument changes about half of the bits of the digest.
TEST(Digest, MixesWell) {
  const Record base{3, 0x0000'0005'0000'0007, 1'000'000'000, 42};
  int changed = 0;
  int trials = 0;
  for (int bit = 0; bit < 32; ++bit) {
    for (int field = 0; field < 4; ++field) {
      Record other = base;
      if (field == 0) other.kind ^= 1u << bit;
      if (field == 1) other.who ^= 1ULL << bit;
      if (field == 2) other.when ^= std::int64_t{1} << bit;
      if (field == 3) other.what ^= 1ULL << bit;
      changed += __builtin_popcountll(digest_of({base}) ^ digest_of({other}));
      ++trials;
    }
  }
  // 128 trials of 64 bits: mean 32 a trial, standard error of the mean 4 / sqrt(128) = 0.35; allow six of them.
  EXPECT_NEAR(static_cast<double>(changed) / trials, 32.0, 2.1);
}

// Pinned: the digest of a run never changes between versions of the program. Computed independently (a few lines of
// Python) from the definition in digest.hpp.
TEST(Digest, PinnedValues) {
  EXPECT_EQ(mix64(0), 0u);
  EXPECT_EQ(mix64(1), 0x5692161D100B05E5ULL);
  EXPECT_EQ(digest_of({{1, 2, 3, 4}}), 0xFE2273D59479334DULL);
  EXPECT_EQ(digest_of({{1, 2, 3, 4}, {2, 0x100000000ULL, 1'000'000, 99}}), 0x3DBB4C6ADCC36A73ULL);
}

TEST(Digest, AllPartsOfWhatIsJoinedCount) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t a = 0; a < 8; ++a)
    for (std::uint64_t b = 0; b < 8; ++b) {
      seen.insert(joined(a, b));
      for (std::uint64_t c = 0; c < 8; ++c) seen.insert(Content(a, b, c).value());
      seen.insert(Content(a, b).value());
    }
  EXPECT_EQ(seen.size(), 64u + 512u + 64u);
}

// Every octet counts where it stands, and so does their number: 0 to 20 octets, all zero but one.
TEST(Digest, HashOfOctets) {
  std::set<std::uint64_t> seen;
  std::size_t count = 0;
  for (std::size_t length = 0; length <= 20; ++length) {
    std::vector<std::byte> octets(length);
    seen.insert(hash_of(octets));
    ++count;
    for (std::size_t at = 0; at < length; ++at)
      for (const int value : {1, 2, 128}) {
        octets[at] = static_cast<std::byte>(value);
        seen.insert(hash_of(octets));
        octets[at] = std::byte{0};
        ++count;
      }
  }
  EXPECT_EQ(seen.size(), count);
}

}  // namespace
}  // namespace takt::sim
