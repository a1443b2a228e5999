// SPDX-License-Identifier: Apache-2.0
// What two participants of ours say to each other, compared with what two of Cyclone DDS said (tests/golden/dds): for
// each exchange the same submessages in the same order, DATA of the same size where the content is the same. What
// differs by design is named.
#include <gtest/gtest.h>

#include "dds/dissector.hpp"
#include "dds/interop/sample.hpp"
#include "dds/message/decoder.hpp"
#include "dds/message/encoder.hpp"
#include "dds/message/parameter_list.hpp"
#include "dds/participant/world.hpp"

namespace takt::dds {
namespace {

using namespace test;
using namespace sim::literals;

/// What is said about the endpoints of one writer. The last two differ by design: Cyclone exchanges types, here they
/// match by name; Cyclone sends a participant message at the start, here they are sent where a lease of liveliness is
/// finite.
enum class Exchange : std::uint8_t {
  participants,
  publications,
  subscriptions,
  samples,
  type_lookup,
  participant_messages
};
constexpr std::array compared{Exchange::participants, Exchange::publications, Exchange::subscriptions,
                              Exchange::samples};

struct Line {
  Exchange exchange = Exchange::samples;
  char writer = 'A';  ///< whose it is; two exchanges at the same time cross as they like
  std::string text;
};

Exchange exchange_of(EntityId writer) {
  if (writer == entity_id::spdp_writer) return Exchange::participants;
  if (writer == entity_id::sedp_publications_writer) return Exchange::publications;
  if (writer == entity_id::sedp_subscriptions_writer) return Exchange::subscriptions;
  if (writer == entity_id::participant_message_writer) return Exchange::participant_messages;
  return writer.is_built_in() ? Exchange::type_lookup : Exchange::samples;
}

/// What only one side tells: Cyclone its host and process, types and their representations, and parameters of its own.
bool is_of_one_vendor(const Parameter& parameter) {
  return (parameter.id & vendor_specific) != 0 || parameter.is(ParameterId::property_list) ||
         parameter.is(ParameterId::type_information) || parameter.is(ParameterId::data_representation);
}

/// The key hash (9.6.3.8) is sent with each sample of a topic with key here; it may be left out, and Cyclone does so.
/// 20 octets, and 4 to end the list.
std::size_t key_hash_size(const Data& data) { return data.inline_qos.key_hash ? 24 : 0; }

/// Octets of a DATA, without those of what only one side tells.
std::size_t common_size(const Data& data, std::size_t size) {
  size -= key_hash_size(data);
  const Encapsulated opened = open_encapsulation(data.payload);
  if (opened.representation != Representation::pl_cdr) return size;
  Reader reader(opened.content, opened.order);
  ParameterReader list(reader);
  while (const auto parameter = list.next())
    if (is_of_one_vendor(*parameter)) size -= 4 + parameter->value.size();
  return size;
}

/// "A all: INFO_TS DATA 180": who says it, whether to all or to one, what it stands with, and how long it is.
void add_lines(std::vector<Line>& lines, char from, bool to_all, Octets octets) {
  MessageDecoder decoder(octets);
  while (decoder.next()) {
    Line line;
    bool is_info = true;
    std::visit(
        [&](const auto& each) {
          if constexpr (requires { each.writer; }) {
            line.exchange = exchange_of(each.writer);
            is_info = false;
          }
        },
        decoder.submessage());
    if (is_info) continue;  // told with those that follow
    const bool is_answer = std::holds_alternative<AckNack>(decoder.submessage());
    line.writer = is_answer == (from == 'A') ? 'B' : 'A';
    line.text = std::string(1, from) + (to_all ? " all:" : ":");
    if (!decoder.interpretation().destination.is_unknown()) line.text += " INFO_DST";
    const auto* const data = std::get_if<Data>(&decoder.submessage());
    if (data != nullptr && decoder.interpretation().timestamp) line.text += " INFO_TS";
    line.text += " " + std::string(name_of(decoder.kind()));
    if (data != nullptr)
      line.text +=
          (data->payload_kind == PayloadKind::key ? " key " : " ") + std::to_string(common_size(*data, decoder.size()));
    if (const auto* const heartbeat = std::get_if<Heartbeat>(&decoder.submessage()))
      line.text += " " + std::to_string(heartbeat->first.value) + ".." + std::to_string(heartbeat->last.value);
    if (const auto* const ack = std::get_if<AckNack>(&decoder.submessage()))
      line.text += " below " + std::to_string(ack->missing.base().value) + (ack->missing.is_empty() ? "" : " asks");
    lines.push_back(std::move(line));
  }
}

std::vector<Line> recorded() {
  std::vector<Line> lines;
  for (const Datagram& datagram :
       read_pcap(std::string(TAKT_SOURCE_DIR) + "/tests/golden/dds/cyclone-two-participants.pcap"))
    add_lines(lines, datagram.from_ip == 0x0A000001 ? 'A' : 'B', datagram.to_ip == discovery_group, datagram.payload);
  return lines;
}

/// The same in memory: A writes; B comes half a second later, reads three samples and leaves; then A leaves.
std::vector<Line> ours() {
  World world;
  const auto config = [](std::uint8_t number) {
    ParticipantConfig made = World::config(number);
    made.timing = timing::cyclone;
    // Which HEARTBEATs that travel with samples ask for an answer depends on how long the last one took; in the capture
    // the first of three does.
    made.timing.piggyback_answer_interval = 1_s;
    made.multicast_group = discovery_group;
    made.discovery.emplace();
    made.discovery->profile = discovery_profile::cyclone;
    return made;
  };
  WriterConfig writer;
  writer.topic = "Sample";
  writer.type = interop_type;
  writer.has_key = true;
  writer.qos.reliability.max_blocking_time = 1_s;
  writer.qos.history.kind = HistoryKind::keep_all;
  ReaderConfig reader;
  reader.topic = "Sample";
  reader.type = interop_type;
  reader.has_key = true;
  reader.qos.reliability = {ReliabilityKind::reliable, 1_s};
  reader.qos.history.kind = HistoryKind::keep_all;
  Participant& a = world.add(config(1));
  const auto publishes = a.create_writer(writer, world.now);
  world.run_until(start + 500_ms);
  Participant& b = world.add(config(2));
  const auto subscribes = b.create_reader(reader, world.now);
  world.run_until(start + 700_ms);
  for (int i = 1; i <= 3; ++i) {
    EXPECT_EQ(a.write(*publishes.handle, test::key_of(1), test::encode({1, i, "from Cyclone"}), world.now).verdict,
              WriteVerdict::written);
    world.run_for(i == 3 ? 5_ms : 50_ms);
  }
  b.remove(*subscribes.handle, world.now);
  b.stop(world.now);
  world.collect();
  world.kill(1);
  world.run_for(50_ms);
  a.stop(world.now);
  world.run_for(50_ms);
  std::vector<Line> lines;
  for (const Sent& sent : world.log)
    add_lines(lines, sent.from == 0 ? 'A' : 'B', sent.destinations.front().is_multicast(), sent.octets);
  return lines;
}

std::vector<std::string> said(const std::vector<Line>& lines, Exchange exchange, char writer) {
  std::vector<std::string> list;
  for (const Line& line : lines)
    if (line.exchange == exchange && line.writer == writer) list.push_back(line.text);
  return list;
}

TEST(Conversation, IsThatOfAStockImplementation) {
  const std::vector<Line> theirs = recorded();
  std::vector<Line> own = ours();
  // Here a withdrawal, too, travels with a HEARTBEAT that asks for an answer; Cyclone's program has left by then.
  for (const char* const text : {"B: HEARTBEAT 2..2", "A: INFO_DST ACKNACK below 3"}) {
    const auto extra = std::find_if(own.begin(), own.end(), [&](const Line& line) {
      return line.exchange == Exchange::subscriptions && line.text == text;
    });
    ASSERT_NE(extra, own.end());
    own.erase(extra);
  }
  for (const Exchange exchange : compared)
    for (const char writer : {'A', 'B'})
      EXPECT_EQ(said(own, exchange, writer), said(theirs, exchange, writer))
          << static_cast<int>(exchange) << " " << writer;
  // So that the comparison above is not one of nothing with nothing.
  EXPECT_EQ(said(own, Exchange::publications, 'A'),
            (std::vector<std::string>{"A: INFO_DST HEARTBEAT 1..1", "B: INFO_DST ACKNACK below 1 asks",
                                      "A: INFO_DST INFO_TS DATA 140", "A: INFO_DST HEARTBEAT 1..1",
                                      "B: INFO_DST ACKNACK below 2"}));
  EXPECT_EQ(said(own, Exchange::participants, 'A'),
            (std::vector<std::string>{"A all: INFO_TS DATA 208", "A all: INFO_TS DATA 208",
                                      "A: INFO_DST INFO_TS DATA 208", "A all: INFO_TS DATA key 64"}));
}

TEST(Conversation, DiffersByDesign) {
  const std::vector<Line> theirs = recorded();
  const std::vector<Line> own = ours();
  for (const Exchange exchange : {Exchange::type_lookup, Exchange::participant_messages}) {
    EXPECT_EQ(said(own, exchange, 'A').size() + said(own, exchange, 'B').size(),
              exchange == Exchange::type_lookup ? 0u : 4u);
    EXPECT_GT(said(theirs, exchange, 'A').size(), 0u);
  }
}

}  // namespace
}  // namespace takt::dds
