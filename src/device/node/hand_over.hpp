// SPDX-License-Identifier: Apache-2.0
// Between the cycle and the server of a node: calls one way, news and answers the other, without locks. Neither side
// waits for the other; the cycle allocates nothing.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>

#include "node/server_state.hpp"
#include "node/socket.hpp"
#include "program/status.hpp"
#include "wire/program_news.hpp"

namespace takt::node {

/// A queue from one thread to one other.
template <class T, std::size_t Size>
class Queue {
  static_assert((Size & (Size - 1)) == 0, "a power of two");

 public:
  /// False if it is full.
  bool put(const T& value) {
    const std::size_t at = written_.load(std::memory_order_relaxed);
    if (at - read_.load(std::memory_order_acquire) == Size) return false;
    values_[at % Size] = value;
    written_.store(at + 1, std::memory_order_release);
    return true;
  }
  /// How many wait at most; of the writer's side.
  std::size_t size() const { return written_.load(std::memory_order_relaxed) - read_.load(std::memory_order_acquire); }
  std::optional<T> next() {
    const std::size_t at = read_.load(std::memory_order_relaxed);
    if (at == written_.load(std::memory_order_acquire)) return std::nullopt;
    const T value = values_[at % Size];
    read_.store(at + 1, std::memory_order_release);
    return value;
  }

 private:
  std::array<T, Size> values_{};
  alignas(64) std::atomic<std::size_t> written_{0};
  alignas(64) std::atomic<std::size_t> read_{0};
};

/// An eventfd: what one thread wakes another with, by a system call that does not wait.
class Wake {
 public:
  Wake();
  bool is_open() const { return fd_.is_open(); }
  int file_descriptor() const { return fd_.number(); }
  void signal() const;
  void clear() const;

 private:
  FileDescriptor fd_;
};

/// Holds one thing for who comes: the newest.
template <class T>
class Newest {
 public:
  Newest() = default;
  Newest(const Newest&) = delete;
  Newest& operator=(const Newest&) = delete;
  ~Newest() { take(); }

  /// What was there and has not been taken is dropped.
  void give(std::unique_ptr<T> thing) {
    std::unique_ptr<T>(waiting_.exchange(thing.release(), std::memory_order_acq_rel));
  }
  /// Null: nothing new.
  std::unique_ptr<T> take() {
    if (waiting_.load(std::memory_order_relaxed) == nullptr) return nullptr;
    return std::unique_ptr<T>(waiting_.exchange(nullptr, std::memory_order_acq_rel));
  }

 private:
  std::atomic<T*> waiting_{nullptr};
};

class HandOver {
 public:
  struct Call {
    std::uint64_t serial = 0;
    std::uint16_t program = 0;
    program::Method method = program::Method::Halt;
  };
  /// What the cycle says: news, or the answer to a call.
  struct Report {
    wire::ProgramNews news;
    std::uint64_t answered = 0;  ///< serial; 0: it is news
    program::StatusCode status = program::StatusCode::Good;
  };

  bool is_open() const { return calls_wake_.is_open() && reports_wake_.is_open(); }

  // The cycle's side.
  int calls_descriptor() const { return calls_wake_.file_descriptor(); }
  std::optional<Call> next_call() { return calls_.next(); }
  void clear_calls_wake() const { calls_wake_.clear(); }
  /// They are told when the cycle has time: `flush`.
  void report(const Report& report);
  void flush();
  /// What the server has said of itself last; null: nothing new.
  std::unique_ptr<ServerState> state() { return states_.take(); }

  // The server's side.
  /// False: the cycle has not taken those before it. The last places are those of Halt.
  bool call(const Call& call);
  void tell(const ServerState& state) { states_.give(std::make_unique<ServerState>(state)); }
  int reports_descriptor() const { return reports_wake_.file_descriptor(); }
  void clear_reports_wake() const { reports_wake_.clear(); }
  std::optional<Report> next_report() { return reports_.next(); }
  /// Reports that found no room, so far.
  std::uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::size_t places_of_other_calls = 48;
  Queue<Call, 64> calls_;
  Queue<Report, 4096> reports_;
  Newest<ServerState> states_;
  Wake calls_wake_;
  Wake reports_wake_;
  bool has_reports_ = false;  ///< since the last flush; the cycle's own
  std::atomic<std::uint64_t> lost_{0};
};

}  // namespace takt::node
