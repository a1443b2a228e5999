// SPDX-License-Identifier: Apache-2.0
// takt ctl: speaks to a running node through its control socket.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/companion.hpp"
#include "json/document.hpp"
#include "node/control_socket.hpp"
#include "node/node_status.hpp"

namespace takt::cli {
namespace {

struct CtlOptions {
  std::string node;
  std::string request;
  std::string program;  // "": the only one, or the outermost
  std::string format = "text";
};

std::string member(const json::Document& document, std::string_view key) {
  const json::Node* const node = document.root().find(key);
  return node == nullptr ? std::string() : node->text;
}

ExitStatus ask(const CtlOptions& options) {
  std::string problem;
  const auto answer = node::ask_node(
      options.node, options.program.empty() ? options.request : options.request + ' ' + options.program, problem);
  if (!answer) {
    std::fprintf(stderr, "takt: %s\n", problem.c_str());
    return ExitStatus::internal_error;
  }
  json::Diagnostics diagnostics;
  const auto document = json::parse(*answer, "answer", diagnostics);
  if (const std::string error = document ? member(*document, "error") : std::string(); !error.empty()) {
    std::fprintf(stderr, "takt: %s\n", error.c_str());
    return ExitStatus::bad_input;
  }
  if (!document || (document->root().find("state") == nullptr && document->root().find("programs") == nullptr)) {
    std::fprintf(stderr, "takt: not the answer of a node: %s\n", answer->c_str());
    return ExitStatus::internal_error;
  }
  const std::string where =
      member(*document, "program").empty() ? std::string() : " in " + member(*document, "program");
  if (options.format == "json")
    std::printf("%s\n", answer->c_str());
  else if (options.request == "status")
    std::fputs(node::status_text(*answer).c_str(), stdout);
  else
    std::printf("%s: %s; %s is %s%s\n", member(*document, "method").c_str(), member(*document, "status").c_str(),
                options.node.c_str(), member(*document, "state").c_str(), where.c_str());
  return options.request == "status" || member(*document, "status") == "Good" ? ExitStatus::pass
                                                                              : ExitStatus::requirement_failed;
}

}  // namespace

void add_ctl_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("ctl", companion_help("ctl"));
  const auto options = std::make_shared<CtlOptions>();
  command.add_option("NODE", options->node, "The node's name, or the path of its control socket").required();
  command.add_option("REQUEST", options->request, "start, suspend, resume, halt, reset, join, leave or status")
      .required()
      .one_of({"start", "suspend", "resume", "halt", "reset", "join", "leave", "status"});
  command
      .add_option("PROGRAM", options->program,
                  "Of which Program, where the node is in several; the outermost if absent")
      .check([](const std::string& name) {
        return name.empty() || name.size() > 200 ? std::string("the name of a Program has 1 to 200 octets")
                                                 : std::string();
      });
  command.add_option("--format", options->format, "text or json").one_of({"text", "json"});
  command.footer(
      "Examples:\n"
      "  takt ctl plc start\n"
      "  takt ctl plc status --format json\n"
      "  takt ctl machine1 suspend axis\n"
      "  takt ctl robotC join                    a node that offers its skills; the master's status shows which node "
      "has which role\n"
      "  takt ctl /run/cell/left.sock halt\n"
      "A method's answer is its StatusCode (OPC 10000-10) and the state behind it; the others of the group follow "
      "later.\n"
      "Exit status: 0 Good, 1 another StatusCode, 2 bad input, 3 no such node.");
  command.callback([options, &status] { status = ask(*options); });
}

}  // namespace takt::cli
