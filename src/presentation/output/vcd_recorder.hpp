// SPDX-License-Identifier: Apache-2.0
// Writes a value change dump (IEEE 1364 clause 18), which GTKWave opens: for each port whether it sends, how many
// frames wait, which of its gates are open; and whatever other signals are added. One tick is a picosecond.
#pragma once

#include <cstdint>
#include <map>
#include <queue>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "models/moment.hpp"
#include "models/port_directory.hpp"
#include "output/streaming_file.hpp"
#include "sim/trace.hpp"

namespace takt::output {

class VcdRecorder final : public sim::TraceSink {
 public:
  using SignalId = std::uint32_t;

  /// Writes as it records. The network outlives the recorder. Signals of a port, in the scope node.portN_to_peer:
  ///   busy           1 from the first bit of a preamble to the last bit of the frame
  ///   queued_frames  frames that wait in all its queues
  ///   gates          bit q: the gate of class q is open, by the port's own clock
  VcdRecorder(const models::Network& network, std::string path);

  /// A signal of 1 to 64 bits, before anything is recorded.
  SignalId add_signal(std::string_view scope, std::string_view name, unsigned bits, std::uint64_t initial);
  /// The signal has that value from that time on, which is not before any recorded so far.
  void set(SignalId signal, sim::TrueTime time, std::uint64_t value);

  /// The next digital output of the scenario, by number from 0: what Occurrence::output_changed tells of it is
  /// recorded.
  void add_output(std::string_view scope, std::string_view name) { outputs_.push_back(add_signal(scope, name, 1, 0)); }

  /// Nothing before that is written. Before anything is recorded.
  void begin_at(sim::TrueTime from) { time_ = from; }
  /// Nor what comes after that.
  void end_at(sim::TrueTime to) { to_ = to; }

  /// It is told of things later than they happen, each with its moment.
  void look_at(const models::Moment& moment) { view_.look_at(moment); }
  /// Gates are as gates_shown tells; until it does all are open.
  void record(const sim::TraceRecord& record) override;

  /// Writes what comes until `end` and gives the file its name; beside it a save file for GTKWave, FILE.gtkw, which
  /// shows all signals. Returns an empty text, or what went wrong.
  [[nodiscard]] std::string close(sim::TrueTime end);

 private:
  struct Signal {
    std::string scope;  // parts separated by a line break
    std::string name;
    std::string code;  // the short identifier in the file
    unsigned bits = 1;
    std::uint64_t value = 0;
  };
  /// The last bit of a frame leaves.
  struct Fall {
    sim::TrueTime time;
    SignalId signal = 0;
    friend bool operator>(const Fall& a, const Fall& b) {
      return a.time != b.time ? a.time > b.time : a.signal > b.signal;
    }
  };
  enum PortSignal : std::uint32_t { busy, queued_frames, gates, signals_of_a_port };

  void declare();
  std::string save_file() const;
  std::string unique_in(const std::string& scope, const std::string& full, std::string_view name);
  void advance_to(sim::TrueTime time);
  void show_gates(std::uint32_t position, sim::TrueTime time, std::uint64_t states);
  void change(SignalId signal, sim::TrueTime time, std::uint64_t value);
  void write_value(const Signal& signal);

  models::View view_;
  models::PortDirectory directory_;
  std::string path_;
  StreamingFile file_;
  std::vector<Signal> signals_;  // signals_of_a_port for each port, then the added ones
  std::vector<SignalId> outputs_;
  std::priority_queue<Fall, std::vector<Fall>, std::greater<>> falls_;
  std::vector<sim::TrueTime> begun_;    // by port: when the first bit of what it sends left
  std::vector<sim::TrueTime> free_at_;  // by port: when the last bit of what it sends leaves
  sim::TrueTime time_;                  // of the last time stamp in the file
  sim::TrueTime to_ = sim::TrueTime::never();
  bool declared_ = false;
  std::map<std::string, std::string> names_;  // by what they are called
  std::set<std::string> taken_;               // in their scopes
};

}  // namespace takt::output
