// SPDX-License-Identifier: Apache-2.0
// DataSetMessage: the state of one DataSet in a NetworkMessage (OPC 10000-14, 7.2.4.5).
#pragma once

#include "uadp/decode_status.hpp"
#include "uadp/variant.hpp"

namespace takt::uadp {

/// OPC 10000-14, 7.2.4.5.4; the value is the code in DataSetFlags1, bits 1 and 2.
enum class FieldEncoding : std::uint8_t { Variant, RawData, DataValue };
/// The value is the code in DataSetFlags2, bits 0 to 3.
enum class DataSetMessageType : std::uint8_t { KeyFrame, DeltaFrame, Event, KeepAlive };

struct DataSetMessageHeader {
  bool valid = true;  ///< false: the receiver ignores all the rest
  FieldEncoding encoding = FieldEncoding::Variant;
  DataSetMessageType type = DataSetMessageType::KeyFrame;
  std::optional<std::uint16_t>
      sequence_number;  ///< of the DataSetWriter; a keep-alive carries the next one and takes none
  std::optional<DateTime> timestamp;
  std::optional<std::uint16_t> picoseconds;    ///< 10 ps, 0 to 9999
  std::optional<std::uint16_t> status;         ///< upper half of a StatusCode
  std::optional<std::uint32_t> major_version;  ///< ConfigurationVersion: VersionTime
  std::optional<std::uint32_t> minor_version;
  bool operator==(const DataSetMessageHeader&) const = default;
};

struct DataSetMessage {
  DataSetMessageHeader header;
  Octets body;  ///< behind the header: fields and what may stand behind them
  std::size_t body_offset = 0;
};

/// Reads the header. Of a message that is not valid nothing but the first octet is looked at.
DecodeStatus decode(Octets octets, DataSetMessage& message);

/// A field of a message that is encoded as Variants or DataValues.
struct Field {
  std::uint16_t index = 0;  ///< position in the DataSetMetaData
  DataValue value;          ///< of the Variant encoding the value only
};

/// Gives the fields of a Variant or DataValue body in their order. RawData needs a RawLayout instead.
class FieldReader {
 public:
  explicit FieldReader(const DataSetMessage& message);

  /// FieldCount; 0 for a keep-alive, a heartbeat and RawData.
  std::size_t count() const { return count_; }
  /// The next field; nothing at the end or when the body is malformed, which failed() tells.
  std::optional<Field> next();
  bool failed() const { return reader_.failed(); }
  /// Octets of the body that were read so far.
  std::size_t position() const { return reader_.position(); }

 private:
  Reader reader_;
  std::size_t count_ = 0;
  std::size_t given_ = 0;
  FieldEncoding encoding_;
  bool is_delta_;
};

/// What a field says: a value, how good it is, or both.
struct FieldState {
  std::optional<Variant> value;  ///< nothing: Bad, or left out (a delta frame's padding)
  Status status;
};

/// Of a field that is to have this type (OPC 10000-14, 7.2.4.5.4): encoded as a Variant, a Bad field is a StatusCode in
/// its place, and one that is Uncertain a DataValue with both; encoded as a DataValue it carries its status. Nothing if
/// a DataValue within a Variant is malformed.
std::optional<FieldState> state_of(const DataValue& field, BuiltInType type);

/// True if the whole body can be read.
bool is_well_formed(const DataSetMessage& message);

}  // namespace takt::uadp
