// SPDX-License-Identifier: Apache-2.0
// A sub-command of takt as a process beside the engine: it may be ended at any time, and what goes wrong in it stays
// there.
#pragma once

#include <sys/types.h>

#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace takt::studio {

class Command {
 public:
  /// Starts `program` with the arguments, which do not name it. What it keeps alive lives until it has ended. Null if
  /// it cannot be started.
  static std::unique_ptr<Command> start(const std::string& program, const std::vector<std::string>& arguments,
                                        std::vector<std::shared_ptr<const std::string>> keeps);
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;
  /// Ends it, with all that it has started.
  ~Command();

  struct State {
    bool is_running = true;
    int status = -1;     ///< exit status; -1: it was ended by a signal, or runs
    std::string output;  ///< so far
    std::string errors;  ///< likewise, the first of them
  };
  State state();

 private:
  Command(pid_t process, int output, int errors, std::vector<std::shared_ptr<const std::string>> keeps);
  void listen(int output, int errors);

  const pid_t process_;
  std::vector<std::shared_ptr<const std::string>> keeps_;
  std::mutex mutex_;
  State state_;
  std::thread listener_;  // last: it uses all of the above
};

}  // namespace takt::studio
