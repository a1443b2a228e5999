// SPDX-License-Identifier: Apache-2.0
// What a node says on standard error while it runs: whole lines, from any thread, bounded in rate and in memory like
// its log. Nobody waits for whoever reads them.
#pragma once

#include <mutex>

#include "node/log.hpp"

namespace takt::node {

class Notices {
 public:
  /// `file` outlives it; it alone writes to it from now on.
  explicit Notices(std::FILE* file)
      : log_(file, {.octets_per_second = 4096,
                    .octets_at_once = 64 << 10,
                    .octets_waiting = 64 << 10,
                    .left_out = Notes::text}) {}

  /// "takt: TEXT" on one line, in which nothing acts on a terminal.
  void say(std::string_view text);
  /// Lines of the program's own, as they are.
  void page(std::string_view lines);
  /// Hands on what a slow reader has left waiting.
  void flush();
  /// The last lines: waits for half a second at most until they have been taken.
  void finish(std::string_view lines);

 private:
  std::mutex mutex_;
  Log log_;
};

/// A text of strangers for a line: at most so many octets of it.
std::string cut_text(std::string_view text, std::size_t most_octets = 200);

}  // namespace takt::node
