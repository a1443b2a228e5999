// SPDX-License-Identifier: Apache-2.0
#include "models/ingress/stream_filter.hpp"

#include <gtest/gtest.h>

namespace takt::models::stream_filter_test {
namespace {

constexpr StreamHandle camera{1};
constexpr StreamHandle axes{2};

StreamFilterConfig filter(std::optional<StreamHandle> handle, std::optional<Priority> priority) {
  StreamFilterConfig config;
  config.stream_handle = handle;
  config.priority = priority;
  return config;
}

TEST(StreamFilterTable, TheFirstMatchWins) {
  StreamFilterTable table;
  EXPECT_EQ(table.match(camera, 3), nullptr);
  const StreamFilterIndex exact = table.add(filter(camera, Priority{3}));
  const StreamFilterIndex any_priority = table.add(filter(camera, std::nullopt));
  const StreamFilterIndex any_handle = table.add(filter(std::nullopt, Priority{3}));
  EXPECT_EQ(table.match(camera, 3), &table[exact]);
  EXPECT_EQ(table.match(camera, 4), &table[any_priority]);
  EXPECT_EQ(table.match(axes, 3), &table[any_handle]);
  EXPECT_EQ(table.match({}, 3), &table[any_handle]);  // of no stream
  EXPECT_EQ(table.match(axes, 4), nullptr);
  const StreamFilterIndex all = table.add(filter(std::nullopt, std::nullopt));
  EXPECT_EQ(table.match(axes, 4), &table[all]);
  EXPECT_EQ(table.match(camera, 3), &table[exact]);
  EXPECT_EQ(table.size(), 4u);
}

TEST(StreamFilter, TheMaximumSduSizeIsAllowed) {
  StreamFilterConfig config;
  config.maximum_sdu_size = {100};
  StreamFilter filter(config);
  EXPECT_TRUE(filter.accept({100}));
  EXPECT_FALSE(filter.accept({101}));
  EXPECT_TRUE(filter.accept({1}));
  EXPECT_FALSE(filter.stream_blocked_due_to_oversize_frame());
  EXPECT_EQ(filter.counters(), (StreamFilterCounters{3, 0, 0, 2, 1, 0}));
}

TEST(StreamFilter, ZeroIsAnySize) {
  StreamFilter filter{StreamFilterConfig{}};
  EXPECT_TRUE(filter.accept({1'500}));
}

TEST(StreamFilter, AnOversizeFrameBlocksUntilCleared) {
  StreamFilterConfig config;
  config.maximum_sdu_size = {100};
  config.stream_blocked_due_to_oversize_frame_enable = true;
  StreamFilter filter(config);
  EXPECT_TRUE(filter.accept({100}));
  EXPECT_FALSE(filter.accept({101}));
  EXPECT_TRUE(filter.stream_blocked_due_to_oversize_frame());
  EXPECT_FALSE(filter.accept({1}));
  filter.clear_stream_blocked_due_to_oversize_frame();
  EXPECT_TRUE(filter.accept({1}));
  EXPECT_EQ(filter.counters(), (StreamFilterCounters{4, 0, 0, 2, 2, 0}));
}

TEST(StreamFilter, CountsWhatGateAndMeterSay) {
  StreamFilter filter{StreamFilterConfig{}};
  for (const bool passed : {true, true, false}) {
    EXPECT_TRUE(filter.accept({64}));
    filter.count_gate(passed);
  }
  filter.count_red();
  EXPECT_EQ(filter.counters(), (StreamFilterCounters{3, 2, 1, 3, 0, 1}));
}

}  // namespace
}  // namespace takt::models::stream_filter_test
