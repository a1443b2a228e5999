// SPDX-License-Identifier: Apache-2.0
// The log of a node: whole lines, bounded in rate and in memory. It never waits for whoever reads it, and says what it
// has left out.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace takt::node {

/// How a line says that others were left out.
enum class Notes : std::uint8_t { json, text };

/// The defaults let through what nodes say that are not under attack, and keep what others can make them say below what
/// a journal keeps.
struct LogLimits {
  std::size_t octets_per_second = std::size_t{64} << 10;
  std::size_t octets_at_once = std::size_t{1} << 20;    ///< after a silence
  std::size_t octets_waiting = std::size_t{256} << 10;  ///< for a reader that is slow
  Notes left_out = Notes::json;
};

class Log {
 public:
  /// `file` outlives the log, which alone writes to it from now on.
  explicit Log(std::FILE* file, const LogLimits& limits = {});
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  /// A JSON object and a newline. Left out whole where there is no room for it; a line behind it says how many were.
  void write(std::string_view line);
  /// Hands on what waits, as far as nobody has to be waited for.
  void flush();
  /// The last line, whatever the rate: waits at most so long until it has been taken.
  void finish(std::string_view line, std::int64_t most_ns = 1'000'000'000);

  std::uint64_t lines_left_out() const { return left_out_; }
  /// Nothing waits to be handed on.
  bool is_idle() const { return waiting_.size() == handed_; }

 private:
  /// Room by the rate and in memory; takes it.
  bool admit(std::size_t octets, std::int64_t now_ns);
  void log_left_out(std::int64_t now_ns);
  std::string note() const;
  /// Whether octets were taken.
  bool hand_on();
  void wait_until_taken(std::int64_t until_ns);

  int file_;
  LogLimits limits_;
  bool is_socket_ = false;
  bool is_closed_ = false;  ///< nobody will ever read it
  std::string waiting_;
  std::size_t handed_ = 0;    ///< of `waiting_`, from the front
  std::uint64_t credit_ = 0;  ///< octets that may be written now
  std::int64_t credited_ns_ = 0;
  std::uint64_t left_out_ = 0;
  std::uint64_t told_ = 0;  ///< of them
};

}  // namespace takt::node
