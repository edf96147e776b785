// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/manifest.hpp"

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/rounded.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/file_hash.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/text_file.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <fmt/chrono.h>
#include <fstream>

namespace grouser::output {

namespace fs = std::filesystem;

namespace {

constexpr const char *kName = "manifest.json", *kRows = "timeseries.csv";
/// Reserved space at the end of the file [bytes], so that the final message can be written on a full disk.
constexpr std::uint64_t kRoom = 16384;

std::string now() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

/// Start of the last line of the file, with the checksum of all text before it.
constexpr const char* kChecksum = ",\n  \"checksum\": \"";

std::string fileText(const nlohmann::ordered_json& json) {
  std::string text = support::jsonText(json, 2);
  text.resize(text.size() - std::string("\n}").size());
  return text + fmt::format("{}{:08x}\"\n}}\n", kChecksum, support::crc32(text));
}

std::string contentsOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// `ended`: also the checksum of the rows.
nlohmann::ordered_json filesIn(const fs::path& folder, bool ended) {
  std::map<std::string, std::uintmax_t> sizes;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename() != kName)
      sizes[entry.path().filename().string()] = entry.file_size();
  nlohmann::ordered_json files = nlohmann::ordered_json::object();
  for (const auto& [name, bytes] : sizes) files[name] = {{"bytes", bytes}};
  if (ended && sizes.contains(kRows))
    files[kRows]["crc32"] = fmt::format("{:08x}", support::crc32(contentsOf(folder / kRows)));
  return files;
}

/// Soils by material.
std::string soilsOf(const setup::Provenance& provenance) {
  nlohmann::ordered_json soils = nlohmann::ordered_json::object();
  for (const auto& use : provenance.soils)
    soils[use.material] = {{"soil", use.soil},
                           {"file", use.file},
                           {"hash", use.hash},
                           {"calibrated", use.calibrated},
                           {"grain_radius_m", use.grainRadius},
                           {"scale", use.scale},
                           {"scaled", use.scaled}};
  return support::jsonText(soils);
}

} // namespace

Manifest::Manifest(const fs::path& folder, const setup::Provenance& provenance,
                   const std::map<std::string, std::string>& metadata)
    : path_(folder / kName), scene_(fs::absolute(provenance.file).lexically_normal().string()), started_(now()),
      overrides_(provenance.overrides), inputs_(provenance.inputs), soils_(soilsOf(provenance)), notes_(metadata) {}

void Manifest::write(RunStatus status) const {
  const support::BuildInfo build = support::buildInfo();
  nlohmann::ordered_json json;
  json["status"] = base::wordOf(status);
  json["scene"] = scene_;
  json["overrides"] = overrides_;
  json["inputs"] = inputs_;
  if (auto soils = nlohmann::ordered_json::parse(soils_); !soils.empty()) json["soils"] = std::move(soils);
  json["program"] = {{"name", "grouser"},
                     {"version", build.version},
                     {"commit", build.commit},
                     {"compiler", build.compiler},
                     {"cuda", build.cuda}};
  json["machine"] = support::machineText();
  json["started"] = started_;
  for (const auto& [key, text] : notes_) json[key] = text;
  if (const std::string job = support::slurmJob(); !job.empty()) json["slurm_job"] = job;
  if (hasEnded(status)) {
    json["ended"] = now();
    json["steps"] = summary_.steps;
    json["simulated_time_s"] = base::nearestDecimal(summary_.simulatedTime);
    json["wall_time_s"] = summary_.wallTime;
    if (!summary_.stateHash.empty()) json["state_hash"] = summary_.stateHash;
    for (const auto& [key, value] : summary_.figures) json["figures"][key] = value;
  }
  json["files"] = filesIn(path_.parent_path(), hasEnded(status));
  const std::string text = fileText(json);
  try {
    support::replaceTextFile(path_, text, kRoom);
  } catch (const std::exception&) {
    if (status == RunStatus::running || hasEnded(status)) throw;
    support::overwriteTextFile(path_, text);
  }
}

void listFiles(const fs::path& folder) {
  nlohmann::ordered_json json =
      nlohmann::ordered_json::parse(manifestText(folder, "restore it from a copy"), nullptr, false);
  if (!json.is_object()) return;
  json.erase("checksum");
  json["files"] = filesIn(folder, true);
  support::replaceTextFile(folder / kName, fileText(json));
}

std::string manifestText(const fs::path& folder, const std::string& remedy) {
  const fs::path path = folder / kName;
  std::error_code error;
  if (fs::symlink_status(path, error).type() == fs::file_type::not_found) return "";
  std::string text = base::readInput(path, remedy);
  const std::size_t at = text.rfind(kChecksum);
  const bool isDamaged =
      at == std::string::npos // older versions write no checksum: their last entry is a table, not a text
          ? !text.empty() && (text.ends_with("\"\n}\n") || !nlohmann::json::parse(text, nullptr, false).is_object())
          : text.substr(at) != fmt::format("{}{:08x}\"\n}}\n", kChecksum, support::crc32(text.substr(0, at)));
  if (isDamaged)
    throw base::InputError(fmt::format("{}: wrong checksum: the file is damaged; {}", path.string(), remedy));
  return text;
}

} // namespace grouser::output
