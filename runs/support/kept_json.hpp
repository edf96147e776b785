// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/kept_files.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace grouser::support {

/// The JSON object that is kept for this origin, whose member "of" is the origin; null if there is none, or if the file
/// is damaged. Throws nothing.
nlohmann::json keptJson(const KeptFiles& files, KeptFiles::Kind kind, const std::string& origin);
/// Keeps an object with this origin as its member "of". A folder or file that cannot be written is not reported.
void keepJson(const KeptFiles& files, KeptFiles::Kind kind, const std::string& origin, nlohmann::json object);

} // namespace grouser::support
