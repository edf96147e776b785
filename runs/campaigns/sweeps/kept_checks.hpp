// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "runs/setup/provenance.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

/// Storage of the last check of each scene in the cache folder, for the error bars of later runs.
namespace grouser::sweeps {

/// Text of everything that determines the results of a scene, with the contents of its input files (`inputs`, see
/// setup::inputsOf()). Excludes seed, output settings and machine.
std::string checkOrigin(scene::Scene scene, const std::string& inputs);

/// Hash of an origin; does not depend on the folder in which the program is installed.
std::string originHash(std::string origin);

/// Stores check.json of `folder`, computed from `runs` runs, unless the stored check is by the same commit and has more
/// runs. A check of selected figures (`ofSome`) does not replace a check of all figures. Ignores write errors.
void keepCheck(const std::string& origin, const std::string& json, int runs, bool ofSome,
               const std::filesystem::path& folder);

/// Lines printed at the end of a run: if keptCheck() finds a check, the contributions to its error bars, and if
/// `listed` its figures; otherwise the command and estimated time of a check. `runSeconds`: wall time of the run's
/// preparation and steps.
std::string checkNote(const scene::Scene& scene, const std::string& inputs, double runSeconds, bool listed = true);

/// Last check of this scene with these inputs, by the user or else installed with the program: `check` is the data
/// from check.json, `folder` its location. Null if there is no check.
nlohmann::json keptCheck(const scene::Scene& scene, const std::string& inputs);

/// Throws InputError if the folder contains files that have names of check files but were not written by a check.
void checkFolderOfCheck(const std::filesystem::path& folder);

} // namespace grouser::sweeps
