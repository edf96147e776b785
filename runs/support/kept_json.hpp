// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/kept_files.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace grouser::support {

/// The cached JSON object for this origin; its member "of" is the origin. Null if there is none or the file is damaged.
/// Does not throw.
nlohmann::json keptJson(const KeptFiles& files, KeptFiles::Kind kind, const std::string& origin);
/// Caches an object with this origin as its member "of". Ignores a folder or file that cannot be written.
void keepJson(const KeptFiles& files, KeptFiles::Kind kind, const std::string& origin, nlohmann::json object);

} // namespace grouser::support
