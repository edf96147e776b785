// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/records.hpp"
#include "runs/output/run_status.hpp"
#include "runs/setup/provenance.hpp"

#include <filesystem>
#include <map>
#include <string>

namespace grouser::output {

/// manifest.json: scene, program, machine and outcome of a run.
class Manifest {
public:
  Manifest(const std::filesystem::path& folder, const setup::Provenance& provenance,
           const std::map<std::string, std::string>& metadata);

  void note(const std::string& key, const std::string& text) { notes_[key] = text; }
  void add(const Summary& summary) { summary_ = summary; }

  /// Replaces the file atomically, with a list of the current files of the folder. On a full disk, writes the status of
  /// a failed or stopped run into the existing file.
  void write(RunStatus status) const;

private:
  std::filesystem::path path_;
  std::string scene_, started_;
  std::vector<std::string> overrides_;
  std::string inputs_; ///< setup::inputsOf()
  std::string soils_;  ///< soils used by the materials of the scene, as JSON
  std::map<std::string, std::string> notes_;
  Summary summary_;
};

/// Updates the list of files in the manifest of `folder`, e.g. after plotting.
void listFiles(const std::filesystem::path& folder);

/// The manifest of `folder`; empty if it is missing or empty. Throws base::InputError with `remedy` if it is damaged.
std::string manifestText(const std::filesystem::path& folder, const std::string& remedy);

} // namespace grouser::output
