// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "runs/setup/provenance.hpp"

#include <filesystem>
#include <string>

/// The last check of each scene, kept beside settled beds, so that a later run can say how far its figures hold.
namespace grouser::sweeps {

/// What decides a scene's results, the bytes of the files that it names with it (`inputs`, see setup::inputsOf()), as
/// text; seed, output and machine aside.
std::string checkOrigin(scene::Scene scene, const std::string& inputs);

/// Keeps check.json of `folder` for later runs, made of so many of them, unless one of more runs by the same commit is
/// kept. One of `ofSome` figures, which may leave axes out, does not replace one of all. Nothing is said where it
/// cannot be kept.
void keepCheck(const std::string& origin, const std::string& json, int runs, bool ofSome,
               const std::filesystem::path& folder);

/// For the end of a run of this scene with these inputs, whose steps and preparation took `runSeconds`: figures with
/// their bars where it has been checked, else how long `grouser check` would take. Whole lines.
std::string checkNote(const scene::Scene& scene, const std::string& inputs, double runSeconds);

/// The check that is kept of this scene with these inputs, as JSON: check.json as `check`, its folder as `folder`.
/// Empty where it has not been checked.
std::string keptCheckText(const scene::Scene& scene, const std::string& inputs);

/// Throws InputError where the folder holds files of other origin in the places of a check's.
void checkFolderOfCheck(const std::filesystem::path& folder);

} // namespace grouser::sweeps
