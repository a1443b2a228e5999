// SPDX-License-Identifier: Apache-2.0
// Process data of a node: DataSets bound to a Program, and built-in sources.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "node/built_in_values.hpp"
#include "node/data_set_binding.hpp"

namespace takt::node::values_test {
namespace {

wire::ProgramShape shape() {
  wire::ProgramShape made;
  made.name = "p";
  made.participants = {"m", "a"};
  made.data_sets = {{"down",
                     0,
                     {{"q", uadp::BuiltInType::Double, 2},
                      {"n", uadp::BuiltInType::Int16, 1},
                      {"on", uadp::BuiltInType::Boolean, 1}}}};
  return made;
}
constexpr std::size_t octets = 2 * 8 + 2 + 1;

using Down = std::tuple<std::array<double, 2>, std::int16_t, bool>;

TEST(DataSetBinding, CarriesValuesBothWays) {
  pubsub::DataSet<Down> sent(Down{{1.5, -2.5}, std::int16_t{-7}, true});
  pubsub::DataSet<Down> received;
  int messages = 0;
  received.on_received([&messages](const Down&) { ++messages; });
  DataSetBinding there(shape());
  DataSetBinding here(shape());
  ASSERT_TRUE(there.bind("down", sent));
  ASSERT_TRUE(here.bind("down", received));
  std::array<std::byte, octets> fields{};
  there.produce(0, 0, fields);
  EXPECT_EQ(uadp::load_little_endian<double>(fields.data() + 8), -2.5)
      << "elements stand one behind the other, without a length";
  EXPECT_EQ(uadp::load_little_endian<std::int16_t>(fields.data() + 16), -7);
  here.consume(0, 0, fields);
  EXPECT_EQ(received.get(), sent.get());
  EXPECT_EQ(messages, 1);
}

TEST(DataSetBinding, OnlyWhatFitsIsBound) {
  DataSetBinding binding(shape());
  pubsub::DataSet<Down> fits;
  pubsub::DataSet<std::tuple<std::array<double, 3>, std::int16_t, bool>> too_long;
  pubsub::DataSet<std::tuple<std::array<double, 2>, std::uint16_t, bool>> another_type;
  pubsub::DataSet<std::tuple<std::vector<double>, std::int16_t, bool>> any_length;
  pubsub::DataSet<double> too_few;
  EXPECT_FALSE(binding.bind("up", fits));
  EXPECT_FALSE(binding.bind("down", too_long));
  EXPECT_FALSE(binding.bind("down", another_type));
  EXPECT_FALSE(binding.bind("down", any_length));
  EXPECT_FALSE(binding.bind("down", too_few));
  EXPECT_TRUE(binding.bind("down", fits));
}

Source source(SourceKind kind, const std::string& field) {
  Source made;
  made.data_set = "down";
  made.field = field;
  made.kind = kind;
  return made;
}

TEST(BuiltInValues, CountersConstantsAndSines) {
  Config config;
  config.sources = {source(SourceKind::sine, "q"), source(SourceKind::counter, "n"),
                    source(SourceKind::constant, "on")};
  config.sources[0].value = 10;
  config.sources[0].amplitude = 2;
  config.sources[1].value = 32'766;
  config.sources[2].value = 1;
  Log log(stdout);
  BuiltInValues values(config, shape(), log);
  std::array<std::byte, octets> fields{};
  const std::array<std::int16_t, 3> counted = {32'766, 32'767, 32'767};  // stays at the end of its range
  for (std::size_t i = 0; i < counted.size(); ++i) {
    fields = {};
    values.produce(0, 250'000'000 * static_cast<std::int64_t>(i), fields);
    EXPECT_EQ(uadp::load_little_endian<std::int16_t>(fields.data() + 16), counted[i]);
    EXPECT_EQ(fields[18], std::byte{1});
  }
  EXPECT_NEAR(uadp::load_little_endian<double>(fields.data() + 8), 10, 1e-12) << "sin(pi)";
  EXPECT_DOUBLE_EQ(value_of(config.sources[0], 0, 250'000'000), 12) << "a quarter of a second";
}

TEST(BuiltInValues, OutOfRangeIsTheEndOfTheRange) {
  for (const auto& [type, value, expected] :
       {std::tuple{uadp::BuiltInType::Int64, 1e30, std::numeric_limits<std::int64_t>::max()},
        std::tuple{uadp::BuiltInType::Int64, -1e30, std::numeric_limits<std::int64_t>::min()}}) {
    wire::ProgramShape wide = shape();
    wide.data_sets = {{"down", 0, {{"n", type, 1}}}};
    Config config;
    config.sources = {source(SourceKind::constant, "n")};
    config.sources[0].value = value;
    std::array<std::byte, 8> fields{};
    Log log(stdout);
    BuiltInValues(config, wide, log).produce(0, 0, fields);
    EXPECT_EQ(uadp::load_little_endian<std::int64_t>(fields.data()), expected);
  }
}

}  // namespace
}  // namespace takt::node::values_test
