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
    DataSet& data_set = data_sets_.emplace_back();
    data_set.begin = encoder.position();
    for (std::size_t f = 0; f < settings.data_sets[i].count(); ++f) data_set.field_offsets.push_back(data_set.begin + header_octets + settings.data_sets[i].offset(f));
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

}  // namespace takt::uadp
