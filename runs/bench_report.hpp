// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/exec.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

/// What all benches have in common.
namespace grouser::runs {

/// Of "auto", "cpu" or "cuda"; throws base::InputError for another word. The ranks of a machine share its GPUs, one for
/// each if there are enough, or its cores, where `threads` is 0.
base::Exec benchExec(const std::string& device, int threads, const base::Ranks* ranks = nullptr);

/// Machine, device and program: printed as the first lines of a bench, and returned as the head of its JSON.
nlohmann::ordered_json benchOrigin(const char* bench, const base::Exec& exec);

/// Throws base::InputError where the file cannot be written; does nothing without a name.
void writeBench(const nlohmann::ordered_json& json, const std::string& path);

} // namespace grouser::runs
