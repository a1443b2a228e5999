// A sample as a serialized payload of RTPS: a final struct of the topic's fields in plain CDR, little-endian (DDSI-RTPS 10.2, DDS-XTypes 7.4).
#pragma once

#include <optional>
#include <vector>

#include "scenario/applications/sample_layout.hpp"
#include "uadp/octets.hpp"

namespace takt::scenario {

/// Where each field stands, made once; a field with a count is an array.
class CdrLayout {
 public:
  explicit CdrLayout(const SampleLayout& layout);

  /// Octets of a payload, with its encapsulation header and what fills it up.
  std::size_t octets() const { return octets_; }
  /// `payload` has octets().
  void encode(uadp::Octets sample, std::span<std::byte> payload) const;
  /// False, and the sample as it was, if the payload is not one of this layout.
  bool decode(uadp::Octets payload, std::span<std::byte> sample) const;

 private:
  struct Copy {
    std::size_t in_sample = 0;
    std::size_t in_payload = 0;
    std::size_t octets = 0;
  };
  std::vector<Copy> copies_;
  std::size_t end_ = 0;       // of the last field
  std::size_t octets_ = 0;
};

}  // namespace takt::scenario
