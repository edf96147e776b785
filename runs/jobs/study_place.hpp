// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

/// Common parts of studies: series of runs for one question, such as `grouser study` and the virtual soil tests.
namespace grouser::jobs {

inline constexpr double kGravity = 9.81; ///< gravity in all studies [m/s2]

/// Folder and extent of a study.
struct StudyPlace {
  std::string folder; ///< empty: out/study_NAME
  bool force = false; ///< overwrite results in the folder
  bool quick = false; ///< coarse study that takes seconds
};

/// Makes the folder, and prints a line with machine and commit. Throws InputError if the folder is not writable.
std::filesystem::path beginStudy(const std::string& name, const StudyPlace& place);

/// Writes study.json: study, machine, commit, compiler, seconds taken and `more`.
void writeStudyOrigin(const std::filesystem::path& folder, const std::string& name, double seconds,
                      const nlohmann::ordered_json& more);

/// Mean of values, and standard error of the mean from the scatter of the values.
struct MeanError {
  double mean = 0, error = 0;
};
MeanError meanOf(const std::vector<double>& values);
double medianOf(std::vector<double> values);

/// Throws Stopped after SIGINT, SIGTERM, SIGHUP or SIGUSR1.
void stopStudyOnRequest();

} // namespace grouser::jobs
