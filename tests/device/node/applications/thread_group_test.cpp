// SPDX-License-Identifier: Apache-2.0
#include "node/applications/thread_group.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "sim/check.hpp"

namespace takt::node {
namespace {

void wait_for(const std::atomic<bool>& flag) {
  while (!flag) std::this_thread::yield();
}

TEST(ThreadGroup, WaitsForAll) {
  std::atomic<bool> is_over{false};
  std::atomic<int> done{0};
  ThreadGroup threads(is_over);
  for (int i = 0; i < 4; ++i) threads.start([&] { ++done; });
  threads.join();
  EXPECT_EQ(done, 4);
  EXPECT_FALSE(is_over);
}

// The one that throws does not end the process; the others are told, and join() says what it threw.
TEST(ThreadGroup, WhatAThreadThrowsEndsAllAndIsThrownAgain) {
  std::atomic<bool> is_over{false};
  std::atomic<int> told{0};
  ThreadGroup threads(is_over);
  for (int i = 0; i < 2; ++i)
    threads.start([&] {
      wait_for(is_over);
      ++told;
    });
  threads.start([] { sim::check_failed("condition", "meaning", "file", 1); });
  try {
    threads.join();
    ADD_FAILURE() << "join() says nothing";
  } catch (const sim::InvariantBroken& broken) {
    EXPECT_STREQ(broken.what(), "file:1: CHECK(condition) failed: meaning");
  }
  EXPECT_EQ(told, 2);
  EXPECT_NO_THROW(threads.join());
}

TEST(ThreadGroup, OfSeveralFailuresOneIsTold) {
  std::atomic<bool> is_over{false};
  ThreadGroup threads(is_over);
  for (int i = 0; i < 4; ++i) threads.start([] { throw std::runtime_error("out of order"); });
  EXPECT_THROW(threads.join(), std::runtime_error);
}

// Whoever starts them may fail himself before he has joined them.
TEST(ThreadGroup, ItsEndEndsTheThreads) {
  std::atomic<bool> is_over{false};
  std::atomic<bool> ended{false};
  {
    ThreadGroup threads(is_over);
    threads.start([&] {
      wait_for(is_over);
      ended = true;
    });
  }
  EXPECT_TRUE(ended);
}

}  // namespace
}  // namespace takt::node
