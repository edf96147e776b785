// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/trial_files.hpp"

#include "base/error.hpp"
#include "runs/support/text_file.hpp"

#include <fstream>
#include <utility>

namespace grouser::studies {

namespace fs = std::filesystem;

namespace {

/// Each run is stored as a table of numbers; a file contains the messages.
jobs::Table tableOf(const std::vector<VehicleTrial>& trials) {
  jobs::Table table;
  table.names = {"step [s]", "end", "reached [s]", "wall [s]", "cause"};
  for (const FigureColumn& c : kTrialFigures) table.names.emplace_back(c.name);
  for (const VehicleTrial& t : trials) {
    std::vector<double> row = {t.step, static_cast<double>(t.end), t.reached, t.wallSeconds,
                               static_cast<double>(t.blamed)};
    for (const FigureColumn& c : kTrialFigures) row.push_back(t.figures.*c.value);
    table.rows.push_back(std::move(row));
  }
  return table;
}

fs::path causesOf(const jobs::Pieces& pieces, const std::string& name) {
  return pieces.folder() / "runs" / (name + ".txt");
}

} // namespace

std::vector<VehicleTrial> readTrials(const jobs::Pieces& pieces, const std::string& name) {
  const jobs::Table table = pieces.read(name);
  std::ifstream causes(causesOf(pieces, name));
  std::vector<VehicleTrial> trials;
  for (const std::vector<double>& row : table.rows) {
    const auto value = [&](const char* column) { return row[table.column(column)]; };
    VehicleTrial t;
    t.step = value("step [s]"), t.end = static_cast<TrialEnd>(static_cast<int>(value("end")));
    t.reached = value("reached [s]"), t.wallSeconds = value("wall [s]");
    t.blamed = static_cast<base::Cause>(static_cast<int>(value("cause")));
    for (const FigureColumn& c : kTrialFigures) t.figures.*c.value = value(c.name);
    std::getline(causes, t.cause);
    trials.push_back(t);
  }
  return trials;
}

void keepTrials(jobs::Pieces& pieces, const std::string& name, const std::vector<VehicleTrial>& trials) {
  std::string causes;
  for (const VehicleTrial& t : trials) causes += base::oneLine(t.cause) + "\n";
  support::replaceTextFile(causesOf(pieces, name), causes); // before the table, because it marks the run as finished
  pieces.keep(name, tableOf(trials));
}

} // namespace grouser::studies
