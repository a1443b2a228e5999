// SPDX-License-Identifier: Apache-2.0
// The command line as the sub-commands see it. CLI11, all templates, is seen by command_line.cpp only: in each
// sub-command it cost more to compile than all the rest.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/exit_status.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace takt::cli {

/// One option, flag or position of a sub-command. A handle; what it names lives as long as the command line.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option required() const;
  /// What stands for the value in the help.
  Option type_name(const std::string& name) const;
  /// What the help says of the default, where that is no value: "one for each processor".
  Option default_text(const std::string& text) const;
  /// Of lists: each occurrence takes one value.
  Option one_value_each() const;
  Option delimiter(char between) const;
  Option excludes(Option other) const;
  Option one_of(const std::vector<std::string>& values) const;
  /// Both ends are allowed.
  Option between(int least, int most) const;
  Option between(std::uint32_t least, std::uint32_t most) const;
  Option between(std::uint64_t least, std::uint64_t most) const;
  Option between(double least, double most) const;
  /// `mistake` says what is wrong with a value; an empty text: nothing.
  Option check(const std::function<std::string(const std::string&)>& mistake) const;

 private:
  CLI::Option* option_;
};

/// A sub-command. A handle, as above. What options write to outlives the command line.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  Command add_subcommand(const std::string& name, const std::string& help) const;
  /// The help shows what the value is before: the default, unless that is an empty text.
  Option add_option(const std::string& name, std::string& value, const std::string& help) const;
  Option add_option(const std::string& name, std::optional<std::string>& value, const std::string& help) const;
  Option add_option(const std::string& name, std::vector<std::string>& value, const std::string& help) const;
  Option add_option(const std::string& name, int& value, const std::string& help) const;
  Option add_option(const std::string& name, double& value, const std::string& help) const;
  Option add_option(const std::string& name, std::uint32_t& value, const std::string& help) const;
  Option add_option(const std::string& name, std::optional<std::uint32_t>& value, const std::string& help) const;
  Option add_option(const std::string& name, std::uint64_t& value, const std::string& help) const;
  Option add_flag(const std::string& name, bool& value, const std::string& help) const;
  /// Below the options in the help.
  void footer(const std::string& text) const;
  void callback(const std::function<void()>& run) const;
  void require_subcommand() const;
  /// Whether one of its own sub-commands was chosen.
  bool has_chosen_subcommand() const;

 private:
  CLI::App* app_;
};

struct Companion;

/// Parses the command line and runs one of the sub-commands that `add` has added; they set the status. Help and
/// mistakes are printed here. --describe alone prints all commands and options as JSON, of which tools/manuals makes
/// man pages and completions. The sub-commands `elsewhere` appear in the help, and in the description with what their
/// programs say.
ExitStatus run_command_line(int argc, char** argv, const std::string& help, const std::string& version,
                            const std::string& footer, const std::function<void(Command, ExitStatus&)>& add,
                            std::span<const Companion> elsewhere);

}  // namespace takt::cli
