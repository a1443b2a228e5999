#include "cli/command_line.hpp"

#include <CLI/CLI.hpp>

namespace takt::cli {

Option Option::required() const {
  option_->required();
  return *this;
}

Option Option::type_name(const std::string& name) const {
  option_->type_name(name);
  return *this;
}

Option Option::default_in_help() const {
  option_->capture_default_str();
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

Command Command::add_subcommand(const std::string& name, const std::string& help) const { return Command(*app_->add_subcommand(name, help)); }

Option Command::add_option(const std::string& name, std::string& value, const std::string& help) const { return Option(*app_->add_option(name, value, help)); }
Option Command::add_option(const std::string& name, std::optional<std::string>& value, const std::string& help) const {
  return Option(*app_->add_option(name, value, help));
}
Option Command::add_option(const std::string& name, std::vector<std::string>& value, const std::string& help) const {
  return Option(*app_->add_option(name, value, help));
}
Option Command::add_option(const std::string& name, int& value, const std::string& help) const { return Option(*app_->add_option(name, value, help)); }
Option Command::add_option(const std::string& name, double& value, const std::string& help) const { return Option(*app_->add_option(name, value, help)); }
Option Command::add_option(const std::string& name, std::uint32_t& value, const std::string& help) const { return Option(*app_->add_option(name, value, help)); }
Option Command::add_option(const std::string& name, std::optional<std::uint32_t>& value, const std::string& help) const {
  return Option(*app_->add_option(name, value, help));
}
Option Command::add_option(const std::string& name, std::uint64_t& value, const std::string& help) const { return Option(*app_->add_option(name, value, help)); }
Option Command::add_flag(const std::string& name, bool& value, const std::string& help) const { return Option(*app_->add_flag(name, value, help)); }

void Command::footer(const std::string& text) const { app_->footer(text); }
void Command::callback(const std::function<void()>& run) const { app_->callback(run); }
void Command::require_subcommand() const { app_->require_subcommand(1); }
bool Command::has_chosen_subcommand() const { return !app_->get_subcommands().empty(); }

ExitStatus run_command_line(int argc, char** argv, const std::string& help, const std::string& version, const std::string& footer,
                            const std::function<void(Command, ExitStatus&)>& add) {
  CLI::App app(help);
  app.set_version_flag("--version", version);
  app.require_subcommand(1);
  app.footer(footer);
  ExitStatus status = ExitStatus::pass;
  add(Command(app), status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // Help and version are "errors" of the library with status 0.
    return app.exit(error) == 0 ? ExitStatus::pass : ExitStatus::bad_input;
  }
  return status;
}

}  // namespace takt::cli
