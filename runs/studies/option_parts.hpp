// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/studies/common.hpp"

#include <CLI/CLI.hpp>

#include <string>

/// Options that several studies have.
namespace grouser::studies {

/// --quick, --out and --force; `quick` is the help of the first, `name` the study's.
void addPlace(CLI::App& app, StudyPlace& place, const std::string& name, const std::string& quick);
/// A number in [low, high].
CLI::Option* addNumber(CLI::App& app, const std::string& name, double& value, double low, double high,
                       const std::string& help);
/// --seeds
void addSeeds(CLI::App& app, int& seeds, const std::string& help);

} // namespace grouser::studies
