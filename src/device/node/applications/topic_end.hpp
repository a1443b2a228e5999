// SPDX-License-Identifier: Apache-2.0
// What threads of applications publish by and take from, whatever the protocol.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "node/applications/config.hpp"
#include "node/dds/participant.hpp"
#include "node/socket.hpp"
#include "node/sources.hpp"

namespace takt::node {

/// Values travel as their protocol has them: the fields of a DataSet as Variants, or a CDR payload.
class TopicWriter {
 public:
  virtual ~TopicWriter() = default;
  virtual SendOutcome write(uadp::Octets value) = 0;
};

class TopicReader {
 public:
  virtual ~TopicReader() = default;
  /// The values that had come, oldest first, `most_taken` of them at most. They are valid until the next call.
  virtual std::span<const std::vector<std::byte>> take() = 0;
  /// Values that were sent, as their numbers show, and did not come; 0 where the protocol does not tell.
  virtual std::uint64_t lost() const { return 0; }
};

/// All topics of OPC UA of a node, behind one socket. Calls may come from several threads.
class OpcUaTopics {
 public:
  OpcUaTopics(std::unique_ptr<Socket> socket, std::int64_t (*now_ns)());
  ~OpcUaTopics();

  /// Both are its own and live as long as it does. Each writer of a topic has a WriterGroup of its own; readers hear
  /// all of them.
  TopicWriter& add_writer(const LoadedTopic& topic, std::uint16_t writer_group = 1);
  TopicReader& add_reader(const LoadedTopic& topic);

  std::uint64_t send_failures() const;
  /// Whom it has heard, and what became of that.
  std::vector<HeardSource> sources() const;

 private:
  struct Shared;
  class Writer;
  class Reader;
  std::unique_ptr<Shared> shared_;
};

}  // namespace takt::node
