// SPDX-License-Identifier: Apache-2.0
// Files of keys: refused if others may read them, and no diagnostic shows what they hold.
#include "node/key_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>

#include "node/config.hpp"
#include "node/security_memory.hpp"

namespace takt::node::key_file_test {
namespace {

namespace fs = std::filesystem;

class KeyFiles : public ::testing::Test {
 protected:
  KeyFiles() : folder_(fs::temp_directory_path() / ("takt-key-file-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~KeyFiles() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text, mode_t mode = 0600) {
    const std::string path = folder_ / name;
    std::ofstream(path) << text;
    ::chmod(path.c_str(), mode);
    return path;
  }
  std::string refusal_of(const std::string& path) {
    json::Diagnostics diagnostics;
    EXPECT_FALSE(load_keys(path, {"node.json", 3, 7, "/keys"}, diagnostics));
    return diagnostics.to_text();
  }
  std::string refusal_of_node(const std::string& security) {
    const std::string path =
        write("node.json",
              R"({"node": "plc", "transport": {"kind": "ethernet", "interface": "eth0"}, "security": )" + security +
                  R"(, "program": {"name": "cell", "master": "plc", "slaves": ["left"], "cycle": "1ms"}})");
    json::Diagnostics diagnostics;
    load_config(path, diagnostics);
    return diagnostics.to_text();
  }
  fs::path folder_;
};

const std::string secret = std::string(64, 'a');
const std::string sound = R"({"group": "cell", "secret": ")" + secret + "\"}";

TEST_F(KeyFiles, AreReadByTheirOwnerOnly) {
  json::Diagnostics diagnostics;
  EXPECT_TRUE(load_keys(write("good", sound), {}, diagnostics)) << diagnostics.to_text();
  EXPECT_TRUE(load_keys(write("good", sound, 0400), {}, diagnostics)) << diagnostics.to_text();
  for (const mode_t mode : {0640, 0604, 0620, 0602, 0644, 0610}) {
    const std::string text = refusal_of(write("bad", sound, mode));
    EXPECT_NE(text.find("others than its owner may read or write"), std::string::npos) << text;
    EXPECT_NE(text.find("node.json:3:7"), std::string::npos) << text;
  }
  EXPECT_NE(refusal_of(folder_ / "none").find("cannot be read"), std::string::npos);
  EXPECT_NE(refusal_of(folder_).find("no regular file"), std::string::npos);
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_NE(refusal_of(folder_ / "pipe").find("no regular file"), std::string::npos) << "and nobody waits for it";
}

TEST_F(KeyFiles, AreNotShownByDiagnostics) {
  const std::string key = "deadbeef5ec2e7";
  for (const std::string& text :
       {R"({"group": "cell", "secret": ")" + key + "\"}", R"({"group": "cell", "secret": ")" + key + secret + "x\"}",
        R"({"group": "cell", "keys": [")" + key + "\"]}",
        R"({"group": "cell", "policy": "aes256-ctr", "keys": [")" + key + std::string(90, '0') + "\"]}"}) {
    const std::string said = refusal_of(write("keys", text));
    EXPECT_NE(said.find("not a key"), std::string::npos) << said;
    EXPECT_EQ(said.find(key), std::string::npos) << said;
  }
}

TEST_F(KeyFiles, FitTheirNodes) {
  const std::string path = write("cell.keys", sound);
  const auto has = [](const std::string& text, const std::string& what) {
    return text.find(what) != std::string::npos;
  };
  EXPECT_EQ(refusal_of_node(R"("cell.keys")"), "") << "from the folder of the node's file";
  EXPECT_EQ(refusal_of_node(R"({"mode": "sign", "keys": ")" + path + "\"}"), "");
  EXPECT_TRUE(has(refusal_of_node("{}"), "keys"));
  EXPECT_TRUE(has(refusal_of_node(R"({"keys": "cell.keys", "policy": "aes256-ctr"})"), "keys of another policy"));
  EXPECT_TRUE(has(refusal_of_node(R"({"keys": "cell.keys", "mode": "none"})"), "sign-and-encrypt"));
}

constexpr sim::Duration hour = sim::Duration::from_ps(3'600'000'000'000'000);

bool is_later(std::uint16_t life, std::uint16_t other) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(life - other)) > 0;
}

// Nobody takes what a life says that is before one that was heard: a node that has lost its memory begins behind all
// its lives, also those that followed each other quickly.
TEST_F(KeyFiles, ALostMemoryBeginsBehindTheLivesBefore) {
  const std::string path = folder_ / "lost.memory";
  std::string problem;
  std::optional<std::uint16_t> before;
  for (int i = 0; i < 5; ++i) {
    fs::remove(path);
    auto memory = SecurityMemory::open(path, hour, problem);
    ASSERT_TRUE(memory) << problem;
    if (before) {
      EXPECT_TRUE(is_later(memory->life(), *before));
    }
    before = memory->life();
  }
}

// Holes of a file that is mapped become a signal when the disk is full: there are none.
TEST_F(KeyFiles, AMemoryHasAllItsBlocksAtTheStart) {
  const std::string path = folder_ / "whole.memory";
  std::string problem;
  const auto memory = SecurityMemory::open(path, hour, problem);
  ASSERT_TRUE(memory) << problem;
  struct stat status = {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_GE(status.st_blocks * 512, status.st_size);
}

TEST_F(KeyFiles, WithoutRoomThereIsAMessage) {
  const std::string path = folder_ / "full.memory";
  rlimit before = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit little = {4096, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &little), 0);
  std::string problem;
  EXPECT_FALSE(SecurityMemory::open(path, hour, problem));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_NE(problem.find("no room"), std::string::npos) << problem;
  EXPECT_TRUE(SecurityMemory::open(path, hour, problem)) << "what was begun is no obstacle later: " << problem;
}

TEST_F(KeyFiles, MemoriesAreOfOneNodeAndLastLonger) {
  const std::string path = folder_ / "deep/er/plc.memory";
  std::string problem;
  auto memory = SecurityMemory::open(path, hour, problem);
  ASSERT_TRUE(memory) << problem;
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  const std::uint16_t life = memory->life();
  EXPECT_TRUE(memory->windows().take({7, 1, 2}, {3, 100, 1}));
  EXPECT_FALSE(SecurityMemory::open(path, hour, problem)) << "two at a time would sign with the same numbers";
  EXPECT_NE(problem.find("another node has it"), std::string::npos);
  memory.reset();
  memory = SecurityMemory::open(path, hour, problem);
  ASSERT_TRUE(memory) << problem;
  EXPECT_TRUE(is_later(memory->life(), life));
  EXPECT_FALSE(memory->windows().take({7, 1, 2}, {3, 100, 1})) << "it has come before";
  EXPECT_TRUE(memory->windows().take({7, 1, 2}, {3, 101, 1}));
  memory.reset();
  ::chmod(path.c_str(), 0644);
  EXPECT_FALSE(SecurityMemory::open(path, hour, problem));
  write("other", "text");
  EXPECT_FALSE(SecurityMemory::open(folder_ / "other", hour, problem));
  EXPECT_NE(problem.find("something else"), std::string::npos);
}

}  // namespace
}  // namespace takt::node::key_file_test
