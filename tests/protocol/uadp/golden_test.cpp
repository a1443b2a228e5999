// SPDX-License-Identifier: Apache-2.0
// Frames of an independent stack (open62541 1.5.7; tests/golden/uadp): each decodes to what its JSON says and encodes
// back to the same octets.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "uadp/encoder.hpp"
#include "uadp/message_json.hpp"

namespace takt::uadp {
namespace {

using nlohmann::json;

struct Recorded {
  std::string name;
  std::string hex;
  json message;

  /// What stands behind the last DataSetMessage that the octets themselves announce.
  std::size_t trailing() const { return message.at("trailingBytes").get<std::size_t>(); }
};

std::vector<Recorded> recorded() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(TAKT_SOURCE_DIR "/tests/golden/uadp"))
    if (entry.path().extension() == ".json") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<Recorded> frames;
  for (const auto& path : paths) {
    std::ifstream file(path);
    const json capture = json::parse(file);
    for (const json& each : capture.at("messages"))
      if (each.at("message").at("version") == 1)
        frames.push_back({path.stem().string() + ":" + each.value("name", std::to_string(frames.size())),
                          each.at("hex").get<std::string>(), each.at("message")});
  }
  return frames;
}

/// What the standard lets us say about a message: nothing of the fields of one that is not valid.
json comparable(json message) {
  message.erase("flags");
  for (json& each : message.at("dataSetMessages")) {
    each.erase("flags");
    if (each.at("valid") == false) {
      each.erase("fields");
      each.erase("fieldCount");
    }
  }
  return message;
}

void put_fields(NetworkMessageEncoder& encoder, const DataSetMessage& message) {
  if (!message.header.valid || message.header.encoding == FieldEncoding::RawData) return encoder.body(message.body);
  FieldReader fields(message);
  while (const auto field = fields.next()) {
    if (message.header.type == DataSetMessageType::DeltaFrame)
      encoder.delta_field(field->index, field->value);
    else
      encoder.field(field->value);
  }
}

std::string encoded_again(const NetworkMessage& message, std::vector<std::byte>& buffer) {
  std::vector<std::uint16_t> ids;
  for (std::size_t i = 0; message.writer_ids && i < message.count(); ++i) ids.push_back(*message.writer_id(i));
  NetworkMessageEncoder encoder = message.writer_ids ? NetworkMessageEncoder(buffer, message.header, ids)
                                                     : NetworkMessageEncoder(buffer, message.header);
  for (std::size_t i = 0; i < message.count(); ++i) {
    DataSetMessage each;
    EXPECT_EQ(decode(message.data_set_message(i), each), DecodeStatus::ok);
    encoder.begin(each.header);
    put_fields(encoder, each);
    encoder.end();
  }
  return hex_of(encoder.finish());
}

TEST(Golden, EveryFrameMeansWhatItsJsonSays) {
  const std::vector<Recorded> frames = recorded();
  EXPECT_GT(frames.size(), 300u);
  for (const Recorded& frame : frames) {
    SCOPED_TRACE(frame.name);
    const std::vector<std::byte> octets = octets_of(frame.hex);
    NetworkMessage message;
    ASSERT_EQ(decode(octets, message), DecodeStatus::ok);
    EXPECT_EQ(to_json(message, frame.message), comparable(frame.message));
  }
}

// The recorded vectors hold one message of version 2, which its producer decodes as if it were 1.
TEST(Golden, AnotherVersionIsRefused) {
  NetworkMessage message;
  EXPECT_EQ(decode(octets_of("f201ba0801640001010001010006feffffff"), message), DecodeStatus::version);
}

TEST(Golden, EveryFrameEncodesBackToItsOctets) {
  std::vector<std::byte> buffer(2048);
  for (const Recorded& frame : recorded()) {
    SCOPED_TRACE(frame.name);
    const std::vector<std::byte> octets = octets_of(frame.hex);
    NetworkMessage message;
    ASSERT_EQ(decode(octets, message), DecodeStatus::ok);
    const std::size_t size = octets.size() - frame.trailing();
    EXPECT_EQ(encoded_again(message, buffer), frame.hex.substr(0, 2 * size));
    std::vector<std::byte> small(size - 1);
    EXPECT_EQ(encoded_again(message, small), "") << "one octet less is too small";
  }
}

// Cut anywhere, a frame is refused, has a body that is not well formed, or has lost fields; and nothing reads beyond
// its end (the buffer is a heap block of exactly that length, which the address sanitizer watches).
TEST(Golden, EveryFrameCutAnywhereIsHarmless) {
  for (const Recorded& frame : recorded()) {
    const std::vector<std::byte> octets = octets_of(frame.hex);
    for (std::size_t length = 0; length < octets.size() - frame.trailing(); ++length) {
      const std::vector<std::byte> cut(octets.begin(), octets.begin() + static_cast<std::ptrdiff_t>(length));
      NetworkMessage message;
      if (decode(cut, message) != DecodeStatus::ok) continue;
      DataSetMessage last;
      if (decode(message.data_set_message(message.count() - 1), last) != DecodeStatus::ok) continue;
      const bool has_count = last.header.valid && last.header.encoding != FieldEncoding::RawData && !last.body.empty();
      if (has_count && message.sizes.empty()) {
        EXPECT_FALSE(is_well_formed(last)) << frame.name << " cut at " << length;
      }
    }
  }
}

}  // namespace
}  // namespace takt::uadp
