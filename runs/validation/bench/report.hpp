// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/exec.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

/// Common parts of all benchmarks.
namespace grouser::bench {

/// Prints device, machine and program as the first lines of a benchmark, and returns them as the start of its JSON.
nlohmann::ordered_json benchOrigin(const char* bench, const base::Exec& exec);

/// Writes a JSON file on the first rank; does nothing if `path` is empty. Throws base::InputError if it cannot write.
void writeBench(const nlohmann::ordered_json& json, const std::string& path, const base::Comm& comm);

} // namespace grouser::bench
