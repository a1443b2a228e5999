// SPDX-License-Identifier: Apache-2.0
#include "emulate/coexistence.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include "emulate/child.hpp"
#include "emulate/coexistence_files.hpp"
#include "emulate/machine.hpp"
#include "json/document.hpp"

namespace takt::emulate {
namespace {

namespace fs = std::filesystem;

constexpr int settling_ms = 3'500;  // of the files, and for the last thread to start
constexpr int discovery_timeout_ms = 60'000;
constexpr int window_ms = 10;
constexpr int end_timeout_ms = 10'000;

/// Namespaces of the nodes around a bridge, with addresses, for Cyclone DDS wants them; or loopback.
class Ground {
 public:
  static std::unique_ptr<Ground> lay(std::size_t nodes, std::string& problem) {
    std::unique_ptr<Ground> ground(new Ground);
    if (::geteuid() != 0) {
      ground->folder_ = (fs::temp_directory_path() / ("takt-emulate-" + std::to_string(::getpid()))).string();
      std::error_code error;
      fs::create_directories(ground->folder_, error);
      ground->network_ = {"lo", 32'000 + ::getpid() % 700,
                          1 + ::getpid() % 80};  // below the ports that the system gives to others
      return ground;
    }
    Plan plan;
    plan.is_bridge.assign(nodes + 1, false);
    plan.is_bridge[nodes] = true;
    const auto bridge = static_cast<std::uint32_t>(nodes);
    for (std::uint32_t n = 0; n < nodes; ++n)
      plan.cables.push_back({{n, "eth0"}, {bridge, "p" + std::to_string(n)}, n});
    ground->machine_ = Machine::lay(plan, problem);
    if (!ground->machine_) return nullptr;
    ground->folder_ = ground->machine_->folder();
    ground->network_ = {"eth0", 4840, 0};
    for (std::uint32_t n = 0; n < nodes && problem.empty(); ++n)
      problem = ground->machine_->add_address(n, "eth0", fmt::format("10.75.0.{}/24", n + 1));
    if (problem.empty()) problem = ground->machine_->wait_for_bridges();
    return problem.empty() ? std::move(ground) : nullptr;
  }
  ~Ground() {
    std::error_code error;
    if (!machine_) fs::remove_all(folder_, error);
  }
  Ground(const Ground&) = delete;
  Ground& operator=(const Ground&) = delete;

  std::string namespace_of(std::size_t node) const {
    return machine_ ? machine_->namespace_of(static_cast<std::uint32_t>(node)) : std::string();
  }
  const CoexistenceNetwork& network() const { return network_; }
  const std::string& folder() const { return folder_; }
  bool has_namespaces() const { return machine_ != nullptr; }

 private:
  Ground() = default;

  std::unique_ptr<Machine> machine_;
  CoexistenceNetwork network_;
  std::string folder_;
};

std::string describe_machine(bool has_namespaces) {
  utsname system = {};
  ::uname(&system);
  double load = 0;
  ::getloadavg(&load, 1);
  return fmt::format(
      "{} {}, {} processors, load {:.1f} before, {}", system.sysname, system.release,
      std::thread::hardware_concurrency(), load,
      has_namespaces ? "a network namespace for each node and a bridge" : "loopback (network namespaces need root)");
}

std::optional<double> percent_of(const json::Node& thread, const char* criterion) {
  const json::Node* const figures = thread.find(criterion);
  const json::Node* const percent = figures == nullptr ? nullptr : figures->find("percent");
  return percent == nullptr ? std::nullopt : std::optional<double>(json::double_of(*percent));
}

std::uint64_t count_of(const json::Node& node, const char* key) {
  const json::Node* const found = node.find(key);
  return found == nullptr ? 0 : static_cast<std::uint64_t>(json::double_of(*found));
}

class Measurement {
 public:
  Measurement(const CoexistenceSettings& settings, std::string& problem) : settings_(settings), problem_(problem) {}

  std::optional<MeasuredCoexistence> run() {
    for (const CaseStudy study : {CaseStudy::mirror, CaseStudy::gateway}) {
      const auto ground = Ground::lay(nodes_of(study).size(), problem_);
      if (!ground) return std::nullopt;
      if (result_.machine.empty()) result_.machine = describe_machine(ground->has_namespaces());
      for (std::size_t column = 0; column < coexistence_intervals.size(); ++column)
        if (!measure(*ground, study, column)) return std::nullopt;
    }
    return std::move(result_);
  }

 private:
  struct Running {
    std::string name;
    std::string statistics;
    std::string errors;
    std::string log;
    std::unique_ptr<Child> child;
  };

  bool measure(const Ground& ground, CaseStudy study, std::size_t column) {
    const int interval = coexistence_intervals[column];
    const char* const what = study == CaseStudy::mirror ? "mirror" : "gateway";
    if (settings_.progress) settings_.progress(fmt::format("measuring: {}, {} ms", what, interval));
    std::vector<Running> nodes;
    for (std::size_t n = 0; n < nodes_of(study).size(); ++n) {
      Running& node = nodes.emplace_back();
      node.name = nodes_of(study)[n];
      const std::string stem = fmt::format("{}/{}-{}ms-{}", ground.folder(), what, interval, node.name);
      node.statistics = stem + ".statistics.json";
      node.errors = stem + ".errors";
      std::ofstream(stem + ".json") << node_file(study, node.name, interval, settings_.windows, ground.network(),
                                                 node.statistics);
      Child::Settings child;
      child.command = {node_program(), "node", stem + ".json"};
      child.network_namespace = ground.namespace_of(n);
      node.log = stem + ".log";
      child.output = node.log;
      child.errors = node.errors;
      node.child = std::make_unique<Child>(child);
    }
    const bool done =
        wait_for_starts(nodes) && wait(nodes, settling_ms + settings_.windows * window_ms * 11 / 10) && stop(nodes);
    if (!settings_.keep.empty()) keep(ground);
    return done &&
           std::all_of(nodes.begin(), nodes.end(), [&](const Running& node) { return collect(node, study, column); });
  }

  /// Until all nodes have told of their start, from which they count.
  bool wait_for_starts(std::vector<Running>& nodes) {
    const auto has_reported = [](const Running& node) {
      std::error_code absent;
      const std::uintmax_t size = fs::file_size(node.log, absent);
      return !absent && size > 0;
    };
    for (Running& node : nodes)
      for (int waited = 0; !has_reported(node); waited += window_ms) {
        if (waited >= discovery_timeout_ms) return fail(node, "does not start");
        if (!wait(nodes, window_ms)) return false;
      }
    return true;
  }

  bool wait(std::vector<Running>& nodes, int milliseconds) {
    constexpr int step = 50;
    for (int waited = 0; waited < milliseconds; waited += step) {
      for (Running& node : nodes)
        if (!node.child->is_running()) return fail(node, "ended early");
      if (settings_.stop_requested != nullptr && settings_.stop_requested(settings_.context)) {
        problem_ = "interrupted";
        return false;
      }
      const timespec time = {0, std::min(step, milliseconds - waited) * 1'000'000L};
      ::nanosleep(&time, nullptr);
    }
    return true;
  }

  /// Who listens ends before who speaks, so that no window lacks what nobody sent any more.
  bool stop(std::vector<Running>& nodes) {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) node->child->send(SIGTERM);
    for (Running& node : nodes)
      if (node.child->wait(end_timeout_ms) != 0) return fail(node, "did not end well");
    return true;
  }

  bool fail(const Running& node, const char* what) {
    std::ifstream errors(node.errors);
    const std::string said((std::istreambuf_iterator<char>(errors)), std::istreambuf_iterator<char>());
    problem_ = "node " + node.name + " " + what + (said.empty() ? "" : ": " + said);
    return false;
  }

  bool collect(const Running& node, CaseStudy study, std::size_t column) {
    json::Diagnostics diagnostics;
    const auto document = json::parse_file(node.statistics, diagnostics);
    if (!document) return fail(node, "left no statistics");
    for (const char* kind : {"applications", "gateways"})
      for (const json::Node& one : document->root().find(kind)->items) {
        for (const json::Node& thread : one.find("threads")->items) add(node.name, thread, study, column);
        if (const json::Node* const buffer = one.find("buffer"))
          result_.buffers[column] = MeasuredBuffer{
              count_of(*buffer, "received"), count_of(*buffer, "forwarded"), count_of(*buffer, "overwritten"),
              static_cast<double>(count_of(*buffer->find("age"), "mean_ns")) / 1000};
      }
    return true;
  }

  void add(const std::string& node, const json::Node& thread, CaseStudy study, std::size_t column) {
    const std::string role = thread.find("role")->text;
    const bool takes = role == "subscribe" || role == "receive";
    const std::size_t dash = node.find('-');
    const std::string protocol = dash == std::string::npos ? "gateway" : node.starts_with("dds") ? "DDS" : "OPC UA";
    const std::string name = dash == std::string::npos ? node : node.substr(dash + 1);
    const std::string operation = takes ? "subscribe" : "publish";
    auto& rows = study == CaseStudy::mirror ? result_.mirror : result_.gateway;
    auto row = std::find_if(rows.begin(), rows.end(), [&](const MeasuredThread& each) {
      return each.protocol == protocol && each.node == name && each.operation == operation;
    });
    if (row == rows.end()) {
      MeasuredThread made;
      made.protocol = protocol;
      made.node = name;
      made.operation = operation;
      row = rows.insert(rows.end(), made);
    }
    row->success[column] = percent_of(thread, "criterion_1");
    if (takes) row->buffered[column] = percent_of(thread, "criterion_2");
    const json::Node& windows = *thread.find("criterion_1");
    row->tests[column] = count_of(windows, "tests");
    row->discarded[column] = count_of(windows, "discarded");
    row->late_p99_us[column] = static_cast<double>(count_of(*thread.find("late"), "p99_ns")) / 1000;
  }

  void keep(const Ground& ground) {
    std::error_code error;
    fs::create_directories(settings_.keep, error);
    fs::copy(ground.folder(), settings_.keep, fs::copy_options::overwrite_existing | fs::copy_options::recursive,
             error);
  }

  const CoexistenceSettings& settings_;
  std::string& problem_;
  MeasuredCoexistence result_;
};

}  // namespace

std::optional<MeasuredCoexistence> measure_coexistence(const CoexistenceSettings& settings, std::string& problem) {
  return Measurement(settings, problem).run();
}

}  // namespace takt::emulate
