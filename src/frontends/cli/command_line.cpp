// SPDX-License-Identifier: Apache-2.0
#include "cli/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <sstream>

#include "cli/companion.hpp"
#include "cli/terminal.hpp"
#include "json/document.hpp"
#include "json/node.hpp"
#include "json/suggest.hpp"

namespace takt::cli {

Option Option::required() const {
  option_->required();
  return *this;
}

Option Option::type_name(const std::string& name) const {
  option_->type_name(name);
  return *this;
}

Option Option::default_text(const std::string& text) const {
  option_->default_str(text);
  return *this;
}

Option Option::one_value_each() const {
  option_->allow_extra_args(false);
  return *this;
}

Option Option::delimiter(char between) const {
  option_->delimiter(between);
  return *this;
}

Option Option::excludes(Option other) const {
  option_->excludes(other.option_);
  return *this;
}

Option Option::one_of(const std::vector<std::string>& values) const {
  option_->check(CLI::IsMember(values));
  return *this;
}

Option Option::between(int least, int most) const {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option Option::between(std::uint32_t least, std::uint32_t most) const {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option Option::between(std::uint64_t least, std::uint64_t most) const {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option Option::between(double least, double most) const {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option Option::check(const std::function<std::string(const std::string&)>& mistake) const {
  option_->check(mistake);
  return *this;
}

Command Command::add_subcommand(const std::string& name, const std::string& help) const {
  return Command(*app_->add_subcommand(name, help));
}

Option Command::add_option(const std::string& name, std::string& value, const std::string& help) const {
  return Option(*app_->add_option(name, value, help)->capture_default_str());
}
Option Command::add_option(const std::string& name, std::optional<std::string>& value, const std::string& help) const {
  return Option(*app_->add_option(name, value, help));
}
Option Command::add_option(const std::string& name, std::vector<std::string>& value, const std::string& help) const {
  return Option(*app_->add_option(name, value, help));
}
Option Command::add_option(const std::string& name, int& value, const std::string& help) const {
  return Option(*app_->add_option(name, value, help)->capture_default_str());
}
Option Command::add_option(const std::string& name, double& value, const std::string& help) const {
  return Option(*app_->add_option(name, value, help)->capture_default_str());
}
Option Command::add_option(const std::string& name, std::uint32_t& value, const std::string& help) const {
  return Option(*app_->add_option(name, value, help)->capture_default_str());
}
Option Command::add_option(const std::string& name, std::optional<std::uint32_t>& value,
                           const std::string& help) const {
  return Option(*app_->add_option(name, value, help));
}
Option Command::add_option(const std::string& name, std::uint64_t& value, const std::string& help) const {
  return Option(*app_->add_option(name, value, help)->capture_default_str());
}
Option Command::add_flag(const std::string& name, bool& value, const std::string& help) const {
  return Option(*app_->add_flag(name, value, help));
}

void Command::footer(const std::string& text) const { app_->footer(text); }
void Command::callback(const std::function<void()>& run) const { app_->callback(run); }
void Command::require_subcommand() const { app_->require_subcommand(1); }
bool Command::has_chosen_subcommand() const { return !app_->get_subcommands().empty(); }

namespace {

/// The sub-command that was chosen last: "merge" of "takt study merge".
const CLI::App& chosen(const CLI::App& app) {
  const auto below = app.get_subcommands();
  return below.empty() ? app : chosen(*below.front());
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* const option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& names) {
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  const std::string nearest = json::suggest(word, candidates);
  return nearest.empty() ? "" : " (did you mean \"" + nearest + "\"?)";
}

/// Says the default of an option behind what it is for, where people look for it.
class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text = CLI::Formatter::make_option_opts(option);
    const std::string given = "=" + option->get_default_str();
    const std::size_t at = given.size() > 1 ? text.find(given) : std::string::npos;
    return at == std::string::npos ? text : text.erase(at, given.size());
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    const std::string& given = option->get_default_str();
    return option->get_description() + (given.empty() ? "" : " (default: " + given + ")");
  }
};

/// What man pages and completions are made of: a command, its options, and the commands below it.
json::Node description_of(const CLI::App& app) {
  json::Node node = json::Node::object();
  node.add("name", json::Node::of_string(app.get_name()));
  node.add("help", json::Node::of_string(app.get_description()));
  node.add("footer", json::Node::of_string(app.get_footer()));
  json::Node options = json::Node::array();
  for (const CLI::Option* const option : app.get_options()) {
    json::Node each = json::Node::object();
    each.add("name",
             json::Node::of_string(option->get_positional() ? option->get_name(true) : option->get_name(false, true)));
    each.add("help", json::Node::of_string(option->get_description()));
    each.add("value", json::Node::of_string(option->get_items_expected_max() == 0 ? "" : option->get_type_name()));
    each.add("default", json::Node::of_string(option->get_default_str()));
    each.add("positional", json::Node::of_bool(option->get_positional()));
    options.items.push_back(std::move(each));
  }
  node.add("options", std::move(options));
  json::Node commands = json::Node::array();
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.items.push_back(description_of(*command));
  node.add("commands", std::move(commands));
  return node;
}

/// Adds what the programs of companions say of their commands.
void describe_companions(json::Node& description, std::span<const Companion> elsewhere) {
  json::Node& commands = *description.find("commands");
  for (const Companion& companion : elsewhere) {
    std::erase_if(commands.items, [&](const json::Node& each) { return each.find("name")->text == companion.command; });
    json::Diagnostics diagnostics;
    const std::optional<std::string> said = output_of(companion.program, {"takt", "--describe"});
    const std::optional<json::Document> theirs =
        said ? json::parse(*said, std::string(companion.program), diagnostics) : std::nullopt;
    if (!theirs) continue;
    for (const json::Node& each : theirs->root().find("commands")->items)
      if (each.find("name")->text == companion.command) commands.items.push_back(each);
  }
}

/// An option that no command has, or a word too many.
std::string unexpected(const CLI::App& app) {
  const CLI::App& command = chosen(app);
  const std::vector<std::string> words = app.remaining(true);
  if (words.empty()) return "too many arguments";
  const std::string word = words.front().substr(0, words.front().find('='));
  const std::string suggestion = word.starts_with("-") ? did_you_mean(word, option_names(command)) : "";
  return (&command == &app ? "takt" : command.get_name()) + " does not take " + json::quote(words.front()) + suggestion;
}

}  // namespace

ExitStatus run_command_line(int argc, char** argv, const std::string& help, const std::string& version,
                            const std::string& footer, const std::function<void(Command, ExitStatus&)>& add,
                            std::span<const Companion> elsewhere) {
  CLI::App app(help);
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_version_flag("--version", version);
  app.require_subcommand(1);
  app.footer(footer);
  ExitStatus status = ExitStatus::pass;
  add(Command(app), status);
  for (const Companion& companion : elsewhere) app.add_subcommand(std::string(companion.command), companion.help);
  if (argc == 2 && std::string_view(argv[1]) == "--describe") {
    json::Node description = description_of(app);
    describe_companions(description, elsewhere);
    std::fputs(json::pretty(description).c_str(), stdout);
    return ExitStatus::pass;
  }
  if (argc > 1 && argv[1][0] != '-') {
    const std::vector<std::string> names = command_names(app);
    if (std::find(names.begin(), names.end(), argv[1]) == names.end()) {
      std::fprintf(stderr, "takt: no command is called %s%s\nRun takt --help for all of them.\n",
                   json::quote(argv[1]).c_str(), did_you_mean(argv[1], names).c_str());
      return ExitStatus::bad_input;
    }
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ExtrasError&) {
    std::fprintf(stderr, "takt: %s\nRun takt%s --help for what it takes.\n", unexpected(app).c_str(),
                 &chosen(app) == &app ? "" : (" " + chosen(app).get_name()).c_str());
    return ExitStatus::bad_input;
  } catch (const CLI::ParseError& error) {
    // Help and version are "errors" of the library with status 0.
    std::ostringstream page;
    const bool is_fine = app.exit(error, page, std::cerr) == 0;
    std::fputs(folded(page.str(), page_width()).c_str(), stdout);
    return is_fine ? ExitStatus::pass : ExitStatus::bad_input;
  }
  return status;
}

}  // namespace takt::cli
