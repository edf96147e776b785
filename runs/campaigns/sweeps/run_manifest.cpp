// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/run_manifest.hpp"

#include "runs/output/manifest.hpp"

#include <cmath>
#include <limits>

namespace grouser::sweeps {

namespace {

double numberOf(const nlohmann::json& json, const char* key) {
  const auto at = json.find(key);
  return at != json.end() && at->is_number() ? at->get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::string textOf(const nlohmann::json& json, const char* key) {
  const auto at = json.find(key);
  return at != json.end() && at->is_string() ? at->get<std::string>() : "";
}

} // namespace

RunManifest::RunManifest(const std::filesystem::path& folder) {
  const std::string text =
      output::manifestText(folder, "restore it from a copy, or remove the folder to repeat the run");
  json_ = nlohmann::json::parse(text, nullptr, false);
  if (!json_.is_object()) json_ = nlohmann::json::object();
}

double RunManifest::number(const char* key) const { return numberOf(json_, key); }
std::string RunManifest::text(const char* key) const { return textOf(json_, key); }

double RunManifest::figure(const char* key) const {
  const auto figures = json_.find("figures");
  return figures != json_.end() && figures->is_object() ? numberOf(*figures, key)
                                                        : std::numeric_limits<double>::quiet_NaN();
}

std::string RunManifest::checksumOf(const char* file) const {
  const auto files = json_.find("files");
  if (files == json_.end() || !files->is_object()) return "";
  const auto entry = files->find(file);
  return entry != files->end() && entry->is_object() ? textOf(*entry, "crc32") : "";
}

std::string RunManifest::commit() const {
  const auto program = json_.find("program");
  return program != json_.end() && program->is_object() ? textOf(*program, "commit") : "";
}

double RunManifest::stepsOverTimed() const {
  const double steps = number("steps"), before = figure("resumed_at_step"), from = figure("branched_at_step");
  return before > 0 ? (steps - (from > 0 ? from : 0)) / (steps - before) : 1; // NaN for a run resumed at its end
}

double RunManifest::wholeOverTimed() const {
  const double whole = stepsOverTimed();
  return std::isfinite(whole) ? whole : 1;
}

double RunManifest::wallTime() const { return wholeOverTimed() * number("wall_time_s"); }

double RunManifest::ofAllSteps(const char* key) const { return wholeOverTimed() * figure(key); }

} // namespace grouser::sweeps
