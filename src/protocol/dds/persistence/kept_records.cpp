// SPDX-License-Identifier: Apache-2.0
#include "dds/persistence/kept_records.hpp"

#include <algorithm>
#include <array>

namespace takt::dds {
namespace {

// Names end in digits of fixed length, so that they ascend as their numbers do.
std::string digits(std::uint64_t value, int count) {
  std::string text(static_cast<std::size_t>(count), '0');
  for (auto at = text.rbegin(); at != text.rend(); ++at, value >>= 4) *at = "0123456789abcdef"[value & 15];
  return text;
}
std::string name_of(const Guid& guid) {
  std::string text;
  for (const std::uint8_t octet : guid.prefix.octets) text += digits(octet, 2);
  return text + digits(guid.entity.value, 8);
}
std::optional<Guid> guid_of(std::string_view text) {
  if (text.size() != 32) return std::nullopt;
  std::array<std::uint32_t, 32> nibbles{};
  for (std::size_t i = 0; i < 32; ++i) {
    const std::size_t value = std::string_view("0123456789abcdef").find(text[i]);
    if (value == std::string_view::npos) return std::nullopt;
    nibbles[i] = static_cast<std::uint32_t>(value);
  }
  Guid guid;
  for (std::size_t i = 0; i < 12; ++i)
    guid.prefix.octets[i] = static_cast<std::uint8_t>(nibbles[2 * i] << 4 | nibbles[2 * i + 1]);
  for (std::size_t i = 24; i < 32; ++i) guid.entity.value = guid.entity.value << 4 | nibbles[i];
  return guid;
}

// A change: number 8, kind 1, key 16, source timestamp 8, original writer 16 and its number 8 (zeros: its own),
// payload.
constexpr std::size_t fixed_size = 8 + 1 + 16 + 8 + 16 + 8;

}  // namespace

KeptChanges::KeptChanges(Storage& storage, const Guid& writer, Epoch epoch)
    : storage_(storage), name_("writer/" + name_of(writer) + "/"), epoch_(epoch) {}

void KeptChanges::put(const CacheChange& change) {
  std::vector<std::byte> value(fixed_size + change.payload.size());
  store(value.data(), change.number.value, ByteOrder::little);
  value[8] = static_cast<std::byte>(change.kind);
  std::transform(change.key.begin(), change.key.end(), value.begin() + 9,
                 [](std::uint8_t octet) { return std::byte{octet}; });
  const Time source = epoch_.stamp(change.source);
  store(value.data() + 25, source.seconds, ByteOrder::little);
  store(value.data() + 29, source.fraction, ByteOrder::little);
  if (change.original) {
    const Guid& original = change.original->writer;
    std::transform(original.prefix.octets.begin(), original.prefix.octets.end(), value.begin() + 33,
                   [](std::uint8_t octet) { return std::byte{octet}; });
    store(value.data() + 45, original.entity.value, ByteOrder::little);
    store(value.data() + 49, change.original->number.value, ByteOrder::little);
  }
  std::copy(change.payload.begin(), change.payload.end(), value.begin() + fixed_size);
  storage_.put(name_ + digits(static_cast<std::uint64_t>(change.number.value), 16), value);
}

void KeptChanges::erase(SequenceNumber number, bool is_last) {
  if (is_last) {
    std::array<std::byte, 8> value{};
    store(value.data(), number.value, ByteOrder::little);
    storage_.put(name_ + "last", value);
  }
  storage_.erase(name_ + digits(static_cast<std::uint64_t>(number.value), 16));
}

std::vector<CacheChange> KeptChanges::changes() const {
  std::vector<CacheChange> all;
  storage_.for_each(name_, [&](std::string_view name, Octets value) {
    if (name.ends_with("last") || value.size() < fixed_size) return;
    CacheChange change;
    change.number = {load<std::int64_t>(value.data(), ByteOrder::little)};
    change.kind = static_cast<ChangeKind>(std::to_integer<unsigned>(value[8]) & 3u);
    std::transform(value.begin() + 9, value.begin() + 25, change.key.begin(),
                   [](std::byte octet) { return std::to_integer<std::uint8_t>(octet); });
    change.source = epoch_.local({load<std::int32_t>(value.data() + 25, ByteOrder::little),
                                  load<std::uint32_t>(value.data() + 29, ByteOrder::little)});
    OriginalWriter original;
    std::transform(value.begin() + 33, value.begin() + 45, original.writer.prefix.octets.begin(),
                   [](std::byte octet) { return std::to_integer<std::uint8_t>(octet); });
    original.writer.entity.value = load<std::uint32_t>(value.data() + 45, ByteOrder::little);
    original.number.value = load<std::int64_t>(value.data() + 49, ByteOrder::little);
    if (!original.writer.is_unknown()) change.original = original;
    change.payload.assign(value.begin() + fixed_size, value.end());
    if (all.empty() || all.back().number < change.number) all.push_back(std::move(change));
  });
  return all;
}

SequenceNumber KeptChanges::last() const {
  SequenceNumber last{0};
  storage_.for_each(name_, [&](std::string_view, Octets value) {
    if (value.size() >= 8) last = std::max(last, SequenceNumber{load<std::int64_t>(value.data(), ByteOrder::little)});
  });
  return last;
}

KeptNumbers::KeptNumbers(Storage& storage, const Guid& reader)
    : storage_(storage), name_("reader/" + name_of(reader) + "/") {}

void KeptNumbers::put(const Guid& writer, const NumberRanges& delivered) {
  std::vector<std::byte> value(16 * delivered.ranges().size());
  std::byte* at = value.data();
  for (const auto& [first, last] : delivered.ranges()) {
    store(at, first.value, ByteOrder::little);
    store(at + 8, last.value, ByteOrder::little);
    at += 16;
  }
  storage_.put(name_ + name_of(writer), value);
}

std::map<Guid, NumberRanges> KeptNumbers::all() const {
  std::map<Guid, NumberRanges> all;
  storage_.for_each(name_, [&](std::string_view name, Octets value) {
    const std::optional<Guid> writer = guid_of(name.substr(name_.size()));
    if (!writer) return;
    for (std::size_t at = 0; at + 16 <= value.size(); at += 16) {
      const SequenceNumber first{load<std::int64_t>(value.data() + at, ByteOrder::little)};
      const SequenceNumber last{load<std::int64_t>(value.data() + at + 8, ByteOrder::little)};
      if (first_sequence_number <= first && first <= last && last <= greatest_sequence_number)
        all[*writer].insert(first, last);
    }
  });
  return all;
}

}  // namespace takt::dds
