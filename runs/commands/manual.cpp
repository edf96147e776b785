// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/manual.hpp"

#include "base/error.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace grouser::commands {

namespace {

std::vector<const CLI::App*> commandsOf(const CLI::App& app) {
  std::vector<const CLI::App*> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) commands.push_back(command);
  return commands;
}

/// Escapes text for roff. Allows line breaks after the commas of a long list of words.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c != ' ' && out.ends_with(',')) out += "\\:";
    if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

/// Names of an option in the manual, e.g. "-h, --help", or the name of a positional argument, e.g. "scene".
std::string namesOf(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true);
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return fmt::format("{}", fmt::join(names, ", "));
}

bool takesValue(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// " INT in 0..1024", " {auto,cpu}": type or values of an option, printed after its name; "" for a flag or an argument.
std::string valueOf(const CLI::Option& option) {
  if (!takesValue(option) || option.get_positional()) return "";
  std::string value = option.get_type_name();
  if (value.empty()) value = "TEXT";
  if (!choicesOf(option).empty()) value = value.substr(value.find('{'));
  std::replace(value.begin(), value.end(), ':', ' '); // separator of type and check in CLI11
  return " " + value + (option.get_expected_max() == CLI::detail::expected_max_vector_size ? " ..." : "");
}

/// " (not with --start)": options that an option requires or excludes.
std::string othersText(const char* relation, const std::set<CLI::Option*>& options) {
  std::set<std::string> names;
  for (const CLI::Option* option : options) names.insert(option->get_name());
  return names.empty() ? "" : fmt::format(" ({} {})", relation, fmt::join(names, ", "));
}

/// Description of an option, as in --help.
std::string descriptionOf(const CLI::Option& option) {
  std::string text = option.get_description();
  if (!option.get_default_str().empty()) text += fmt::format(" (default: {})", option.get_default_str());
  if (option.get_required() && !option.get_positional()) text += " (required)";
  return text + othersText("only with", option.get_needs()) + othersText("not with", option.get_excludes());
}

/// Formatter of --help that uses the names, values and descriptions of the manual.
class HelpFormatter : public CLI::Formatter {
  std::string make_option_name(const CLI::Option* option, bool) const override { return namesOf(*option); }
  std::string make_option_opts(const CLI::Option* option) const override { return valueOf(*option); }
  std::string make_option_desc(const CLI::Option* option) const override { return descriptionOf(*option); }
};

std::string optionText(const CLI::Option& option) {
  const std::string value = roff(valueOf(option));
  return fmt::format(".TP\n\\f{}{}\\fR{}\n{}\n", option.get_positional() ? 'I' : 'B', roff(namesOf(option)),
                     value.empty() ? "" : "\\fI" + value + "\\fR", roff(descriptionOf(option)));
}

std::string optionsText(const CLI::App& app, bool positional) {
  std::string text;
  for (const CLI::Option* option : app.get_options())
    if (option->get_positional() == positional) text += optionText(*option);
  return text;
}

/// "grouser run [OPTIONS] scene".
std::string synopsis(const CLI::App& app, const std::string& path) {
  std::string text = fmt::format("\\fB{}\\fR [\\fIOPTIONS\\fR]", roff(path));
  for (const CLI::Option* option : app.get_options())
    if (option->get_positional()) {
      const std::string name = "\\fI" + roff(option->get_name(true)) + "\\fR";
      text += option->get_required() ? " " + name : " [" + name + "]";
    }
  if (!commandsOf(app).empty()) text += " \\fICOMMAND\\fR ...";
  return text + "\n";
}

/// Arguments, options and commands of `app`, then those of each command.
std::string sectionsOf(const CLI::App& app, const std::string& path, const char* heading) {
  const std::string words = optionsText(app, true), options = optionsText(app, false);
  std::string text;
  if (!words.empty()) text += fmt::format("{} ARGUMENTS\n{}", heading, words);
  if (!options.empty()) text += fmt::format("{} OPTIONS\n{}", heading, options);
  for (const CLI::App* command : commandsOf(app)) {
    const std::string name = path + " " + command->get_name();
    text += fmt::format(".SH {}\n{}\n.PP\n{}", roff(upper(name)), roff(command->get_description()),
                        synopsis(*command, name));
    text += sectionsOf(*command, name, ".SS");
  }
  return text;
}

/// Escapes text for a cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? "\\|" : std::string(1, c);
  return out;
}

/// Heading, arguments and options of all commands and subcommands of `app`.
std::string commandsInMarkdown(const CLI::App& app, const std::string& path) {
  std::string text;
  for (const CLI::App* command : commandsOf(app)) {
    const std::string name = path + " " + command->get_name();
    text += fmt::format("\n## {0}\n\n| `{0}` | {1} |\n|---|---|\n", name, cell(command->get_description()));
    for (const CLI::Option* option : command->get_options()) {
      if (option == command->get_help_ptr()) continue;
      text += fmt::format("| `{}{}` | {} |\n", namesOf(*option), valueOf(*option), cell(descriptionOf(*option)));
    }
    text += commandsInMarkdown(*command, name);
  }
  return text;
}

std::string head(const std::string& name, const std::string& description) {
  return fmt::format(
      ".\\\" Written by `grouser manual`.\n.TH {} 1 \"\" \"grouser {}\" \"User Commands\"\n.ad l\n.SH NAME\n{} "
      "\\- {}\n",
      roff(upper(name)), support::buildInfo().version, roff(name), roff(description));
}

constexpr const char* kEnvironment =
    ".SH ENVIRONMENT\n.TP\n\\fBGROUSER_CACHE\\fR, \\fBGROUSER_CACHE_GIB\\fR\ncache folder of settled beds and sphere "
    "sets, and its maximum size in GiB\n.TP\n\\fBGROUSER_GPU\\fR\nindex of the first GPU to use, counted from 0; MPI "
    "ranks and concurrent runs use this and the following GPUs in turn\n.TP\n\\fBGROUSER_SHARE\\fR\nfolder of assets "
    "and plot scripts that replaces the installed one\n";

/// Completions of all options and subcommands of a command such as "run" or "bench bed".
void addCases(const CLI::App& app, const std::string& path, std::string& text) {
  std::vector<std::string> words;
  for (const CLI::App* command : commandsOf(app)) words.push_back(command->get_name());
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  text += fmt::format("    \"{}\") words=\"{}\" ;;\n", path, fmt::join(words, " "));
  for (const CLI::App* command : commandsOf(app))
    addCases(*command, path.empty() ? command->get_name() : path + " " + command->get_name(), text);
}

void addChoices(const CLI::App& app, const std::string& path, std::string& text) {
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) {
      if (!takesValue(*option)) continue;
      const std::vector<std::string> choices = choicesOf(*option);
      text +=
          fmt::format("    \"{} --{}\") {} ;;\n", path, name,
                      choices.empty() ? std::string("return") : fmt::format("words=\"{}\"", fmt::join(choices, " ")));
    }
  for (const CLI::App* command : commandsOf(app))
    addChoices(*command, path.empty() ? command->get_name() : path + " " + command->get_name(), text);
}

} // namespace

std::vector<std::string> choicesOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t from = type.find('{'), to = type.find('}');
  std::vector<std::string> choices;
  if (from == std::string::npos || to == std::string::npos) return choices;
  for (std::size_t at = from + 1; at < to;) {
    const std::size_t end = std::min(type.find(',', at), to);
    choices.push_back(type.substr(at, end - at));
    at = end + 1;
  }
  return choices;
}

std::shared_ptr<CLI::Formatter> helpFormatter() { return std::make_shared<HelpFormatter>(); }

std::string manualPage(const CLI::App& app, const CLI::App* command) {
  if (command) {
    const std::string name = "grouser-" + command->get_name(), path = "grouser " + command->get_name();
    return head(name, command->get_description()) + ".SH SYNOPSIS\n" + synopsis(*command, path) +
           sectionsOf(*command, path, ".SH") + ".SH SEE ALSO\n\\fBgrouser\\fR(1)\n";
  }
  std::string text = head("grouser", app.get_description()) + ".SH SYNOPSIS\n" + synopsis(app, "grouser") +
                     ".SH OPTIONS\n" + optionsText(app, false) + ".SH COMMANDS\n";
  for (const CLI::App* each : commandsOf(app))
    text += fmt::format(".TP\n\\fBgrouser\\-{}\\fR(1)\n{}\n", roff(each->get_name()), roff(each->get_description()));
  return text + ".SH NOTES\n" + roff(app.get_footer()) + "\n" + kEnvironment;
}

std::string optionsDocument(const CLI::App& app) {
  return "<!-- Written by `grouser manual --markdown > docs/options.md`: change the commands in the source, not this "
         "file. -->\n# Options\n\nArguments and options of all commands, as printed by `--help`. See "
         "[commands.md](commands.md) for an overview.\n" +
         commandsInMarkdown(app, "grouser");
}

std::string bashCompletion(const CLI::App& app) {
  std::string commands, choices;
  addCases(app, "", commands);
  addChoices(app, "", choices);
  return fmt::format(R"(# Written by `grouser manual --completion`.
_grouser() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} path="" words="" word
  COMPREPLY=()
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case "$path${{path:+ }}$word" in
      {}) path="$path${{path:+ }}$word" ;;
    esac
  done
  # The values of an option; return: bash completes files.
  case "$path $previous" in
{}  esac
  [ -z "$words" ] && case "$path" in
{}  esac
  # Options where one is begun; elsewhere commands and the words of an option, else bash completes files.
  COMPREPLY=($(compgen -W "$words" -- "$current"))
  [[ $current == -* ]] || COMPREPLY=($(printf '%s\n' "${{COMPREPLY[@]}}" | grep -v '^-'))
}}
complete -o bashdefault -o default -F _grouser grouser
)",
                     [&] {
                       std::vector<std::string> paths;
                       for (const CLI::App* command : commandsOf(app)) {
                         paths.push_back('"' + command->get_name() + '"');
                         for (const CLI::App* inner : commandsOf(*command))
                           paths.push_back('"' + command->get_name() + " " + inner->get_name() + '"');
                       }
                       return fmt::format("{}", fmt::join(paths, " | "));
                     }(),
                     choices, commands);
}

void writeManual(const CLI::App& app, const std::filesystem::path& folder) {
  const std::filesystem::path pages = folder / "man/man1", completions = folder / "bash-completion/completions";
  for (const std::filesystem::path& made : {pages, completions})
    if (std::error_code error; std::filesystem::create_directories(made, error), error)
      throw base::InputError(fmt::format("{}: cannot create the folder ({}); choose another with --folder",
                                         made.string(), error.message()));
  support::replaceTextFile(pages / "grouser.1", manualPage(app, nullptr));
  for (const CLI::App* command : commandsOf(app))
    support::replaceTextFile(pages / ("grouser-" + command->get_name() + ".1"), manualPage(app, command));
  support::replaceTextFile(completions / "grouser", bashCompletion(app));
}

} // namespace grouser::commands
