// SPDX-License-Identifier: Apache-2.0
// Stands in for libFuzzer: each file of a folder as it is, then with mutations that are the same in every run.
//
// usage: takt_corpus_NAME_test FOLDER [MUTATIONS OF A FILE]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "sim/random.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Octets = std::vector<std::uint8_t>;

void feed(const Octets& octets) {
  const Octets exact(octets.begin(), octets.end());  // of its exact size: sanitizers see what is read behind it
  LLVMFuzzerTestOneInput(exact.data(), exact.size());
}

/// Some octets are others, are missing, or stand twice.
Octets mutated(Octets octets, takt::sim::RandomStream& chance) {
  for (std::uint64_t left = 1 + chance.below(4); left > 0 && !octets.empty(); --left) {
    const auto at = octets.begin() + static_cast<std::ptrdiff_t>(chance.below(octets.size()));
    const auto end = at + static_cast<std::ptrdiff_t>(1 + chance.below(std::min<std::uint64_t>(
                                                              8, static_cast<std::uint64_t>(octets.end() - at))));
    switch (chance.below(5)) {
      case 0:
        *at = static_cast<std::uint8_t>(chance.below(256));
        break;
      case 1:
        *at ^= static_cast<std::uint8_t>(1U << chance.below(8));
        break;
      case 2:
        std::fill(at, end, static_cast<std::uint8_t>(chance.below(2) == 0 ? 0 : 0xFF));
        break;
      case 3:
        octets.erase(at, end);
        break;
      default: {
        const Octets twice(at, end);
        octets.insert(at, twice.begin(), twice.end());
      }
    }
  }
  return octets;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2 && count != 3) return 2;
  const int mutations = count == 3 ? std::atoi(arguments[2]) : 100;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(arguments[1])) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) {
    std::printf("%s\n", file.filename().c_str());
    std::fflush(stdout);  // who fails is the last one
    std::ifstream stream(file, std::ios::binary);
    const Octets octets{std::istreambuf_iterator<char>(stream), {}};
    feed(octets);
    takt::sim::RandomStream chance(1, file.filename().string(), "mutations");
    for (int i = 0; i < mutations; ++i) feed(mutated(octets, chance));
  }
  if (files.empty()) std::fprintf(stderr, "no corpus in %s\n", arguments[1]);
  return files.empty() ? 1 : 0;
}
