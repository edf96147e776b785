// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/exec.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

/// Common parts of all benchmarks.
namespace grouser::bench {

/// Machine, device and program: printed as the first lines of a benchmark, and returned as the head of its JSON.
nlohmann::ordered_json benchOrigin(const char* bench, const base::Exec& exec);

/// Written by the first rank. Throws base::InputError if the file cannot be written; does nothing without a name.
void writeBench(const nlohmann::ordered_json& json, const std::string& path, const base::Comm& comm);

} // namespace grouser::bench
