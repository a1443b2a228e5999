// SPDX-License-Identifier: Apache-2.0
#include "emulate/application_processes.hpp"

#include <signal.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace takt::emulate {
namespace {

constexpr int process_end_timeout_ms = 5'000;

std::string content_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

std::string ApplicationProcesses::start() {
  if (plan_.applications.empty()) return {};
  if (std::string failed = machine_.wait_for_bridges(); !failed.empty()) return failed;
  for (const PlannedApplications& planned : plan_.applications) {
    if (std::string failed = machine_.add_address(planned.host, planned.interface, planned.address); !failed.empty())
      return failed;
    Process& process = processes_.emplace_back();
    const std::string path = machine_.folder() + "/" + planned.name;
    process.plan = &planned;
    process.file = path + ".json";
    process.log = path + ".jsonl";
    process.errors = path + ".err";
    std::ofstream(process.file) << planned.config;
    start(process, false);
  }
  return {};
}

void ApplicationProcesses::start(Process& process, bool again) {
  Child::Settings settings;
  settings.command = {node_program(), "node", process.file};
  settings.network_namespace = machine_.namespace_of(process.plan->host);
  settings.output = process.log;
  settings.errors = process.errors;
  settings.append = again;
  process.child = std::make_unique<Child>(settings);
}

std::string ApplicationProcesses::not_started() const {
  for (const Process& process : processes_) {
    std::error_code absent;
    const std::uintmax_t size = std::filesystem::file_size(process.log, absent);
    if (absent || size == 0) return name_of(process);
  }
  return {};
}

std::string ApplicationProcesses::failure() {
  for (Process& process : processes_)
    if (process.child && !process.child->is_running() && process.child->wait(0) != 0)
      return "the applications of " + name_of(process) + " have ended: " + content_of(process.errors);
  return {};
}

void ApplicationProcesses::set_host(std::uint32_t host, bool up) {
  for (Process& process : processes_) {
    if (process.plan->host != host) continue;
    process.is_whole = false;
    up ? start(process, true) : process.child.reset();
  }
}

void ApplicationProcesses::stop(bool at_once) {
  for (Process& process : processes_)
    if (process.child && (at_once || !process.is_whole || !process.child->wait(process_end_timeout_ms)))
      process.child->send(SIGTERM);
}

void ApplicationProcesses::wait() {
  for (Process& process : processes_)
    if (process.child) process.child->wait(process_end_timeout_ms);
}

std::vector<std::string> ApplicationProcesses::files() const {
  std::vector<std::string> all;
  for (const Process& process : processes_) all.insert(all.end(), {process.file, process.log, process.errors});
  return all;
}

std::string ApplicationProcesses::collect(EmulatedThreads& threads, std::vector<bool>& is_whole) const {
  is_whole.assign(resolved_.applications.size(), true);
  for (const Process& process : processes_) {
    std::ifstream log(process.log);
    std::string last;
    for (std::string line; std::getline(log, line);)
      if (!line.empty()) last = line;
    if (!add_threads(last, threads) && process.is_whole)
      return "the applications of " + name_of(process) +
             " have told nothing at their end: " + content_of(process.errors);
    for (std::size_t a = 0; a < is_whole.size(); ++a)
      if (resolved_.applications[a].node.value == process.plan->host) is_whole[a] = process.is_whole;
  }
  return {};
}

}  // namespace takt::emulate
