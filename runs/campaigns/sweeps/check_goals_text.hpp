// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_record.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

/// Reports on the bars that --of asks for.
namespace grouser::sweeps {

/// [goals]: figure, bar wanted and reached, parts of the bar, and the seeds that would reach it.
nlohmann::ordered_json goalsJson(const CheckRecord& record);

/// A line a goal for a terminal, with the run time that is still to be expected. Empty without goals.
std::string goalsText(const CheckRecord& record, double percent);

} // namespace grouser::sweeps
