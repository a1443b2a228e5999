// SPDX-License-Identifier: Apache-2.0
// One way through a gateway: what one protocol's subscriber receives becomes what the other protocol's publisher sends.
#pragma once

#include "gateway/shared_buffer.hpp"
#include "gateway/type_mapping.hpp"

namespace takt::gateway {

/// What became of all that was received. `buffer.received` and the mapping errors together are what was received.
struct ChannelFigures {
  BufferFigures buffer;
  AgeFigures age;
  std::array<std::uint64_t, mapping_error_count> mapping_errors{};
  std::uint64_t received() const { return buffer.received + mapping_error_total(); }
  std::uint64_t mapping_error_total() const;
  bool operator==(const ChannelFigures&) const = default;
};

/// Sans-IO, and of no DDS implementation: CDR payloads and field octets go in and come out. Values are mapped when they
/// are received, and wait as what will be sent. The host calls `receive` on reception and `pull` on the activation of
/// its sender; the two have nothing to do with each other. A host with a thread for each holds a lock.
class Channel {
 public:
  Channel(TypeMapping mapping, const BufferSettings& buffer) : mapping_(std::move(mapping)), buffer_(buffer) {}

  /// To DDS: all fields of a DataSet as Variants, one behind the other (`FieldValues::octets`). To OPC UA: a CDR
  /// payload with its encapsulation header.
  MappingError receive(Octets value, sim::LocalTime now);
  /// What is to be sent now, if anything: a CDR payload, or the fields that `FieldValues::assign` takes.
  std::optional<SharedBuffer::Value> pull(sim::LocalTime now) { return buffer_.pull(now); }

  std::size_t waiting() const { return buffer_.waiting(); }
  const TypeMapping& mapping() const { return mapping_; }
  ChannelFigures figures() const { return {buffer_.figures(), buffer_.age(), errors_}; }

 private:
  TypeMapping mapping_;
  SharedBuffer buffer_;
  std::vector<std::byte> mapped_;
  std::array<std::uint64_t, mapping_error_count> errors_{};
};

}  // namespace takt::gateway
