// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

/// Studies of many runs in pieces: results of finished runs are kept, several programs can divide the runs among them,
/// and a call may end before all runs are finished.
namespace grouser::jobs {

/// A part of the runs: "2/8" is every eighth run, starting with the second.
struct Part {
  int number = 1, count = 1;
  bool has(std::size_t run) const { return static_cast<int>(run) % count == number - 1; }
};

/// Options for the part of a study that a call runs.
struct PieceOptions {
  bool resume = false; ///< continue with the runs of earlier calls
  std::string part;    ///< "2/8": every eighth run, starting with the second; empty: all runs
  double seconds = 0;  ///< no run starts after this wall time [s]; 0: no limit
  std::string device = "auto";
  int threads = 1;
  Part share() const; ///< value of `part`
};
void addPieceOptions(CLI::App& app, PieceOptions& options);
/// Adds --device and --threads only.
void addDeviceOptions(CLI::App& app, std::string& device, int& threads);

/// File in a folder with all inputs of its runs: a call with the same inputs continues these runs.
class Recipe {
public:
  Recipe(std::filesystem::path file, std::string text) : file_(std::move(file)), text_(std::move(text)) {}
  bool isThere() const; ///< true if the file exists with exactly this text
  void keep() const;    ///< writes the file; concurrent parts may call it

private:
  std::filesystem::path file_;
  std::string text_;
};

/// A table of numbers with a header line of column names.
struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
  std::size_t column(const std::string& name) const; ///< throws InputError if the column is missing
  std::vector<double> values(const std::string& name) const;
  std::string csv() const;
};

class Pieces {
public:
  /// Makes the folder. `recipe`: all inputs of the runs, stored as recipe.json. Existing runs with the same recipe are
  /// kept unless --force is given. Throws InputError if the folder contains runs with a different recipe, or other
  /// files.
  Pieces(const std::string& study, const StudyPlace& place, const PieceOptions& options,
         const nlohmann::ordered_json& recipe);

  const std::filesystem::path& folder() const { return folder_; }
  bool whole() const { return part_.count == 1; } ///< true if this call does all runs, not a part
  bool has(const std::string& run) const;
  Table read(const std::string& run) const;
  void keep(const std::string& run, const Table& table);
  /// Returns true if this call must do the run: the run belongs to its part, is not finished, and the remaining time
  /// suffices for a run as long as the last one of the same kind (for a new kind: as the longest run). Call once per
  /// run, in the same order in all calls, since this counts the runs. The kind is the run's name up to its last
  /// underscore.
  bool due(const std::string& run);
  /// The same for a run that accompanies the last run of due(): it belongs to the same part and is not counted.
  bool dueBeside(const std::string& run);
  /// For a child process: checks only the remaining time. If the result is true, the run starts now.
  bool inTime(const std::string& run);
  /// Working folder of the run; the next call continues in it if this call is stopped.
  std::filesystem::path begin(const std::string& run) const;
  int left() const { return left_; } ///< number of unfinished runs that were not due

private:
  std::filesystem::path file(const std::string& run) const;

  double spent() const; ///< [s] since this call began

  std::filesystem::path folder_;
  std::map<std::string, double> took_; ///< duration of the last run by kind, in this call [s]
  double began_ = 0;                   ///< start of the current run [s]
  Part part_;
  int seen_ = 0, left_ = 0;
  double seconds_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

} // namespace grouser::jobs
