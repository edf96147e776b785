// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation_state.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/support/hdf5_file.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace grouser::storage {

inline constexpr const char* kCheckpointName = "checkpoint.h5";

/// Kinds of state files.
inline constexpr const char* kCheckpointFile = "checkpoint";
inline constexpr const char* kBedFile = "settled bed";

/// Length scales of the stored grains, for readers without the scene.
struct GrainLengths {
  double unit{};   ///< unit of positions [m]
  double radius{}; ///< radius of the largest grain [m]
};
GrainLengths lengthsOf(const terrain::Grains& grains);

/// State of another run from which this run branched.
struct BranchPoint {
  std::string file;         ///< the checkpoint, absolute
  std::int64_t step{};      ///< step of the checkpoint
  std::string hash;         ///< hash of its state
  std::string text() const; ///< "FILE, step N, state hash H"
};

/// State of a stopped run. A resumed run is bitwise identical to an uninterrupted run.
struct Checkpoint {
  std::string scene;   ///< resolved scene
  std::string inputs;  ///< hashes of the scene's input files: see setup::inputsOf()
  std::string commit;  ///< commit of the program that wrote the file
  double timeStep{};   ///< [s]
  std::int64_t rows{}; ///< rows written so far
  std::int64_t frames{};
  std::optional<BranchPoint> branchedFrom; ///< empty: the run started at the first step
  std::optional<GrainLengths> lengths;     ///< scenes with grains only; missing in old files
  coupling::SimulationState state;
};

/// Replaces the file atomically: the former file stays intact on failure, or if the program is killed. Throws
/// support::NotWritten. All ranks call it, each with its rows of the grains; all return when the file is complete.
void writeCheckpoint(const std::filesystem::path& path, const Checkpoint& checkpoint, const base::Comm& comm = {});

/// Throws base::InputError if the file is missing, truncated, damaged, of another kind or of another version. Each rank
/// gets its rows; the number of ranks may differ from that of the writing run.
Checkpoint readCheckpoint(const std::filesystem::path& path, const base::Comm& comm = {});

/// Reads scene, inputs and commit only. All ranks call it.
Checkpoint readOrigin(const std::filesystem::path& path, const base::Comm& comm = {});
/// All ranks call it, each with its rows.
BranchPoint branchPoint(const std::filesystem::path& path, const Checkpoint& checkpoint, const base::Comm& comm = {});

/// Parts of the functions above. `kind` is one of the kinds above. readState() requires a file that has passed
/// checkStateFile(), which one rank calls for all ranks.
void writeState(const std::filesystem::path& path, const char* kind, const Checkpoint& checkpoint,
                const base::Comm& comm);
void checkStateFile(const std::filesystem::path& path, const char* kind);
Checkpoint readState(const support::Hdf5File& file, const base::Comm& comm);
coupling::SettleReport readSettled(const support::Hdf5File& file); ///< settling data of the bed

/// A dataset of a state file: [rows, width] numbers.
struct StoredField {
  std::string path;  ///< "grains/spin"
  std::string type;  ///< "float32"
  std::string rows;  ///< "1"; "n" for a list; "grains", "contacts"
  std::size_t width; ///< numbers per row
};
/// All fields of a state file; checkpoint_fields.hpp describes them.
std::vector<StoredField> storedFields();

} // namespace grouser::storage
