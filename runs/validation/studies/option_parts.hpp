// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

/// Options that several studies have in common.
namespace grouser::studies {

/// Defaults with --quick. Options that the user sets keep their values.
class QuickValues {
public:
  /// Sets `value`, the target of the option, to `quick` with --quick; adds this default to the help of the option.
  template <class T> void instead(CLI::Option* option, T& value, const std::type_identity_t<T>& quick) {
    std::string text;
    if constexpr (std::is_arithmetic_v<T>)
      text = fmt::format("{}", quick);
    else
      text = fmt::format("{}", fmt::join(quick, ", "));
    option->description(option->get_description() + "; " + text + " with --quick");
    values_.push_back([option, &value, quick] {
      if (option->count() == 0) value = quick;
    });
  }
  void take() const {
    for (const auto& value : values_) value();
  }

private:
  std::vector<std::function<void()>> values_;
};

/// Adds --quick, --out and --force. `quick`: help text with the settings of --quick; `name`: name of the study.
void addPlace(CLI::App& app, jobs::StudyPlace& place, const std::string& name, const std::string& quick);
/// Adds an option for a number in [low, high].
CLI::Option* addNumber(CLI::App& app, const std::string& name, double& value, double low, double high,
                       const std::string& help);
/// Throws InputError with the nearest known name if a name is unknown.
void checkCaseNames(const std::vector<std::string>& names, const std::vector<std::string>& known);
/// The cases that --cases names, in the order of `all`; without names, all cases.
template <class Case> std::vector<Case> chosenCases(std::vector<Case> all, const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Case& c : all) known.push_back(c.name);
  checkCaseNames(names, known);
  std::erase_if(all, [&](const Case& c) {
    return !names.empty() && std::find(names.begin(), names.end(), c.name) == names.end();
  });
  return all;
}
/// Adds --seeds.
CLI::Option* addSeeds(CLI::App& app, int& seeds, const std::string& help);
/// Sets the callback of `app`, which runs the study with `command`.
template <class Command>
void doStudy(CLI::App& app, Command& command, void (*study)(const Command&), const QuickValues& quick) {
  app.callback([&command, study, quick] {
    if (command.place.quick) quick.take();
    study(command);
  });
}

} // namespace grouser::studies
