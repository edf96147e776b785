// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

/// Manual and shell completion, from the tables of `--help`.
namespace grouser::commands {

/// Formats `--help` like the manual.
std::shared_ptr<CLI::Formatter> helpFormatter();

/// A page of section 1, as man(7) reads it. `command`: of `app`'s commands; null: the page of the program itself.
std::string manualPage(const CLI::App& app, const CLI::App* command);

/// docs/options.md: every command with its arguments and options.
std::string optionsDocument(const CLI::App& app);

/// Completion for bash: commands, options, and the values of an option; files elsewhere.
std::string bashCompletion(const CLI::App& app);

/// Writes all pages to folder/man/man1 and the completion to folder/bash-completion/completions. Throws
/// support::NotWritten where a file cannot be written.
void writeManual(const CLI::App& app, const std::filesystem::path& folder);

/// The allowed values of an option, if it has a list of them.
std::vector<std::string> choicesOf(const CLI::Option& option);

} // namespace grouser::commands
