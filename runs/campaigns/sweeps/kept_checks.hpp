// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "runs/setup/provenance.hpp"

#include <filesystem>
#include <string>

/// The last check of each scene, stored beside settled beds, for the error bars of later runs.
namespace grouser::sweeps {

/// Text that identifies everything that determines the results of a scene, with the contents of its files (`inputs`,
/// see setup::inputsOf()), without seed, output and machine.
std::string checkOrigin(scene::Scene scene, const std::string& inputs);

/// Hash of an origin without the place where the program's files are installed.
std::string originHash(std::string origin);

/// Stores check.json of `folder`, from `runs` runs, unless a check of more runs by the same commit is stored. A check
/// of some figures (`ofSome`) does not replace one of all. Ignores write errors.
void keepCheck(const std::string& origin, const std::string& json, int runs, bool ofSome,
               const std::filesystem::path& folder);

/// Lines for the end of a run of this scene, whose steps and preparation took `runSeconds`: what its error bars contain
/// if a check is stored or comes with the program, with the figures if `listed`; else the estimated time of `grouser
/// check`.
std::string checkNote(const scene::Scene& scene, const std::string& inputs, double runSeconds, bool listed = true);

/// Stored check of this scene with these inputs as JSON: check.json as `check`, its folder as `folder`. Empty if there
/// is none.
std::string keptCheckText(const scene::Scene& scene, const std::string& inputs);

/// Throws InputError if the folder contains other files with the names of a check's files.
void checkFolderOfCheck(const std::filesystem::path& folder);

} // namespace grouser::sweeps
