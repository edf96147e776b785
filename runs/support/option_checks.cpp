// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/option_checks.hpp"

#include "base/table.hpp"
#include "runs/support/output_place.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

namespace grouser::support {

namespace {

/// The number that `text` consists of; empty if it is not a number.
template <class T> std::optional<T> numberIn(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Accepts texts for which `isAllowed` is true; `allowed` describes them.
template <class Test> CLI::Validator check(const std::string& allowed, const std::string& shown, Test isAllowed) {
  return {[=](std::string& text) {
            return isAllowed(text) ? std::string() : fmt::format("{} is not {}", text.empty() ? "\"\"" : text, allowed);
          },
          shown};
}

} // namespace

CLI::Validator wholeNumber(std::int64_t low, std::int64_t high) {
  const bool isOpen = high == std::numeric_limits<std::int64_t>::max();
  const std::string range = isOpen ? fmt::format("of at least {}", low) : fmt::format("from {} to {}", low, high);
  return check("a whole number " + range, isOpen ? fmt::format(">= {}", low) : fmt::format("in {}..{}", low, high),
               [=](const std::string& text) {
                 const auto n = numberIn<std::int64_t>(text);
                 return n && *n >= low && *n <= high;
               });
}

CLI::Validator orItsFolder(const std::string& file) {
  return {[=](std::string& text) {
            std::error_code error;
            if (std::filesystem::is_directory(text, error)) text = (std::filesystem::path(text) / file).string();
            return std::string();
          },
          ""};
}

CLI::Validator writableFile(const std::string& option) {
  return {[option](const std::string& text) {
            try {
              requireFile(text, option);
            } catch (const base::InputError& error) {
              return std::string(error.what());
            }
            return std::string();
          },
          ""};
}

CLI::Option* addOut(CLI::App& app, std::string& place, const std::string& help) {
  return app.add_option("--out,--output", place, help);
}

CLI::Validator positive(const std::string& what) {
  return check(what + " above 0", "> 0", [](const std::string& text) {
    const auto x = numberIn<double>(text);
    return x && std::isfinite(*x) && *x > 0;
  });
}

CLI::Validator percentSign() {
  return {[](std::string& text) {
            if (text.ends_with('%')) text.pop_back();
            while (text.ends_with(' ')) text.pop_back();
            return std::string();
          },
          ""};
}

CLI::Validator notNegative(const std::string& what) {
  return check(what + " of at least 0", ">= 0", [](const std::string& text) {
    const auto x = numberIn<double>(text);
    return x && std::isfinite(*x) && *x >= 0;
  });
}

CLI::Validator between(double low, double high) {
  return check(fmt::format("a number in [{:g}, {:g}]", low, high), fmt::format("in {:g}..{:g}", low, high),
               [low, high](const std::string& text) {
                 const auto x = numberIn<double>(text);
                 return x && *x >= low && *x <= high; // false for nan
               });
}

void refuseOptionsAsValues(CLI::App& app) {
  for (CLI::Option* option : app.get_options())
    if (option->get_items_expected_min() > 0)
      option->transform(CLI::Validator(
          [&app](const std::string& text) {
            const bool isOption = text.starts_with('-') && app.get_option_no_throw(text.substr(0, text.find('=')));
            return isOption ? fmt::format("requires a value, but is followed by the option {}; add a value", text)
                            : std::string();
          },
          ""));
  for (CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) refuseOptionsAsValues(*sub);
}

std::string unknownCommand(const CLI::App& app, int argc, const char* const* argv) {
  const CLI::App* level = &app;
  std::string path;
  for (int i = 1; i < argc && level->get_require_subcommand_min() > 0; ++i) {
    const std::string word = argv[i];
    if (word.empty() || word[0] == '-') break;
    const CLI::App* next = nullptr;
    std::vector<std::string> names;
    for (const CLI::App* sub : level->get_subcommands([](const CLI::App*) { return true; })) {
      names.push_back(sub->get_name());
      if (names.back() == word) next = sub;
    }
    if (!next)
      return fmt::format("\"{}{}\" is not a command; did you mean \"{}{}\"? See grouser{} --help", path, word, path,
                         base::nearestWord(word, names), path.empty() ? "" : " " + path.substr(0, path.size() - 1));
    path += word + " ";
    level = next;
  }
  return "";
}

std::string nearestOptionHint(const CLI::App& app, int argc, const char* const* argv) {
  const auto all = [](const CLI::App*) { return true; };
  const CLI::App* level = &app;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i], option = word.substr(0, word.find('='));
    if (!word.starts_with("--")) {
      if (level->get_require_subcommand_min() > 0)
        for (const CLI::App* sub : level->get_subcommands(all))
          if (sub->get_name() == word) level = sub;
      continue;
    }
    if (level->get_option_no_throw(option)) continue;
    std::vector<std::string> owners;
    for (const CLI::App* sub : app.get_subcommands(all))
      if (sub->get_option_no_throw(option)) owners.push_back(sub->get_name());
    std::vector<std::string> names;
    for (const CLI::Option* o : level->get_options())
      for (const std::string& name : o->get_lnames()) names.push_back("--" + name);
    const std::string nearest = base::nearestWord(option, names);
    const int edits = nearest.empty() ? std::numeric_limits<int>::max() : base::editDistance(option, nearest);
    const bool isCut = !nearest.empty() && (nearest.starts_with(option) || option.starts_with(nearest));
    // One letter is a slip; more may be an option of another command.
    if (!owners.empty() && edits > 1 && !isCut)
      return fmt::format("; {} is an option of: {}", option, fmt::join(owners, ", "));
    return isCut || edits <= 1 + static_cast<int>(option.size()) / 4 ? fmt::format("; did you mean {}?", nearest) : "";
  }
  return "";
}

} // namespace grouser::support
