// SPDX-License-Identifier: Apache-2.0
// Reassembly: a sample that comes in fragments (DDSI-RTPS 2.5, 8.4.14.1).
#pragma once

#include <optional>
#include <vector>

#include "dds/message/fragments.hpp"
#include "sim/time.hpp"

namespace takt::dds {

class Reassembly {
 public:
  /// Room for the sample that the fragment belongs to.
  explicit Reassembly(const DataFrag& fragment)
      : fragment_size_(fragment.fragment_size),
        payload_(fragment.sample_size),
        is_there_(fragment_count(fragment.sample_size, fragment.fragment_size)) {}

  /// False if the fragments do not fit the sample that others belong to; then nothing is taken.
  bool add(const DataFrag& fragment, sim::LocalTime source);
  bool is_complete() const { return there_ == is_there_.size(); }
  std::size_t size() const { return payload_.size(); }
  /// Up to `last` (0: all): what is missing, at most 256 from the first one on. Empty if nothing is.
  FragmentNumberSet missing(FragmentNumber last) const;

  Octets payload() const { return payload_; }
  const InlineQos& inline_qos() const { return inline_qos_; }
  PayloadKind payload_kind() const { return payload_kind_; }
  sim::LocalTime source() const { return source_; }
  FragmentNumber announced{0};  ///< the last fragment that the writer says it has sent; 0: it has not said

 private:
  std::uint16_t fragment_size_;
  std::vector<std::byte> payload_;
  std::vector<bool> is_there_;
  std::size_t there_ = 0;
  InlineQos inline_qos_;
  PayloadKind payload_kind_ = PayloadKind::data;
  sim::LocalTime source_;
};

}  // namespace takt::dds
