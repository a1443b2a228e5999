// SPDX-License-Identifier: Apache-2.0
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
  header.group =
      GroupHeader{settings.writer_group_id, settings.group_version, settings.network_message_number, std::uint16_t{0}};
  prototype_.resize(most_octets);
  NetworkMessageEncoder encoder(prototype_, header);
  sequence_at_ = encoder.position() - 2;
  const std::vector<std::byte> zeros(most_octets);
  for (std::size_t i = 0; i < settings.data_sets.size(); ++i) {
    DataSet& data_set = data_sets_.emplace_back();
    data_set.begin = encoder.position();
    const RawLayout& fields = settings.data_sets[i];
    for (std::size_t f = 0; f < fields.count(); ++f)
      data_set.field_offsets.push_back(data_set.begin + header_octets + fields.offset(f));
    data_set.runs.resize(fields.count());
    for (std::size_t f = fields.count(); f-- > 0;) {
      const RawField& field = fields.field(f);
      const bool goes_on =
          f + 1 < fields.count() && fields.field(f + 1).type == field.type && !fields.field(f + 1).is_array;
      data_set.runs[f] = {field.type, field.is_array ? 0 : goes_on ? data_set.runs[f + 1].count + 1 : 1};
    }
    encoder.begin(header_with(0, 0));
    encoder.body(Octets(zeros).first(std::min(fields.size(), most_octets)));
    const std::size_t configured = i < settings.configured_sizes.size() ? settings.configured_sizes[i] : 0;
    TAKT_CHECK(configured == 0 || configured >= header_octets + fields.size(), "the fields fit ConfiguredSize");
    encoder.end(configured);
  }
  const std::size_t size = encoder.finish().size();
  TAKT_CHECK(size != 0, "a NetworkMessage has at most 65535 octets");
  prototype_.resize(size);
  prototype_.shrink_to_fit();
}

}  // namespace takt::uadp
