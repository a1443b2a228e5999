// SPDX-License-Identifier: Apache-2.0
// What a thread of an application publishes by and takes from, whatever the protocol.
#pragma once

#include <cstdint>
#include <optional>

#include "models/host/application.hpp"
#include "uadp/octets.hpp"

namespace takt::scenario {

/// What became of a sample.
enum class WriteOutcome : std::uint8_t {
  published,
  waits,      ///< for room in the protocol's history: go_on() tells what becomes of it
  refused,    ///< the protocol cannot take it now
  timed_out,  ///< it has waited for too long
};

/// A publication of a thread.
class TopicWriter {
 public:
  virtual ~TopicWriter() = default;
  virtual void start(models::HostServices& host) = 0;
  /// Sends a value, as its protocol carries it, or hands it to the protocol, which does.
  virtual WriteOutcome write(models::HostServices& host, uadp::Octets value) = 0;
  /// The protocol was woken or has received something: what becomes of the sample that waits, if any; nothing while it
  /// still does.
  virtual std::optional<WriteOutcome> go_on(models::HostServices&) { return std::nullopt; }
  virtual void crash() = 0;
};

/// A subscription of a thread.
class TopicReader {
 public:
  virtual ~TopicReader() = default;
  virtual void start(models::HostServices& host) = 0;
  /// A message has come to the host: it waits until the thread asks.
  virtual void receive(models::HostServices& host, uadp::Octets message) = 0;
  /// The next value that has come, oldest first, as its protocol carries it. The octets last until the next call.
  virtual std::optional<uadp::Octets> next(models::HostServices& host) = 0;
  /// Samples that were sent, as their numbers show, and did not come, or came where no room was left.
  virtual std::uint64_t lost() const = 0;
  /// Samples that came and that newer ones displaced before a call.
  virtual std::uint64_t displaced() const { return 0; }
  /// Samples that its content filter kept out.
  virtual std::uint64_t filtered() const { return 0; }
  virtual void crash() = 0;
};

}  // namespace takt::scenario
