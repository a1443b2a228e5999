// SPDX-License-Identifier: Apache-2.0
// A child process, perhaps in a network namespace.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace takt::emulate {

class Child {
 public:
  struct Settings {
    std::vector<std::string> command;  ///< the program, looked up in PATH, and its arguments
    std::string network_namespace;     ///< "": that of the parent
    std::string output;                ///< files for what it says; "": the parent's
    std::string errors;
    bool append = false;
  };
  /// It is killed when its parent dies, however that comes.
  explicit Child(const Settings& settings);
  Child(Child&& other) noexcept : pid_(other.pid_), status_(other.status_) { other.pid_ = -1; }
  Child& operator=(Child&&) = delete;
  /// Kills it and waits for it.
  ~Child();

  bool is_running();
  void send(int signal);
  /// Waits for its end, at most so long. The exit status, 128 and the number for a signal; nothing if it still runs.
  std::optional<int> wait(int milliseconds);

 private:
  pid_t pid_;
  std::optional<int> status_;
};

/// Runs a command to its end, at most half a minute. "" if it succeeded, otherwise what it said.
std::string run_command(const std::vector<std::string>& command);

/// The file that runs now; "" if the system does not tell.
std::string node_program();

}  // namespace takt::emulate
