// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_record.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

/// Reports on the target error bars of --of.
namespace grouser::sweeps {

/// [goals]: figure, target bar, actual bar and its parts, and the numbers of seeds that would reach the target.
nlohmann::ordered_json goalsJson(const CheckRecord& record);

/// One line per goal for the terminal, with the expected remaining run time. Empty without goals.
std::string goalsText(const CheckRecord& record, double percent);

} // namespace grouser::sweeps
