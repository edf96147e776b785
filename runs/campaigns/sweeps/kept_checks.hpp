// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "runs/setup/provenance.hpp"

#include <nlohmann/json_fwd.hpp>

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
/// with selected figures (`ofSome`) does not replace one with all figures. Ignores write errors.
void keepCheck(const std::string& origin, const std::string& json, int runs, bool ofSome,
               const std::filesystem::path& folder);

/// Lines for the end of a run of this scene: contents of its error bars if a check is stored or comes with the program,
/// with the figures if `listed`; else the estimated time of `grouser check`. `runSeconds`: time of the run's steps and
/// preparation.
std::string checkNote(const scene::Scene& scene, const std::string& inputs, double runSeconds, bool listed = true);

/// Check of this scene with these inputs that the user has run, or else that comes with the program: check.json as
/// `check`, its place as `folder`. Null if there is none.
nlohmann::json keptCheck(const scene::Scene& scene, const std::string& inputs);

/// Throws InputError if the folder contains other files with the names of a check's files.
void checkFolderOfCheck(const std::filesystem::path& folder);

} // namespace grouser::sweeps
