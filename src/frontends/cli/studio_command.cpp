// SPDX-License-Identifier: Apache-2.0
// takt studio: a scenario in a browser, with what is known of it beside it.
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "cli/commands.hpp"
#include "cli/companion.hpp"
#include "cli/interrupt.hpp"
#include "json/fields.hpp"
#include "scenario/description/description.hpp"
#include "studio/address.hpp"
#include "studio/server.hpp"

namespace takt::cli {
namespace {

struct StudioOptions {
  std::string file = "scenario.json";
  std::uint32_t port = 0;
  bool opens = false;
};

/// By the browser of the desktop, which goes on when takt ends.
void open_in_browser(const std::string& page) {
  std::string path = page;
  std::string shell = "sh";
  std::string option = "-c";
  std::string command = "xdg-open \"$1\" >/dev/null 2>&1 &";
  std::array<char*, 6> words = {shell.data(), option.data(), command.data(), shell.data(), path.data(), nullptr};
  pid_t child = 0;
  if (::posix_spawnp(&child, "sh", nullptr, nullptr, words.data(), environ) == 0) ::waitpid(child, nullptr, 0);
}

ExitStatus run(const StudioOptions& options) {
  const studio::Assets assets = studio::built_in_assets();
  if (!assets.is_complete()) {
    std::fputs(
        "takt studio: this takt was built without the page; tools/studio installs what it is made of (npm), builds and "
        "opens it\n",
        stderr);
    return ExitStatus::bad_input;
  }
  std::error_code error;
  if (const auto size = std::filesystem::file_size(options.file, error); !error && size > studio::most_text) {
    std::fprintf(stderr, "takt studio: %s\n", studio::too_large(options.file, size).c_str());
    return ExitStatus::bad_input;
  }
  studio::Document document(options.file);
  std::string problem;
  if (!document.saved(problem) && !problem.empty()) {
    std::fprintf(stderr, "takt studio: cannot read %s\n", problem.c_str());
    return ExitStatus::bad_input;
  }
  studio::Engine engine(options.file);
  studio::Interface interface(engine, document, json::schema<scenario::Scenario>("takt scenario"),
                              path_of_program("takt"));
  // After a crash pages are still open: they are answered at the address that they have, if the port is to be had.
  const studio::AddressMemory memory(options.file);
  const auto before = memory.last();
  const bool comes_back = before && (options.port == 0 || options.port == before->port);
  auto server = std::make_unique<studio::Server>(interface, assets, comes_back ? before->token : studio::new_token());
  if (!comes_back || !server->bind(before->port)) {
    if (comes_back) server = std::make_unique<studio::Server>(interface, assets, studio::new_token());
    if (!server->bind(static_cast<std::uint16_t>(options.port))) {
      std::fprintf(stderr, "takt studio: port %u of 127.0.0.1 is not to be had\n", static_cast<unsigned>(options.port));
      return ExitStatus::bad_input;
    }
  }
  const studio::Address own{server->port(), server->token()};
  memory.keep(own);
  const InterruptGuard interrupt;
  std::printf("%s\n", server->address().c_str());
  std::fflush(stdout);
  if (options.opens) {
    if (const auto door = memory.door(server->address()))
      open_in_browser(*door);
    else
      std::fputs("takt studio: no private folder for the page that a browser opens: open the address by hand\n",
                 stderr);
  }
  // Signals only set a flag, so somebody has to look at it.
  std::jthread watch([&](const std::stop_token& ends) {
    try {
      while (!ends.stop_requested() && !interrupt.requested())
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      interface.stop();
      server->stop();
    } catch (const std::exception&) {
      std::terminate();
    }
  });
  server->listen();
  memory.forget(own);
  return ExitStatus::pass;
}

}  // namespace

void add_studio_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("studio", companion_help("studio"));
  const auto options = std::make_shared<StudioOptions>();
  command.add_option("scenario", options->file, "The scenario; made when it is saved first, if it is not there");
  command.add_option("--port", options->port, "Port of 127.0.0.1")
      .type_name("PORT")
      .default_text("any that is free")
      .between(0u, 65535u);
  command.add_flag("--open", options->opens, "Also open it with xdg-open, which does not see the token");
  command.footer(
      "Prints an address for a browser of this machine, and answers there until Ctrl-C. The address has a token: "
      "whoever has it can do what you can.\n"
      "Examples:\n"
      "  takt studio scenarios/robot-arm.json\n"
      "  takt studio my-plant.json --port 8090\n"
      "Exit status: 0, 2 if the file cannot be read, the port is taken or the page was not built.");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace takt::cli
