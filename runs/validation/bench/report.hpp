// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/exec.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

/// What all benches have in common.
namespace grouser::bench {

/// Machine, device and program: printed as the first lines of a bench, and returned as the head of its JSON.
nlohmann::ordered_json benchOrigin(const char* bench, const base::Exec& exec);

/// The first rank writes for all. Throws base::InputError where the file cannot be written; does nothing without a
/// name.
void writeBench(const nlohmann::ordered_json& json, const std::string& path, const base::Comm& comm);

} // namespace grouser::bench
