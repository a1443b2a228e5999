// SPDX-License-Identifier: Apache-2.0
// What a node has to do after a turn of its part in a Program: plain values, in order.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "handshake/binder.hpp"
#include "handshake/coupling.hpp"
#include "handshake/io.hpp"
#include "program/status.hpp"
#include "pubsub/stack.hpp"
#include "sim/check.hpp"
#include "sim/time.hpp"
#include "uadp/octets.hpp"
#include "wire/role_format.hpp"
#include "wire/verdict.hpp"

namespace takt::wire {

/// ProgramNode::wake is wanted at that time; replaces the alarm's earlier setting.
struct SetAlarm {
  std::size_t alarm = 0;
  sim::LocalTime time;
};
/// A message to the Destination with its WriterGroupId. The octets last until all outputs have been taken; who carries
/// it out may still put the user's fields, all zeros so far, into process data.
struct Publish {
  std::span<std::byte> octets;
  pubsub::Destination destination;
  std::uint16_t sequence = 0;
  handshake::Word word = {};  ///< of a state

  bool is_state() const { return destination.writer_group_id == state_writer_group; }
  /// A table of bindings, or an announcement.
  bool is_of_roles() const { return destination.writer_group_id >= announcement_writer_group; }
  /// Of a message of process data.
  std::uint8_t data_set() const {
    return static_cast<std::uint8_t>(destination.writer_group_id - first_data_writer_group);
  }
  std::span<std::byte> fields() const { return octets.subspan(process_data_octets(0)); }
  /// `paper` has no run; an observer may say in which one it was sent. No participant reads it.
  void set_run(std::uint32_t run) const { uadp::store_little_endian(octets.data() + fields_at, run); }
};
/// A state of a peer has been taken; the step follows, unless it is quiet.
struct Heard {
  std::size_t peer = 0;
  handshake::Word word;
};
/// The participant has taken a step that is not quiet (handshake::Outputs), and this is its word now.
struct Stepped {
  handshake::Outputs outputs;
  handshake::Word after;
};
/// At the master of roles: a role has another node, or none.
struct RoleBound {
  std::size_t role = 0;
  handshake::Binding binding;
};
/// At a candidate: it has this role now, or has been let go. `self` is the life that the role was bound to.
struct RoleTaken {
  std::size_t role = 0;
  handshake::Binding self;
};
struct RoleDropped {
  std::size_t role = 0;
  handshake::Binding self;
};

/// No message is longer.
inline constexpr std::size_t most_message_octets = 1500;

/// A ProcessDataMessage has come that the application may use; its fields are those of the message that was received.
using Output = std::variant<SetAlarm, Publish, Heard, Stepped, ProcessDataMessage, RoleBound, RoleTaken, RoleDropped>;

/// The outputs of a turn, to be carried out one after the other before the next one. Needs no memory once it has had
/// the longest turn.
class NodeOutputs {
 public:
  struct Entry {
    Entry(auto&& output, handshake::Side of) : what(std::forward<decltype(output)>(output)), side(of) {}
    Output what;
    handshake::Side side =
        handshake::Side::outer;  ///< which of two nested Programs of the node it is for (nesting.hpp)
  };

  /// Of a call; Good for every other turn.
  program::StatusCode status = program::StatusCode::Good;
  /// Of a message that has come.
  Verdict verdict = Verdict::taken;

  /// The next one, which lasts until the next turn; null when all have been taken.
  const Entry* next() {
    if (taken_ < entries_.size()) return &entries_[taken_++];
    forget();
    return nullptr;
  }
  /// Calls carry(entry) for each that has not been taken.
  void carry_out(auto&& carry) {
    const Entry* const end = entries_.data() + entries_.size();
    const Entry* entry = entries_.data() + taken_;
    for (taken_ = entries_.size(); entry != end; ++entry) carry(*entry);
    forget();
  }

  void add(handshake::Side side, auto&& what) {
    TAKT_CHECK(taken_ == 0, "outputs are carried out before the next turn");
    entries_.emplace_back(std::forward<decltype(what)>(what), side);
  }
  /// Where a message is written that an output publishes.
  std::span<std::byte> message() {
    if (messages_used_ == messages_.size()) [[unlikely]]
      messages_.push_back(std::make_unique<Message>());
    return *messages_[messages_used_++];
  }

 private:
  using Message = std::array<std::byte, most_message_octets>;
  void forget() {
    entries_.clear();
    taken_ = 0;
    messages_used_ = 0;
  }

  std::vector<Entry> entries_;
  std::size_t taken_ = 0;
  std::vector<std::unique_ptr<Message>> messages_;
  std::size_t messages_used_ = 0;
};

/// The instant by the clock that all participants share, and where the outputs go.
struct Turn {
  sim::LocalTime now;
  NodeOutputs& out;
};

}  // namespace takt::wire
