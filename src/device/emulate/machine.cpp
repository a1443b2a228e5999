// SPDX-License-Identifier: Apache-2.0
#include "emulate/machine.hpp"

#include <signal.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "emulate/child.hpp"

namespace takt::emulate {
namespace {

namespace fs = std::filesystem;

const std::string prefix = "takt-";
const std::string folder_prefix = "takt-emulate-";

/// The process of "takt-PID-N" or "takt-emulate-PID"; nothing for other names.
std::optional<pid_t> owner_of(std::string_view name, std::string_view before) {
  if (!name.starts_with(before)) return std::nullopt;
  name.remove_prefix(before.size());
  pid_t pid = 0;
  const auto parsed = std::from_chars(name.data(), name.data() + name.size(), pid);
  const std::string_view rest(parsed.ptr, static_cast<std::size_t>(name.data() + name.size() - parsed.ptr));
  if (parsed.ec != std::errc() || pid <= 0 || (!rest.empty() && rest[0] != '-')) return std::nullopt;
  return pid;
}

bool is_alive(pid_t pid) { return ::kill(pid, 0) == 0 || errno != ESRCH; }

std::vector<std::string> orphans_in(const fs::path& folder, std::string_view before) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (const auto owner = owner_of(name, before); owner && !is_alive(*owner)) names.push_back(name);
  }
  return names;
}

/// One `ip` for many lines.
std::string ip_batch(const std::string& folder, const std::string& network_namespace, const std::string& lines) {
  const std::string file = folder + "/ip.batch";
  std::ofstream(file) << lines;
  std::vector<std::string> command = {"ip"};
  if (!network_namespace.empty()) command.insert(command.end(), {"-n", network_namespace});
  command.insert(command.end(), {"-batch", file});
  return run_command(command);
}

}  // namespace

std::size_t remove_leftovers() {
  const std::vector<std::string> namespaces = orphans_in("/run/netns", prefix);
  for (const std::string& name : namespaces) run_command({"ip", "netns", "del", name});
  for (const std::string& name : orphans_in(fs::temp_directory_path(), folder_prefix)) {
    std::error_code error;
    fs::remove_all(fs::temp_directory_path() / name, error);
  }
  return namespaces.size();
}

Machine::Machine(const Plan& plan) : plan_(plan) {
  const std::string own = std::to_string(::getpid());
  for (std::size_t n = 0; n < plan.is_bridge.size(); ++n) names_.push_back(prefix + own + "-" + std::to_string(n));
  folder_ = (fs::temp_directory_path() / (folder_prefix + own)).string();
}

std::unique_ptr<Machine> Machine::lay(const Plan& plan, std::string& problem) {
  if (::geteuid() != 0) {
    problem = "network namespaces need root; try sudo";
    return nullptr;
  }
  remove_leftovers();
  std::unique_ptr<Machine> machine(new Machine(plan));
  problem = machine->make();
  return problem.empty() ? std::move(machine) : nullptr;
}

std::string Machine::make() {
  // Left behind by a process that had the same number.
  std::error_code error;
  fs::remove_all(folder_, error);
  for (const std::string& name : names_)
    if (fs::exists("/run/netns/" + name, error)) run_command({"ip", "netns", "del", name});
  if (::mkdir(folder_.c_str(), 0700) != 0) return folder_ + ": " + std::strerror(errno);
  std::string lines;
  for (const std::string& name : names_) lines += "netns add " + name + "\n";
  for (const Cable& cable : plan_.cables)
    lines += "link add " + cable.a.interface + " netns " + names_[cable.a.node] + " type veth peer name " +
             cable.b.interface + " netns " + names_[cable.b.node] + "\n";
  if (std::string problem = ip_batch(folder_, "", lines); !problem.empty()) return problem;
  for (std::uint32_t n = 0; n < names_.size(); ++n) {
    lines = "link set lo up\n";
    if (plan_.is_bridge[n]) lines += "link add br0 type bridge stp_state 0 mcast_snooping 0\nlink set br0 up\n";
    for (const Cable& cable : plan_.cables)
      for (const Cable::End* end : {&cable.a, &cable.b})
        if (end->node == n) lines += "link set " + end->interface + (plan_.is_bridge[n] ? " master br0" : "") + " up\n";
    if (std::string problem = ip_batch(folder_, names_[n], lines); !problem.empty()) return problem;
  }
  return {};
}

/// The peer of a veth goes with it, and both with the namespace of one.
Machine::~Machine() {
  for (const std::string& name : names_)
    if (fs::exists("/run/netns/" + name)) run_command({"ip", "netns", "del", name});
  std::error_code error;
  fs::remove_all(folder_, error);
}

std::string Machine::wait_for_bridges() const {
  constexpr int step_ms = 50;
  constexpr int timeout_ms = 60'000;
  const timespec step = {0, step_ms * 1'000'000L};
  for (std::uint32_t n = 0; n < names_.size(); ++n) {
    const bool has_ports =
        std::ranges::any_of(plan_.cables, [&](const Cable& cable) { return cable.a.node == n || cable.b.node == n; });
    if (!plan_.is_bridge[n] || !has_ports) continue;
    std::string problem;
    for (int waited = 0; waited < timeout_ms; waited += step_ms) {
      // 3: forwarding, all of them.
      problem = run_command({"ip", "netns", "exec", names_[n], "sh", "-c",
                             "test \"$(cat /sys/class/net/p*/brport/state | sort -u)\" = 3"});
      if (problem.empty()) break;
      ::nanosleep(&step, nullptr);
    }
    if (!problem.empty()) return "the bridge does not forward: " + problem;
  }
  return {};
}

std::string Machine::add_address(std::uint32_t node, const std::string& interface, const std::string& address) const {
  return run_command({"ip", "-n", names_[node], "addr", "add", address, "dev", interface});
}

std::string Machine::set_cable(std::uint32_t number, bool up) {
  const Cable& cable = plan_.cables[number];
  return run_command({"ip", "-n", names_[cable.a.node], "link", "set", cable.a.interface, up ? "up" : "down"});
}

}  // namespace takt::emulate
