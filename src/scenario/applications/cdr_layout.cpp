#include "scenario/applications/cdr_layout.hpp"

#include <algorithm>

namespace takt::scenario {
namespace {
constexpr std::size_t header = 4;
constexpr std::byte little_endian{1};   // CDR_LE
std::size_t aligned(std::size_t at, std::size_t size) { return (at + size - 1) / size * size; }
}  // namespace

CdrLayout::CdrLayout(const SampleLayout& layout) {
  std::size_t at = 0;  // from behind the encapsulation header
  for (const SampleLayout::Field& field : layout.fields()) {
    at = aligned(at, uadp::fixed_octets(field.type));
    copies_.push_back({field.offset, header + at, field.octets()});
    at += field.octets();
  }
  end_ = header + at;
  octets_ = header + aligned(at, 4);
}

void CdrLayout::encode(uadp::Octets sample, std::span<std::byte> payload) const {
  std::fill(payload.begin(), payload.end(), std::byte{0});
  payload[1] = little_endian;
  payload[3] = static_cast<std::byte>(octets_ - end_);
  for (const Copy& copy : copies_) std::copy_n(sample.data() + copy.in_sample, copy.octets, payload.data() + copy.in_payload);
}

bool CdrLayout::decode(uadp::Octets payload, std::span<std::byte> sample) const {
  if (payload.size() < end_ || payload[0] != std::byte{0} || payload[1] != little_endian) return false;
  for (const Copy& copy : copies_) std::copy_n(payload.data() + copy.in_payload, copy.octets, sample.data() + copy.in_sample);
  return true;
}

}  // namespace takt::scenario
