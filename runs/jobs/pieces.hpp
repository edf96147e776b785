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

/// Studies of many runs, in pieces: each finished run is kept, several programs may share them, and a call may end
/// before all are there.
namespace grouser::jobs {

/// A share of the runs: of "2/8" every eighth, from the second on.
struct Part {
  int number = 1, count = 1;
  bool has(std::size_t run) const { return static_cast<int>(run) % count == number - 1; }
};

/// Share of a study that a call runs.
struct PieceOptions {
  bool resume = false; ///< continue with the runs of earlier calls
  std::string part;    ///< "2/8": every eighth run, from the second on; empty: all
  double seconds = 0;  ///< no run starts after this wall time [s]; 0: no limit
  std::string device = "auto";
  int threads = 1;
  Part share() const; ///< as `part` says
};
void addPieceOptions(CLI::App& app, PieceOptions& options);
/// --device and --threads alone.
void addDeviceOptions(CLI::App& app, std::string& device, int& threads);

/// File with all inputs of the runs in a folder: a call with the same text continues them.
class Recipe {
public:
  Recipe(std::filesystem::path file, std::string text) : file_(std::move(file)), text_(std::move(text)) {}
  bool isThere() const; ///< with exactly this text
  void keep() const;    ///< several concurrent parts may call it

private:
  std::filesystem::path file_;
  std::string text_;
};

/// A table of numbers with a line of names.
struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
  std::size_t column(const std::string& name) const; ///< throws InputError where there is none
  std::vector<double> values(const std::string& name) const;
  std::string csv() const;
};

class Pieces {
public:
  /// Makes the folder. `recipe`: all that the runs depend on; kept as recipe.json. Runs of the same recipe are kept,
  /// unless --force is given. Throws InputError where the folder holds those of another, or other files.
  Pieces(const std::string& study, const StudyPlace& place, const PieceOptions& options,
         const nlohmann::ordered_json& recipe);

  const std::filesystem::path& folder() const { return folder_; }
  bool whole() const { return part_.count == 1; } ///< this call is to do all runs, not a part
  bool has(const std::string& run) const;
  Table read(const std::string& run) const;
  void keep(const std::string& run, const Table& table);
  /// Whether this call is to do the run: it belongs to its part, is not there yet, and the time left suffices for the
  /// last run of its kind (for a new kind: the longest of all). Counts the runs: called once for each, in the same
  /// order in all calls. The kind is the run's name up to its last underscore.
  bool due(const std::string& run);
  /// The same for a run that accompanies the last one of due(): of the same part, and not counted.
  bool dueBeside(const std::string& run);
  /// Checks the time only, for a child process; if true, the run starts now.
  bool inTime(const std::string& run);
  /// Working folder of the run, which a stopped call leaves to the next.
  std::filesystem::path begin(const std::string& run) const;
  int left() const { return left_; } ///< runs seen that were not there and not due

private:
  std::filesystem::path file(const std::string& run) const;

  double spent() const; ///< [s] since this call began

  std::filesystem::path folder_;
  std::map<std::string, double> took_; ///< [s] by kind, in this call
  double began_ = 0;                   ///< [s] the run that is under way
  Part part_;
  int seen_ = 0, left_ = 0;
  double seconds_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

} // namespace grouser::jobs
