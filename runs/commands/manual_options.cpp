// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "base/table.hpp"
#include "runs/commands/command_entry.hpp"
#include "runs/commands/manual.hpp"

#include <fmt/format.h>

#include <memory>

namespace grouser::commands {

namespace {

struct ManualCommand {
  std::string command, folder;
  bool completion = false, markdown = false;
};

void manualCommand(const CLI::App& app, const ManualCommand& c) {
  if (!c.folder.empty()) {
    writeManual(app, c.folder);
    return;
  }
  if (c.completion || c.markdown) {
    fmt::print("{}", c.completion ? bashCompletion(app) : optionsDocument(app));
    return;
  }
  const CLI::App* command = nullptr;
  std::vector<std::string> names;
  for (const CLI::App* each : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(each->get_name());
    if (each->get_name() == c.command) command = each;
  }
  if (!command && !c.command.empty())
    throw base::InputError(fmt::format("manual: \"{}\" is not a command; did you mean \"{}\"?", c.command,
                                       base::nearestWord(c.command, names)));
  fmt::print("{}", manualPage(app, command));
}

} // namespace

void addManual(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<ManualCommand>();
  CLI::App* manual = app.add_subcommand(
      "manual", "Print the manual page of the program or of a command (for man), or the completion script for bash");
  CLI::Option* name =
      manual->add_option("command", command->command, "command to document; default: the whole program");
  CLI::Option* completion =
      manual->add_flag("--completion", command->completion, "print the completion script for bash instead");
  CLI::Option* markdown =
      manual->add_flag("--markdown", command->markdown, "print the options of all commands, as in docs/options.md");
  CLI::Option* folder = manual->add_option("--folder", command->folder,
                                           "write all pages and the completion script below this folder instead");
  completion->excludes(name), folder->excludes(name), folder->excludes(completion);
  markdown->excludes(name), markdown->excludes(completion), markdown->excludes(folder);
  manual->callback([command, &app] { manualCommand(app, *command); });
}

} // namespace grouser::commands
