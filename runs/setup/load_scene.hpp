// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace grouser::setup {

/// Reads a scene and checks it as far as possible without building it. Throws base::InputError with file, line, key,
/// value, range and remedy.
scene::Scene loadScene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
/// The same from text; paths in it are relative to the folder of `file`.
scene::Scene parseScene(std::string_view text, const std::filesystem::path& file,
                        const std::vector<std::string>& overrides = {});

} // namespace grouser::setup
