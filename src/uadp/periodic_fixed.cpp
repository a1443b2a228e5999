#include "uadp/periodic_fixed.hpp"

#include "uadp/encoder.hpp"

namespace takt::uadp {
namespace {

constexpr std::size_t most_octets = 0xFFFF;

DataSetMessageHeader header_with(std::uint16_t sequence_number, std::uint16_t status) {
  DataSetMessageHeader header;
  header.encoding = FieldEncoding::RawData;
  header.sequence_number = sequence_number;
  header.status = status;
  return header;
}

}  // namespace

PeriodicFixedLayout::PeriodicFixedLayout(const Settings& settings) {
  TAKT_CHECK(settings.publisher_id.type != PublisherIdType::String, "a fixed layout needs a numeric PublisherId");
  NetworkMessageHeader header;
  header.publisher_id = settings.publisher_id;
  header.group = GroupHeader{settings.writer_group_id, settings.group_version, settings.network_message_number,
                             std::uint16_t{0}};
  prototype_.resize(most_octets);
  NetworkMessageEncoder encoder(prototype_, header);
  sequence_at_ = encoder.position() - 2;
  const std::vector<std::byte> zeros(most_octets);
  for (std::size_t i = 0; i < settings.data_sets.size(); ++i) {
    data_sets_.push_back({encoder.position(), settings.data_sets[i]});
    encoder.begin(header_with(0, 0));
    encoder.body(Octets(zeros).first(std::min(settings.data_sets[i].size(), most_octets)));
    const std::size_t configured = i < settings.configured_sizes.size() ? settings.configured_sizes[i] : 0;
    TAKT_CHECK(configured == 0 || configured >= header_octets + settings.data_sets[i].size(), "the fields fit ConfiguredSize");
    encoder.end(configured);
  }
  const std::size_t size = encoder.finish().size();
  TAKT_CHECK(size != 0, "a NetworkMessage has at most 65535 octets");
  prototype_.resize(size);
  prototype_.shrink_to_fit();
}

void PeriodicFixedLayout::start(std::span<std::byte> target, std::uint16_t sequence_number) const {
  TAKT_CHECK(target.size() >= prototype_.size(), "the target has room for the layout");
  std::memcpy(target.data(), prototype_.data(), prototype_.size());
  store_little_endian(target.data() + sequence_at_, sequence_number);
}

void PeriodicFixedLayout::set_header(std::span<std::byte> target, std::size_t data_set, std::uint16_t sequence_number,
                                     std::uint16_t status) const {
  std::byte* const begin = target.data() + data_sets_[data_set].begin;
  store_little_endian(begin + 1, sequence_number);
  store_little_endian(begin + 3, status);
}

bool PeriodicFixedLayout::matches(Octets octets) const {
  if (octets.size() < prototype_.size()) return false;
  if (std::memcmp(octets.data(), prototype_.data(), sequence_at_) != 0) return false;
  for (const DataSet& each : data_sets_)
    if (octets[each.begin] != prototype_[each.begin]) return false;
  return true;
}

}  // namespace takt::uadp
