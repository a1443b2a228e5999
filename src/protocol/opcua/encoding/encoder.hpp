// SPDX-License-Identifier: Apache-2.0
// Writes OPC UA Binary (OPC 10000-6, 5.2) into octets of its own, up to a limit.
#pragma once

#include <concepts>
#include <tuple>
#include <type_traits>

#include "opcua/encoding/variant.hpp"
#include "uadp/octets.hpp"

namespace takt::opcua {

using uadp::Octets;

/// A structure says its members in the order of the encoding; what is written, read, compared and made up in tests
/// follows from that.
template <class T>
concept Structure = requires {
  T::members();
};
template <class T>
concept Enumerated = std::is_enum_v<T>;

class Encoder {
 public:
  explicit Encoder(std::size_t most_octets = std::size_t{16} << 20) : most_(most_octets) {}

  template <sim::Number T>
  void put(T number) {
    std::byte octets[sizeof(T)];
    uadp::store_little_endian(octets, number);
    put_octets(octets);
  }
  void put_octets(Octets octets) {
    if (octets_.size() + octets.size() > most_) overflowed_ = true;
    if (!overflowed_) octets_.insert(octets_.end(), octets.begin(), octets.end());
  }
  /// Writes over what stands at a position.
  void patch(std::size_t at, std::uint32_t number) {
    if (at + sizeof number <= octets_.size()) uadp::store_little_endian(octets_.data() + at, number);
  }

  /// More was to be written than fits: what there is, is of no use.
  bool overflowed() const { return overflowed_; }
  std::size_t position() const { return octets_.size(); }
  const std::vector<std::byte>& octets() const { return octets_; }
  std::vector<std::byte> take() { return std::move(octets_); }

 private:
  std::vector<std::byte> octets_;
  std::size_t most_;
  bool overflowed_ = false;
};

template <sim::Number T>
void encode(Encoder& to, T number) {
  to.put(number);
}
inline void encode(Encoder& to, bool flag) { to.put(static_cast<std::uint8_t>(flag ? 1 : 0)); }
template <Enumerated T>
void encode(Encoder& to, T value) {
  to.put(static_cast<std::underlying_type_t<T>>(value));
}
inline void encode(Encoder& to, DateTime time) { to.put(time.ticks); }
void encode(Encoder& to, const Text& text);
void encode(Encoder& to, const Bytes& octets);
void encode(Encoder& to, const Guid& guid);
void encode(Encoder& to, const XmlElement& xml);
void encode(Encoder& to, const NodeId& id);
void encode(Encoder& to, const ExpandedNodeId& id);
void encode(Encoder& to, const QualifiedName& name);
void encode(Encoder& to, const LocalizedText& text);
void encode(Encoder& to, const DiagnosticInfo& info);
void encode(Encoder& to, const ExtensionObject& object);
void encode(Encoder& to, const Variant& value);
void encode(Encoder& to, const DataValue& value);

template <Structure T>
void encode(Encoder& to, const T& structure);

template <class T>
void encode(Encoder& to, const List<T>& list) {
  to.put(list.is_null() ? std::int32_t{-1} : static_cast<std::int32_t>(list.size()));
  for (const auto& each : list) encode(to, static_cast<const T&>(each));
}

template <Structure T>
void encode(Encoder& to, const T& structure) {
  std::apply([&](auto... member) { (encode(to, structure.*member), ...); }, T::members());
}

/// The octets of a structure without its type.
template <Structure T>
std::vector<std::byte> encoded(const T& structure) {
  Encoder encoder;
  encode(encoder, structure);
  return encoder.take();
}

/// The structure with the id of its encoding in front, as the body of a message.
template <Structure T>
void encode_message(Encoder& to, const T& message) {
  encode(to, NodeId(T::encoding_id));
  encode(to, message);
}

/// The structure as a value.
template <Structure T>
ExtensionObject extension_of(const T& structure) {
  return {NodeId(T::encoding_id), 1, Bytes(encoded(structure))};
}

}  // namespace takt::opcua
