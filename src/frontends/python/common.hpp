// SPDX-License-Identifier: Apache-2.0
// What the parts of the module share: mistakes as Python gets them, what is asked while something runs without the
// interpreter's lock, and a scenario.
#pragma once

#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "json/diagnostics.hpp"
#include "json/node.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::python {

namespace py = pybind11;

/// A mistake of the user; Python gets it as takt.Mistake. The text is what the command prints, the JSON what --format
/// json does.
struct Mistake : std::exception {
  explicit Mistake(std::string what, std::string diagnostics = "")
      : text(std::move(what)), json(std::move(diagnostics)) {}
  const char* what() const noexcept override { return text.c_str(); }
  std::string text;
  std::string json;
};

inline Mistake mistake_of(const json::Diagnostics& diagnostics) {
  return Mistake(diagnostics.to_text(), json::compact(diagnostics.to_json()));
}

using Progress = std::optional<std::function<void(double)>>;  // a share from 0 to 1

/// Asked now and then by what runs without the interpreter's lock.
class Watch {
 public:
  explicit Watch(const Progress& progress) : progress_(progress) {}
  bool keep_going(double share) {
    // Threads of a search may ask at the same time: one of them is enough.
    const std::unique_lock alone(mutex_, std::try_to_lock);
    if (!alone || is_interrupted_) return !is_interrupted_;
    const auto now = Clock::now();
    if (now - asked_ < std::chrono::milliseconds(100)) return true;
    asked_ = now;
    const py::gil_scoped_acquire lock;
    try {
      if (progress_ && *progress_) (*progress_)(share);
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    } catch (const py::error_already_set&) {
      failure_ = std::current_exception();
      is_interrupted_ = true;
    }
    return !is_interrupted_;
  }
  /// With the lock: what Python raised meanwhile, Ctrl-C among it.
  void raise() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  const Progress& progress_;
  Clock::time_point asked_ = Clock::now();
  std::mutex mutex_;
  std::atomic<bool> is_interrupted_ = false;
  std::exception_ptr failure_;
};

struct Scenario {
  std::shared_ptr<scenario::Resolved> resolved;
  std::string warnings;
};

/// schedule and explore.
void add_questions(py::module_& m);

}  // namespace takt::python
