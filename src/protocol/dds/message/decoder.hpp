// SPDX-License-Identifier: Apache-2.0
// An RTPS message, submessage by submessage (DDSI-RTPS 8.3.4, 9.4): views of octets that somebody else owns.
#pragma once

#include <string_view>

#include "dds/message/message_status.hpp"
#include "dds/message/submessage.hpp"

namespace takt::dds {

/// The interpreter's state (8.3.4): what former submessages say about the one at hand.
struct Interpretation {
  ProtocolVersion version;
  VendorId vendor;
  GuidPrefix source;
  GuidPrefix destination;         ///< unknown: every participant
  std::optional<Time> timestamp;  ///< of the source
  InfoReply reply;                ///< where answers go; empty: to the locators that discovery told
};

/// Use: construct; while next(), look at submessage() and interpretation(); verdict() says whether all was taken.
class MessageDecoder {
 public:
  explicit MessageDecoder(Octets message);

  /// False at the end, and from a submessage on that is not to be taken: what stood before counts (8.3.4.1).
  bool next();

  /// `ok` as long as nothing is wrong. Before the first next(): of the header.
  MessageStatus verdict() const { return verdict_; }
  /// Submessages of unknown kinds that were passed over.
  std::uint64_t skipped() const { return skipped_; }
  const MessageHeader& header() const { return header_; }
  const Submessage& submessage() const { return submessage_; }
  SubmessageKind kind() const { return kind_; }
  /// Octets of the submessage with its header.
  std::size_t size() const { return size_; }
  const Interpretation& interpretation() const { return interpretation_; }

 private:
  bool stop(MessageStatus verdict);
  void interpret();

  Octets rest_;
  MessageHeader header_;
  Interpretation interpretation_;
  Submessage submessage_;
  SubmessageKind kind_ = SubmessageKind::pad;
  std::size_t size_ = 0;
  std::uint64_t skipped_ = 0;
  MessageStatus verdict_ = MessageStatus::ok;
};

/// "DATA", "HEARTBEAT" ... as the standard writes them; "unknown" for what it does not know.
std::string_view name_of(SubmessageKind kind);

}  // namespace takt::dds
