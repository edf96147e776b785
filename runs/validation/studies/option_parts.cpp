// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/option_parts.hpp"

#include "base/error.hpp"
#include "base/table.hpp"
#include "runs/support/option_checks.hpp"

#include <fmt/ranges.h>

namespace grouser::studies {

void addPlace(CLI::App& app, jobs::StudyPlace& place, const std::string& name, const std::string& quick) {
  app.add_flag("--quick", place.quick, "quick run: " + quick);
  support::addOut(app, place.folder, "output folder for tables and plot; default: out/study_" + name);
  app.add_flag("--force", place.force, "overwrite the contents of the output folder");
}

CLI::Option* addNumber(CLI::App& app, const std::string& name, double& value, double low, double high,
                       const std::string& help) {
  return app.add_option(name, value, help)->check(support::between(low, high))->capture_default_str();
}

void checkCaseNames(const std::vector<std::string>& names, const std::vector<std::string>& known) {
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw base::InputError(fmt::format("--cases {}: unknown case; did you mean {}? (cases: {})", name,
                                         base::nearestWord(name, known), fmt::join(known, ", ")));
}

CLI::Option* addSeeds(CLI::App& app, int& seeds, const std::string& help) {
  return app.add_option("--seeds", seeds, help)->check(support::wholeNumber(2, 1000))->capture_default_str();
}

} // namespace grouser::studies
