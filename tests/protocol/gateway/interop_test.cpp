// SPDX-License-Identifier: Apache-2.0
// The gateway between our UADP over real sockets and stock Cyclone DDS programs in processes of their own: every mapped
// type, every value.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "gateway/channel.hpp"
#include "gateway/content_filter.hpp"
#include "gateway/field_values.hpp"
#include "node/dds/participant.hpp"
#include "node/socket.hpp"
#include "pubsub/communication.hpp"
#include "sample_values.hpp"
#include "support/reservation.hpp"

namespace takt::gateway {
namespace {

using namespace sim::literals;  // NOLINT
using testing::Sample;
using testing::sample_of;

constexpr std::uint32_t samples = 60;

/// The samples of a reader, each when it has come.
class OneByOne {
 public:
  explicit OneByOne(node::DdsReader& reader) : reader_(reader) {}
  const std::vector<std::byte>& next() {
    while (at_ == taken_.size()) {
      taken_ = reader_.take();
      at_ = 0;
      if (taken_.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return taken_[at_++];
  }

 private:
  node::DdsReader& reader_;
  std::span<const std::vector<std::byte>> taken_;
  std::size_t at_ = 0;
};

/// A stock program, whose lines are read here.
class Stock {
 public:
  explicit Stock(std::vector<std::string> command) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("a pipe");
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(ends[1], 1);
      ::close(ends[0]);
      std::vector<char*> arguments;
      for (std::string& each : command) arguments.push_back(each.data());
      arguments.push_back(nullptr);
      ::execv(arguments[0], arguments.data());
      ::_exit(127);
    }
    ::close(ends[1]);
    lines_ = ::fdopen(ends[0], "r");
  }
  ~Stock() {
    if (pid_ > 0) ::kill(pid_, SIGKILL);
    wait();
    std::fclose(lines_);
  }
  Stock(const Stock&) = delete;
  Stock& operator=(const Stock&) = delete;

  /// Waits for the next line; "" at the end.
  std::string line() {
    char text[8192];
    if (std::fgets(text, sizeof text, lines_) == nullptr) return {};
    std::string result(text);
    result.pop_back();
    return result;
  }
  /// The exit status.
  int wait() {
    int status = 0;
    if (pid_ > 0) ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  }

 private:
  pid_t pid_ = -1;
  std::FILE* lines_ = nullptr;
};

std::string place() { return STOCK_FOLDER; }
std::uint16_t domain() {
  static const takt::testing::Reservation reserved = takt::testing::Reservation::domain();
  return reserved.number();
}
std::uint16_t port(int number) {
  static const takt::testing::Reservation reserved = takt::testing::Reservation::ports();
  return static_cast<std::uint16_t>(reserved.number() + number);
}

std::unique_ptr<node::Socket> socket_from_to(std::uint16_t own, std::uint16_t other) {
  node::UdpTransport transport;
  transport.port = own;
  transport.destinations = {"127.0.0.1:" + std::to_string(other)};
  std::string problem;
  auto socket = node::open_socket(transport, problem);
  EXPECT_NE(socket, nullptr) << problem;
  return socket;
}

sim::LocalTime now() {
  static const auto start = std::chrono::steady_clock::now();
  const auto passed = std::chrono::steady_clock::now() - start;
  return sim::LocalTime::from_ps(std::chrono::duration_cast<std::chrono::nanoseconds>(passed).count() * 1000);
}

TypeMapping mapping(Direction direction) {
  std::vector<std::string> problems;
  auto made = TypeMapping::make(direction, testing::sample_fields(), testing::sample_type(), {}, problems);
  for (const std::string& problem : problems) ADD_FAILURE() << problem;
  return made.value();
}

/// Nothing is lost, whoever finds whom first and however slow the other is: two endpoints do not match at the same
/// instant, and to a volatile reader all is history that was written before it heard of the writer.
plant::Qos reliable() {
  plant::Qos qos;
  qos.reliability = plant::Reliability::reliable;
  qos.durability = plant::Durability::transient_local;
  qos.history = plant::History::keep_all;
  qos.max_blocking_time = 1000_s;
  return qos;
}

/// What stock_subscriber.c prints of a sample.
nlohmann::json printed(const Sample& sample) {
  const auto& [on, tiny, raw, small, usmall, number, unumber, big, ubig, ratio, speed, name, label, id, axes, flags,
               blob, path, words, stamp, status] = sample;
  nlohmann::json guid = {uadp::load_little_endian<std::uint32_t>(id.octets.data()),
                         uadp::load_little_endian<std::uint16_t>(id.octets.data() + 4),
                         uadp::load_little_endian<std::uint16_t>(id.octets.data() + 6)};
  for (std::size_t i = 8; i < 16; ++i) guid.push_back(std::to_integer<int>(id.octets[i]));
  nlohmann::json octets = nlohmann::json::array();
  for (const std::byte each : blob) octets.push_back(std::to_integer<int>(each));
  return {{"on", on ? 1 : 0},
          {"tiny", tiny},
          {"raw", raw},
          {"small", small},
          {"usmall", usmall},
          {"number", number},
          {"unumber", unumber},
          {"big", big},
          {"ubig", ubig},
          {"ratio", static_cast<double>(ratio)},
          {"speed", speed},
          {"name", name},
          {"label", std::string(label.view())},
          {"id", guid},
          {"axes", axes},
          {"flags", {flags[0] ? 1 : 0, flags[1] ? 1 : 0, flags[2] ? 1 : 0}},
          {"blob", octets},
          {"path", path},
          {"words", words},
          {"stamp", stamp.ticks},
          {"status", status.code}};
}

TEST(Interoperability, AStockSubscriberReceivesWhatTheGatewayPublishes) {
  Stock stock({place() + "/stock_subscriber", "Sample", std::to_string(domain()), std::to_string(samples)});
  ASSERT_EQ(stock.line(), "ready");
  std::string problem;
  const auto participant = node::open_dds(domain(), "", problem);
  ASSERT_NE(participant, nullptr) << problem;
  node::DdsWriter* const writer = participant->add_writer({"Sample", "Plant::Sample", reliable()}, problem);
  ASSERT_NE(writer, nullptr) << problem;
  ASSERT_EQ(stock.line(), "matched");
  while (writer->matched() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));

  const auto out = socket_from_to(port(0), port(1));
  const auto in = socket_from_to(port(1), port(0));
  pubsub::DataSet<Sample> given;
  pubsub::Publisher publisher(uadp::PublisherId::uint16(5), {.publishing_interval = 1_s, .publish_on_change = true});
  publisher.add_data_set("sample", given);
  pubsub::Communication sending(*out, *out);
  sending.add_publisher(publisher);
  sending.enable(now());

  Channel channel(mapping(Direction::to_dds), {.capacity = 8});
  FieldValues entered(testing::sample_fields());
  entered.on_received([&] { EXPECT_EQ(channel.receive(entered.octets(), now()), MappingError::none); });
  pubsub::Subscriber subscriber(uadp::PublisherId::uint16(5));
  subscriber.add_data_set("sample", entered);
  pubsub::Communication receiving(*in, *in);
  receiving.add_subscriber(subscriber);
  receiving.enable(now());

  for (std::uint32_t n = 1; n <= samples; ++n) {
    given.set(sample_of(n));
    sending.advance(now());
    while (channel.waiting() == 0) receiving.poll(now());
    const auto value = channel.pull(now());
    ASSERT_TRUE(value);
    ASSERT_EQ(writer->write(value->octets), node::SendOutcome::sent);
  }
  for (std::uint32_t n = 1; n <= samples; ++n) {
    const std::string line = stock.line();
    ASSERT_FALSE(line.empty()) << "the stock program has ended at " << n;
    EXPECT_EQ(nlohmann::json::parse(line), printed(sample_of(n))) << n;
  }
  EXPECT_EQ(stock.wait(), 0);
}

// A reader of this node keeps of 60 samples those that its filter lets pass; its history of one sample an instance
// would otherwise hold the last only.
TEST(Interoperability, AFilterLooksAtWhatAStockPublisherWrites) {
  const IdlStruct motion{"Plant::Motion",
                         {{"counter", IdlKind::uint32},
                          {"speed", IdlKind::float64},
                          {"axes", IdlKind::int16, IdlCollection::array, 3},
                          {"on", IdlKind::boolean}}};
  FilterMistake mistake;
  const auto filter = ContentFilter::parse("axes[1] BETWEEN -12 AND -10 OR speed > 14.5 AND on = TRUE OR counter = 60",
                                           motion, mistake);
  ASSERT_TRUE(filter) << mistake.expected;
  std::string problem;
  const auto participant = node::open_dds(domain(), "", problem);
  ASSERT_NE(participant, nullptr) << problem;
  node::DdsReader* const reader = participant->add_reader(
      {"Motion", motion.name, reliable(), {}, [&](uadp::Octets payload) { return filter->passes(payload); }}, problem);
  ASSERT_NE(reader, nullptr) << problem;
  plant::Qos latest = reliable();
  latest.history = plant::History::keep_last;
  node::DdsReader* const last = participant->add_reader(
      {"Motion",
       motion.name,
       latest,
       {},
       [&](uadp::Octets payload) { return filter->passes(payload) && payload[4] < std::byte{13}; }},
      problem);
  ASSERT_NE(last, nullptr) << problem;
  Stock stock({place() + "/stock_publisher", "Motion", std::to_string(domain()), std::to_string(samples), "2"});
  OneByOne taken(*reader);
  for (const int counter : {10, 11, 12, 59, 60}) EXPECT_EQ(std::to_integer<int>(taken.next().at(4)), counter);
  EXPECT_EQ(stock.wait(), 0);
  const auto kept = last->take();
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].at(4), std::byte{12});
}

TEST(Interoperability, WhatAStockPublisherWritesComesOutOfTheGatewayAsUadp) {
  std::string problem;
  const auto participant = node::open_dds(domain(), "", problem);
  ASSERT_NE(participant, nullptr) << problem;
  node::DdsReader* const reader = participant->add_reader({"Sample", "Plant::Sample", reliable()}, problem);
  ASSERT_NE(reader, nullptr) << problem;
  Stock stock({place() + "/stock_publisher", "Sample", std::to_string(domain()), std::to_string(samples), "1"});
  ASSERT_EQ(stock.line(), "matched");

  const auto out = socket_from_to(port(0), port(1));
  const auto in = socket_from_to(port(1), port(0));
  Channel channel(mapping(Direction::to_opc_ua), {.capacity = 8});
  FieldValues left(testing::sample_fields());
  pubsub::Publisher publisher(uadp::PublisherId::uint16(6), {.publishing_interval = 1_s, .publish_on_change = true});
  publisher.add_data_set("sample", left);
  pubsub::Communication sending(*out, *out);
  sending.add_publisher(publisher);
  sending.enable(now());

  pubsub::DataSet<Sample> taken;
  std::vector<Sample> seen;
  taken.on_received([&](const Sample& sample) { seen.push_back(sample); });
  pubsub::Subscriber subscriber(uadp::PublisherId::uint16(6));
  subscriber.add_data_set("sample", taken);
  pubsub::Communication receiving(*in, *in);
  receiving.add_subscriber(subscriber);
  receiving.enable(now());

  OneByOne samples_taken(*reader);
  for (std::uint32_t n = 1; n <= samples; ++n) {
    ASSERT_EQ(channel.receive(samples_taken.next(), now()), MappingError::none);
    const auto value = channel.pull(now());
    ASSERT_TRUE(value);
    ASSERT_TRUE(left.assign(value->octets));
    sending.advance(now());
    while (seen.size() < n) receiving.poll(now());
    EXPECT_EQ(seen.back(), sample_of(n)) << n;
  }
  EXPECT_EQ(seen.size(), samples);
  EXPECT_EQ(receiving.verdicts().dropped(), 0u);
  EXPECT_EQ(stock.wait(), 0);
}

const std::vector<DataSetField> blob_fields = {{"number", {uadp::BuiltInType::UInt32}},
                                               {"data", {uadp::BuiltInType::ByteString}}};
constexpr std::uint32_t blobs = 60;  // up to 60 kB: 45 fragments of 1344 octets

TypeMapping blob_mapping(Direction direction) {
  IdlStruct type{"Plant::Blob", {}};
  std::string problem;
  for (const DataSetField& field : blob_fields) type.members.push_back(idl_member_of(field, problem).value());
  std::vector<std::string> problems;
  return TypeMapping::make(direction, blob_fields, type, {}, problems).value();
}

using Blob = std::tuple<std::uint32_t, pubsub::ByteString>;

Blob blob_of(std::uint32_t n) {
  Blob blob{n, {}};
  for (std::uint32_t i = 0; i < 1003 * n; ++i) std::get<1>(blob).push_back(static_cast<std::byte>(7 * i + n));
  return blob;
}

/// The fields of a blob as Variants.
std::vector<std::byte> fields_of(const Blob& blob) {
  const pubsub::DataSet<Blob> typed(blob);
  std::vector<std::byte> octets(100'000);
  uadp::Writer writer(octets);
  for (std::size_t i = 0; i < 2; ++i) typed.put(writer, i);
  octets.resize(writer.position());
  return octets;
}

TEST(Interoperability, SamplesOfManyFragmentsReachAStockSubscriber) {
  Stock stock({place() + "/stock_subscriber", "Blob", std::to_string(domain()), std::to_string(blobs)});
  ASSERT_EQ(stock.line(), "ready");
  std::string problem;
  const auto participant = node::open_dds(domain(), "", problem);
  ASSERT_NE(participant, nullptr) << problem;
  node::DdsWriter* const writer = participant->add_writer({"Blob", "Plant::Blob", reliable()}, problem);
  ASSERT_NE(writer, nullptr) << problem;
  ASSERT_EQ(stock.line(), "matched");
  while (writer->matched() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  TypeMapping mapping = blob_mapping(Direction::to_dds);
  std::vector<std::byte> payload;
  for (std::uint32_t n = 1; n <= blobs; ++n) {
    ASSERT_EQ(mapping.to_cdr(fields_of(blob_of(n)), payload), MappingError::none);
    ASSERT_EQ(writer->write(payload), node::SendOutcome::sent);
    std::uint32_t sum = 0;
    const Blob blob = blob_of(n);
    for (const std::byte each : std::get<1>(blob)) sum = 31 * sum + std::to_integer<std::uint32_t>(each);
    EXPECT_EQ(nlohmann::json::parse(stock.line()), (nlohmann::json{{"number", n}, {"octets", 1003 * n}, {"sum", sum}}));
  }
  EXPECT_EQ(stock.wait(), 0);
}

TEST(Interoperability, SamplesOfManyFragmentsComeFromAStockPublisher) {
  std::string problem;
  const auto participant = node::open_dds(domain(), "", problem);
  ASSERT_NE(participant, nullptr) << problem;
  node::DdsReader* const reader = participant->add_reader({"Blob", "Plant::Blob", reliable()}, problem);
  ASSERT_NE(reader, nullptr) << problem;
  Stock stock({place() + "/stock_publisher", "Blob", std::to_string(domain()), std::to_string(blobs), "1"});
  ASSERT_EQ(stock.line(), "matched");
  TypeMapping mapping = blob_mapping(Direction::to_opc_ua);
  OneByOne samples_taken(*reader);
  std::vector<std::byte> fields;
  for (std::uint32_t n = 1; n <= blobs; ++n) {
    ASSERT_EQ(mapping.to_fields(samples_taken.next(), fields), MappingError::none);
    ASSERT_EQ(fields, fields_of(blob_of(n))) << n;
  }
  EXPECT_EQ(stock.wait(), 0);
}

}  // namespace
}  // namespace takt::gateway
