// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_report.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// Figures of a set of events beside those of another, such as of the same soil as grains.
namespace grouser::events {

/// The mean of a figure over the runs of a level. Without seeds and draws its interval is 0.
struct LevelFigure {
  Event event{};
  double level = 0;
  std::string name; ///< with its unit
  support::Estimate estimate;
};

/// Events that an earlier call has left in a folder.
struct OtherEvents {
  std::filesystem::path folder;
  std::string vehicle, ground; ///< "light_tracked"; "lete_sand (granular)"
  std::vector<LevelFigure> figures;
};

/// Reads events.json of a folder. Throws base::InputError where there is none, or one that is damaged.
OtherEvents readOtherEvents(const std::filesystem::path& folder);

/// A figure of both.
struct FigureBeside {
  LevelFigure here, other;
  support::Estimate difference; ///< here - other; its half width is the root of the sum of both squares
  std::string verdict;          ///< "equal", "differs", "inconclusive", by a bar in percent of the larger mean
};

/// What both have, in the order of `here`.
std::vector<FigureBeside> besides(const std::vector<LevelFigure>& here, const OtherEvents& other, double percent);

/// The figures of these rows. `random`: with seeds or draws.
std::vector<LevelFigure> figuresOf(const std::vector<EventRow>& rows, bool random);

std::string besidesText(const std::vector<FigureBeside>& figures, const std::string& here, const OtherEvents& other,
                        double percent);
/// A row for each figure; `head`: with the line of names.
std::string besidesCsv(const std::vector<FigureBeside>& figures, const OtherEvents& other, bool head);

} // namespace grouser::events
