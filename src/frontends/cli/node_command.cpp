// SPDX-License-Identifier: Apache-2.0
// takt node: a participant of Programs on this machine, or applications and gateways.
#include <poll.h>

#include <csignal>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/companion.hpp"
#include "cli/interrupt.hpp"
#include "cli/terminal.hpp"
#include "node/applications/describe_topics.hpp"
#include "node/applications/host.hpp"
#include "node/applications/statistics_file.hpp"
#include "node/built_in_values.hpp"
#include "node/description.hpp"
#include "node/key_service_node.hpp"
#include "node/log.hpp"
#include "node/notices.hpp"
#include "node/real_node.hpp"
#include "node/server/key_puller.hpp"
#include "node/server/opcua_server.hpp"
#include "results/version.hpp"

namespace takt::cli {
namespace {

void print_warnings(const std::string& warnings) {
  for (std::size_t begin = 0; begin < warnings.size(); begin = warnings.find('\n', begin) + 1)
    std::fprintf(stderr, "takt: warning: %s\n", warnings.substr(begin, warnings.find('\n', begin) - begin).c_str());
}

std::string folder_of(const std::string& file) {
  return file.substr(0, file.find('/') == std::string::npos ? 0 : file.rfind('/'));
}

ExitStatus run_applications(const std::string& file, bool is_check) {
  json::Diagnostics diagnostics;
  const auto loaded = node::load_applications(file, diagnostics);
  const bool is_sound = loaded && (is_check || node::check_statistics(loaded->config, diagnostics));
  tell(diagnostics);
  if (!is_sound) return ExitStatus::bad_input;
  if (is_check) return ExitStatus::pass;
  std::string problem;
  std::string warnings;
  node::KeyMailbox mailbox;
  const bool pulls = loaded->secured && loaded->secured->key_access;
  node::Notices notices(stderr);
  const auto puller =
      pulls ? node::KeyPuller::make(*loaded->secured, folder_of(file), mailbox, notices, problem) : nullptr;
  const auto host =
      pulls && !puller ? nullptr : node::ApplicationHost::make(*loaded, problem, warnings, puller ? &mailbox : nullptr);
  if (!host) {
    std::fprintf(stderr, "takt: cannot run this node here: %s\n", problem.c_str());
    return ExitStatus::internal_error;
  }
  print_warnings(warnings);
  const InterruptGuard interrupt;  // before the start is told, which somebody may answer with a signal
  std::printf("{\"event\": \"start\", \"node\": %s}\n", json::quote(loaded->config.node).c_str());
  std::fflush(stdout);
  if (puller) puller->start();
  host->run([](const void* guard) { return static_cast<const InterruptGuard*>(guard)->requested(); }, &interrupt);
  if (puller) puller->stop();
  const node::ApplicationsReport report = host->report();
  const std::string json = node::to_json(report);
  std::printf("{\"event\": \"end\", %s\n", json.substr(1).c_str());
  std::fflush(stdout);
  notices.finish(node::to_text(report));
  if (!loaded->config.statistics) return ExitStatus::pass;
  if (const std::string unwritten = node::write_statistics(*loaded->config.statistics, json + "\n");
      !unwritten.empty()) {
    std::fprintf(stderr, "takt: cannot write %s: %s\n", loaded->config.statistics->c_str(), unwritten.c_str());
    return ExitStatus::internal_error;
  }
  return ExitStatus::pass;
}

/// The hash of a line of standard input, for a file of users.
ExitStatus hash_password() {
  std::string password;
  if (!std::getline(std::cin, password) || password.empty() || password.size() > 64) {
    std::fputs("takt: a password of 1 to 64 octets on standard input\n", stderr);
    return ExitStatus::bad_input;
  }
  std::printf("%s\n", node::hash_of_password(password).c_str());
  return ExitStatus::pass;
}

/// What another publisher or subscriber must know of the node's messages.
ExitStatus describe_node(const std::string& file) {
  if (node::is_applications_file(file)) {
    json::Diagnostics diagnostics;
    const auto loaded = node::load_applications(file, diagnostics);
    tell(diagnostics);
    if (!loaded) return ExitStatus::bad_input;
    std::fputs(node::to_json(node::description_of(*loaded)).c_str(), stdout);
    return ExitStatus::pass;
  }
  json::Diagnostics diagnostics;
  const auto loaded = node::load_config(file, diagnostics);
  tell(diagnostics);
  if (!loaded) return ExitStatus::bad_input;
  std::fputs(node::to_json(node::description_of(*loaded)).c_str(), stdout);
  return ExitStatus::pass;
}

/// A server without Programs.
ExitStatus run_key_service(const std::string& file, bool is_check) {
  json::Diagnostics diagnostics;
  const auto loaded = node::load_key_service(file, diagnostics);
  auto users = loaded && loaded->config.server->users ? node::load_users(*loaded->config.server->users, diagnostics)
                                                      : std::nullopt;
  tell(diagnostics);
  if (!loaded || !users) return ExitStatus::bad_input;
  if (is_check) return ExitStatus::pass;
  std::string problem;
  node::HandOver hand_over;
  node::Notices notices(stderr);
  const auto server = node::OpcUaServer::make(*loaded, std::move(*users), folder_of(file), hand_over, notices,
                                              results::version, problem);
  if (!server) {
    std::fprintf(stderr, "takt: cannot run this node here: %s\n", problem.c_str());
    return ExitStatus::internal_error;
  }
  const InterruptGuard interrupt;  // before the start is told, which somebody may answer with a signal
  std::printf("{\"event\": \"start\", \"node\": %s}\n", json::quote(loaded->config.node).c_str());
  std::fflush(stdout);
  notices.page(server->text());
  server->start();
  constexpr std::int64_t look_every_ms = 100;
  std::int64_t left_ms = loaded->config.duration ? loaded->config.duration->ps() / 1'000'000'000 : 0;
  while (!interrupt.requested() && (!loaded->config.duration || (left_ms -= look_every_ms) >= 0))
    ::poll(nullptr, 0, static_cast<int>(look_every_ms));
  server->stop();
  std::printf("{\"event\": \"end\", \"node\": %s}\n", json::quote(loaded->config.node).c_str());
  return ExitStatus::pass;
}

ExitStatus run_node(const std::string& file, bool is_check) {
  if (node::is_key_service_file(file)) return run_key_service(file, is_check);
  if (node::is_applications_file(file)) return run_applications(file, is_check);
  json::Diagnostics diagnostics;
  const auto loaded = node::load_config(file, diagnostics);
  const bool has_server = loaded && loaded->config.server;
  const bool has_users = has_server && loaded->config.server->users;
  auto users = has_users ? node::load_users(*loaded->config.server->users, diagnostics) : std::vector<opcua::User>();
  tell(diagnostics);
  if (!loaded || !users) return ExitStatus::bad_input;
  if (is_check) return ExitStatus::pass;
  std::string problem;
  std::string warnings;
  std::vector<std::unique_ptr<node::BuiltInValues>> values;
  std::vector<node::Application*> applications;
  std::signal(SIGPIPE, SIG_IGN);  // who reads the log may go; the node does not go with him
  node::Log log(stdout);
  for (const node::LoadedProgram& program : loaded->programs) {
    values.push_back(std::make_unique<node::BuiltInValues>(loaded->config, program.endpoint.format->shape(), log,
                                                           loaded->programs.size() > 1));
    applications.push_back(values.back().get());
  }
  node::HandOver hand_over;
  const std::string folder = folder_of(file);
  node::Notices notices(stderr);
  const auto server = has_server ? node::OpcUaServer::make(*loaded, std::move(*users), folder, hand_over, notices,
                                                           results::version, problem)
                                 : nullptr;
  if (has_server && !server) {
    std::fprintf(stderr, "takt: cannot run this node here: %s\n", problem.c_str());
    return ExitStatus::internal_error;
  }
  node::KeyMailbox mailbox;
  const auto puller = loaded->key_access ? node::KeyPuller::make(*loaded, folder, mailbox, notices, problem) : nullptr;
  const bool lacks_puller = loaded->key_access && !puller;
  const auto live = lacks_puller ? nullptr
                                 : node::RealNode::make(*loaded, log, applications, problem, warnings,
                                                        server ? &hand_over : nullptr, puller ? &mailbox : nullptr);
  if (!live) {
    std::fprintf(stderr, "takt: cannot run this node here: %s\n", problem.c_str());
    return ExitStatus::internal_error;
  }
  print_warnings(warnings);
  const InterruptGuard interrupt;
  if (server) {
    notices.page(server->text());
    server->start();
  }
  if (puller) puller->start();
  live->run([](const void* guard) { return static_cast<const InterruptGuard*>(guard)->requested(); }, &interrupt);
  if (puller) puller->stop();
  if (server) server->stop();
  notices.finish(node::status_text(live->status()));
  return ExitStatus::pass;
}

}  // namespace

void add_node_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("node", companion_help("node"));
  const auto file = std::make_shared<std::string>();
  const auto is_check = std::make_shared<bool>(false);
  const auto is_hash = std::make_shared<bool>(false);
  const auto is_describe = std::make_shared<bool>(false);
  command.add_option("CONFIG", *file, "The file of the node (JSON, comments allowed)");
  command.add_flag("--hash-password", *is_hash,
                   "Print the hash of the password on standard input, for a file of users of the server");
  command.add_flag("--check", *is_check, "Say whether the file is sound, and no more");
  command.add_flag("--describe", *is_describe,
                   "Print the messages that the node sends and hears - ids, GroupVersion, fields and where they stand "
                   "- as JSON, to configure others by, and no more");
  command.footer(
      "Examples:\n"
      "  takt node left.json                     runs until its duration is over, or until SIGINT or SIGTERM\n"
      "  takt node left.json | jq 'select(.event == \"transition\")'\n"
      "A file with \"programs\" instead of \"program\" runs a participant of several, nested or not, in one process.\n"
      "A file with \"topics\", \"applications\" and \"gateways\" instead of \"program\" runs these: OPC UA PubSub and "
      "DDS.\n"
      "A file with \"server\" and nothing that it would stand in front of runs a key service.\n"
      "Standard output is one JSON object a line: transitions, calls, intents, received values if asked for, and "
      "statistics at the end,\n"
      "which standard error has as text. takt ctl speaks to a node while it runs.\n"
      "Exit status: 0 ended or stopped, 2 bad input, 3 the machine does not let it (port, interface, permission).");
  command.callback([file, is_check, is_hash, is_describe, &status] {
    if (file->empty() && !*is_hash) std::fputs("takt: CONFIG is required: the file of the node\n", stderr);
    status = *is_hash        ? hash_password()
             : file->empty() ? ExitStatus::bad_input
             : *is_describe  ? describe_node(*file)
                             : run_node(*file, *is_check);
  });
}

}  // namespace takt::cli
