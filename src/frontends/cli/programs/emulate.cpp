// SPDX-License-Identifier: Apache-2.0
#include "cli/program.hpp"

int main(int argc, char** argv) { return takt::cli::run_companion(argc, argv, {takt::cli::add_emulate_command}); }
