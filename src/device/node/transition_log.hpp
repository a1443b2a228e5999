// SPDX-License-Identifier: Apache-2.0
// What a node does, as JSON lines: one object an event, written at once.
#pragma once

#include <string>
#include <string_view>

#include "handshake/io.hpp"
#include "node/log.hpp"
#include "node/node_status.hpp"
#include "program/method.hpp"

namespace takt::node {

class TransitionLog {
 public:
  /// `log` outlives it. What a Program does is named with it, unless the name is empty.
  explicit TransitionLog(Log& log, std::string_view program = {});

  /// Times are nanoseconds of the node's clock.
  void started(std::int64_t time, std::string_view node, std::uint32_t incarnation);
  /// A step of the participant, whose word is `after` now: an intent raised, changes of state, or nothing but another
  /// run.
  void stepped(std::int64_t time, const handshake::Outputs& outputs, const handshake::Word& after);
  void called(std::int64_t time, program::Method method, program::StatusCode status);

  /// The master has bound a role to this life of a node, or to none (an empty name).
  void bound(std::int64_t time, std::string_view role, std::string_view node, std::uint32_t life);
  /// This node has a role from now on, as this life, and what it does there is named with it. Or it has none any more.
  void took_role(std::int64_t time, std::string_view role, std::uint32_t life);
  void dropped_role(std::int64_t time);
  void membership(std::int64_t time, Membership what);

  /// A sender is refused for this reason for the first time.
  void refused(std::int64_t time, std::string_view address, std::optional<std::uint64_t> publisher_id,
               std::string_view verdict);

  /// Something of the machine has changed.
  void noticed(std::int64_t time, std::string_view what);
  /// Two nodes send under one name.
  void twins(std::int64_t time, const SourceTable::Twins& twins);

  void ended(const NodeStatus& status);

 private:
  Log* log_;
  std::string program_;   ///< as a member with a comma behind it; or empty
  std::string names_;     ///< the same, and the role
  handshake::Word last_;  ///< whose run and intent have been written
};

}  // namespace takt::node
