// SPDX-License-Identifier: Apache-2.0
#include "output/vcd_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "models/egress/preemption.hpp"
#include "models/ethernet/sizes.hpp"

namespace takt::output {
namespace {

/// Names in a VCD hold no white space; other characters than these confuse viewers.
std::string identifier(std::string_view name) {
  std::string out(name);
  for (char& c : out) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    if (!plain) c = '_';
  }
  return out.empty() ? "_" : out;
}

/// Numbers in base 94, the printable characters as digits.
std::string code_of(std::size_t number) {
  std::string code;
  do code += static_cast<char>('!' + number % 94);
  while ((number /= 94) > 0);
  return code;
}

}  // namespace

VcdRecorder::VcdRecorder(const models::Network& network, std::string path)
    : view_(network), directory_(network), path_(path), file_(std::move(path)) {
  const std::vector<models::NodePlan>& nodes = network.plan().nodes;
  for (const models::PortDirectory::Port& port : directory_.ports()) {
    const std::string_view peer = port.peer.is_none() ? std::string_view("nothing") : nodes[port.peer.value].name;
    const std::string scope = fmt::format("{}\nport{}_to_{}", nodes[port.id.node.value].name, port.id.port, peer);
    add_signal(scope, "busy", 1, 0);
    add_signal(scope, "queued_frames", 32, 0);
    add_signal(scope, "gates", models::traffic_class_count, 0xFF);
  }
  begun_.resize(directory_.ports().size());
  free_at_.resize(directory_.ports().size());
}

VcdRecorder::SignalId VcdRecorder::add_signal(std::string_view scope, std::string_view name, unsigned bits,
                                              std::uint64_t initial) {
  TAKT_CHECK(!declared_, "signals are added before anything is recorded");
  TAKT_CHECK(bits >= 1 && bits <= 64, "a signal has 1 to 64 bits");
  // Names that differ in characters only which a VCD does not know get a number.
  std::string known, parent;
  std::string_view rest = scope;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    known += (known.empty() ? "" : "\n") + std::string(rest.substr(0, end));
    parent += (parent.empty() ? "" : "\n") + unique_in(parent, known, rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  const std::string plain = unique_in(parent, known + "\n\n" + std::string(name), name);
  signals_.push_back({parent, plain, code_of(signals_.size()), bits, initial});
  return static_cast<SignalId>(signals_.size() - 1);
}

/// The name, in that scope, of what is called `name` and told apart by `full`.
std::string VcdRecorder::unique_in(const std::string& scope, const std::string& full, std::string_view name) {
  if (const auto known = names_.find(full); known != names_.end()) return known->second;
  const std::string plain = identifier(name);
  std::string made = plain;
  for (std::size_t number = 2; !taken_.insert(scope + "\n" + made).second; ++number)
    made = plain + "_" + std::to_string(number);
  names_.emplace(full, made);
  return made;
}

void VcdRecorder::set(SignalId signal, sim::TrueTime time, std::uint64_t value) {
  if (time > to_) return;
  advance_to(time);
  change(signal, time, value);
}

void VcdRecorder::record(const sim::TraceRecord& record) {
  const auto kind = static_cast<models::Occurrence>(record.kind);
  if (kind == models::Occurrence::output_changed) {
    if (record.what < outputs_.size()) set(outputs_[record.what], record.time, record.detail);
    return;
  }
  const std::uint32_t position = directory_.find(record.where);
  if (position == models::PortDirectory::none || kind == models::Occurrence::ended) return;
  if (kind == models::Occurrence::gates_shown) {
    show_gates(position, record.time, record.what);
    return;
  }
  if (record.time > to_) return;
  advance_to(record.time);
  const models::PortDirectory::Port& port = directory_.ports()[position];
  const SignalId first = position * signals_of_a_port;

  change(first + queued_frames, record.time, view_.queued_frames(port.id.node, port.id.port));

  const auto octets = std::int64_t{models::TransmissionDetail::unpack(record.detail).octets};
  switch (kind) {
    case models::Occurrence::started:
    case models::Occurrence::resumed:
      begun_[position] = record.time;
      change(first + busy, record.time, 1);
      free_at_[position] = record.time + port.octet_time * (models::preamble_and_sfd.count + octets);
      falls_.push({free_at_[position], first + busy});
      break;
    case models::Occurrence::cut:
      free_at_[position] =
          begun_[position] + port.octet_time * (models::preamble_and_sfd.count + octets + models::mcrc.count);
      falls_.push({free_at_[position], first + busy});
      break;
    default:
      break;
  }
}

/// What they are at the beginning is among the first values of all.
void VcdRecorder::show_gates(std::uint32_t position, sim::TrueTime time, std::uint64_t states) {
  const SignalId signal = position * signals_of_a_port + gates;
  if (!declared_ && time <= time_)
    signals_[signal].value = states;
  else
    set(signal, time, states);
}

std::string VcdRecorder::close(sim::TrueTime end) {
  end = std::max(time_, std::min(end, to_));
  advance_to(end);
  if (end > time_) file_.write(fmt::format("#{}\n", end.ps()));
  if (std::string problem = file_.close(); !problem.empty()) return problem;
  StreamingFile save(path_.ends_with(".vcd") ? path_.substr(0, path_.size() - 4) + ".gtkw" : path_ + ".gtkw");
  save.write(save_file());
  return save.close();
}

/// GTKWave's own format: flags of how to show what follows (0x28: a bit; 0x22: a number in hexadecimal), then names
/// with their scopes; @200: a comment.
std::string VcdRecorder::save_file() const {
  const std::size_t slash = path_.rfind('/');
  std::string text =
      "[*] written by takt\n[dumpfile] \"" + path_.substr(slash == std::string::npos ? 0 : slash + 1) + "\"\n";
  std::string scope;
  for (const Signal& signal : signals_) {
    std::string dotted = signal.scope;
    std::replace(dotted.begin(), dotted.end(), '\n', '.');
    if (dotted != scope) text += "@200\n-" + dotted + "\n";
    scope = dotted;
    text += (signal.bits == 1 ? "@28\n" : "@22\n") + dotted + "." + signal.name +
            (signal.bits == 1 ? "" : fmt::format("[{}:0]", signal.bits - 1)) + "\n";
  }
  return text;
}

/// The header, with scopes in the order of their first signal, and the values at time zero.
void VcdRecorder::declare() {
  declared_ = true;
  file_.write("$version takt $end\n$timescale 1 ps $end\n");
  // Signals of one scope stand together; a scope is opened once for each run of its signals.
  std::vector<const Signal*> order;
  for (const Signal& signal : signals_) order.push_back(&signal);
  std::stable_sort(order.begin(), order.end(), [](const Signal* a, const Signal* b) { return a->scope < b->scope; });
  const auto parts_of = [](const std::string& scope) {
    std::vector<std::string> parts;
    for (std::size_t at = 0; at <= scope.size();) {
      const std::size_t end = std::min(scope.find('\n', at), scope.size());
      parts.push_back(identifier(std::string_view(scope).substr(at, end - at)));
      at = end + 1;
    }
    return parts;
  };
  std::vector<std::string> open;
  const auto enter = [&](const std::vector<std::string>& scope) {
    const auto common = static_cast<std::size_t>(
        std::mismatch(open.begin(), open.end(), scope.begin(), scope.end()).first - open.begin());
    for (; open.size() > common; open.pop_back()) file_.write("$upscope $end\n");
    for (std::size_t i = common; i < scope.size(); ++i) {
      file_.write("$scope module " + scope[i] + " $end\n");
      open.push_back(scope[i]);
    }
  };
  for (const Signal* const signal : order) {
    enter(parts_of(signal->scope));
    const std::string range = signal->bits > 1 ? fmt::format(" [{}:0]", signal->bits - 1) : "";
    file_.write(fmt::format("$var wire {} {} {}{} $end\n", signal->bits, signal->code, signal->name, range));
  }
  enter({});
  file_.write(fmt::format("$enddefinitions $end\n#{}\n$dumpvars\n", time_.ps()));
  for (const Signal& signal : signals_) write_value(signal);
  file_.write("$end\n");
}

/// Writes the falls up to and including that time.
void VcdRecorder::advance_to(sim::TrueTime time) {
  if (!declared_) declare();
  TAKT_CHECK(time >= time_, "a wave form is recorded in the order of time");
  while (!falls_.empty() && falls_.top().time <= time) {
    const Fall next = falls_.top();
    falls_.pop();
    if (free_at_[next.signal / signals_of_a_port] == next.time) change(next.signal, next.time, 0);  // else it was cut
  }
}

void VcdRecorder::change(SignalId id, sim::TrueTime time, std::uint64_t value) {
  Signal& signal = signals_[id];
  if (signal.value == value) return;
  if (time > time_) file_.write(fmt::format("#{}\n", time.ps()));
  time_ = time;
  signal.value = value;
  write_value(signal);
}

void VcdRecorder::write_value(const Signal& signal) {
  file_.write(signal.bits == 1 ? fmt::format("{}{}\n", signal.value & 1, signal.code)
                               : fmt::format("b{:b} {}\n", signal.value, signal.code));
}

}  // namespace takt::output
