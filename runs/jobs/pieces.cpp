// SPDX-License-Identifier: BSD-3-Clause
#include "runs/jobs/pieces.hpp"

#include "base/error.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/not_written.hpp"
#include "runs/support/option_checks.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <tuple>

namespace grouser::jobs {

namespace fs = std::filesystem;

namespace {

/// Parses "2/8"; empty if `text` has a different form.
std::optional<Part> partOf(const std::string& text) {
  Part part;
  int length = 0;
  if (std::sscanf(text.c_str(), "%d/%d%n", &part.number, &part.count, &length) != 2 ||
      length != static_cast<int>(text.size()) || part.number < 1 || part.count < part.number)
    return {};
  return part;
}

std::string kindOf(const std::string& run) { return run.substr(0, run.rfind('_')); }

} // namespace

void addDeviceOptions(CLI::App& app, std::string& device, int& threads) {
  app.add_option("--device", device, "auto, cpu or cuda")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}))
      ->capture_default_str();
  app.add_option("--threads", threads,
                 "number of CPU threads; 0: all available cores, at most OMP_NUM_THREADS; no effect on results")
      ->check(support::wholeNumber(0, 1024))
      ->capture_default_str();
}

void addPieceOptions(CLI::App& app, PieceOptions& o) {
  app.add_flag("--resume", o.resume,
               "continue the runs of earlier calls in the folder (the default if the options are the same)");
  app.add_option("--part", o.part,
                 "run only this part of the runs, e.g. 2/8 for every eighth run starting with the second, to divide a "
                 "study among concurrent calls; a final call without --part writes the tables")
      ->check(CLI::Validator(
          [](const std::string& text) {
            return partOf(text) ? std::string() : text + " is not of the form PART/PARTS, e.g. 2/8";
          },
          "PART/PARTS"));
  app.add_option(
         "--seconds", o.seconds,
         "start no new run that would exceed this wall time [s], if the run takes as long as the last one; 0: no limit")
      ->check(support::notNegative("a time in seconds"));
  addDeviceOptions(app, o.device, o.threads);
}

Part PieceOptions::share() const { return partOf(part).value_or(Part{}); }

bool Recipe::isThere() const {
  std::ifstream in(file_, std::ios::binary);
  return in && std::string(std::istreambuf_iterator<char>(in), {}) == text_;
}

void Recipe::keep() const {
  try {
    if (!isThere()) support::replaceTextFile(file_, text_);
  } catch (const support::NotWritten&) {
    if (!isThere()) throw; // otherwise a concurrent part has written it
  }
}

std::size_t Table::column(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw base::InputError(fmt::format("a table of an earlier call has no column \"{}\": another program version wrote "
                                       "the table; repeat the study with --force",
                                       name));
  return static_cast<std::size_t>(found - names.begin());
}

std::vector<double> Table::values(const std::string& name) const {
  const std::size_t c = column(name);
  std::vector<double> all;
  for (const std::vector<double>& row : rows) all.push_back(row.at(c));
  return all;
}

std::string Table::csv() const {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) text += (i ? "," : "") + names[i];
  text += "\n";
  for (const std::vector<double>& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) text += fmt::format("{}{:.9g}", i ? "," : "", row[i]);
    text += "\n";
  }
  return text;
}

Pieces::Pieces(const std::string& study, const StudyPlace& place, const PieceOptions& options,
               const nlohmann::ordered_json& recipe)
    : part_(options.share()), seconds_(options.seconds) {
  StudyPlace where = place;
  if (where.folder.empty()) where.folder = (fs::path("out") / ("study_" + study)).string();
  const fs::path file = fs::path(where.folder) / "recipe.json";
  const Recipe kept(file, support::jsonText(recipe, 2) + "\n");
  std::error_code missing;
  const bool isAsked = options.resume || !options.part.empty();
  const bool hasRuns = (isAsked || !place.force) && fs::exists(file, missing);
  const bool isSame = hasRuns && kept.isThere();
  if (hasRuns && !isSame)
    throw base::InputError(fmt::format("{}: the runs in this folder were made with different options; use the same "
                                       "options, choose another folder with --out, or overwrite it with --force",
                                       file.string()));
  const bool continues = isAsked || isSame;
  where.force = place.force || continues;
  folder_ = beginStudy(study, where);
  if (!isSame) {
    if (!continues) fs::remove_all(folder_ / "runs");
    kept.keep();
  }
  fs::create_directories(folder_ / "runs");
}

fs::path Pieces::file(const std::string& run) const { return folder_ / "runs" / (run + ".csv"); }

bool Pieces::has(const std::string& run) const { return fs::exists(file(run)); }

Table Pieces::read(const std::string& run) const {
  Table table;
  std::ifstream in(file(run));
  std::string line, cell;
  std::getline(in, line);
  for (std::istringstream names(line); std::getline(names, cell, ',');) table.names.push_back(cell);
  while (std::getline(in, line)) {
    std::vector<double> row;
    for (std::istringstream cells(line); std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    if (row.size() != table.names.size())
      throw base::InputError(fmt::format("{}: a line has {} numbers, not {}; remove the file and repeat the call",
                                         file(run).string(), row.size(), table.names.size()));
    table.rows.push_back(row);
  }
  return table;
}

void Pieces::keep(const std::string& run, const Table& table) {
  support::replaceTextFile(file(run), table.csv());
  took_[kindOf(run)] = spent() - began_;
}

fs::path Pieces::begin(const std::string& run) const {
  fs::path folder = folder_ / "runs" / run;
  fs::create_directories(folder);
  return folder;
}

double Pieces::spent() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

bool Pieces::due(const std::string& run) {
  ++seen_;
  return dueBeside(run);
}

bool Pieces::dueBeside(const std::string& run) {
  if (has(run)) return false;
  const bool mine = part_.has(static_cast<std::size_t>(seen_ - 1)) && inTime(run);
  left_ += !mine;
  return mine;
}

bool Pieces::inTime(const std::string& run) {
  double expected = 0; // the first run of a call always starts
  if (const auto known = took_.find(kindOf(run)); known != took_.end())
    expected = known->second;
  else
    for (const auto& [kind, took] : took_) expected = std::max(expected, took);
  began_ = spent();
  return seconds_ == 0 || began_ + expected < seconds_;
}

} // namespace grouser::jobs
