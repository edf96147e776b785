// SPDX-License-Identifier: BSD-3-Clause
// `grouser study random-vehicles`: pieces, table and files of random vehicles.
#include "base/error.hpp"
#include "runs/storage/sphere_cache.hpp"
#include "runs/support/csv_cell.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"
#include "runs/validation/studies/random_vehicles.hpp"
#include "runs/validation/studies/trial_files.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <chrono>

namespace grouser::studies {

namespace fs = std::filesystem;

namespace {

std::string nameOf(int number) { return fmt::format("vehicle_{}", number); }

void runAll(const RandomVehicles& c, jobs::Pieces& pieces) {
  const base::Exec exec = support::chooseDevice(support::deviceChoice(c.pieces.device), c.pieces.threads, nullptr);
  storage::SphereCache spheres{support::KeptFiles(pieces.folder() / "kept")}; // all runs of a vehicle share it
  support::Progress progress("driving");
  for (int k = 0; k < c.vehicles; ++k) {
    const std::string name = nameOf(k);
    progress.update(static_cast<double>(k) / c.vehicles, name);
    if (!pieces.due(name)) continue;
    const fs::path folder = pieces.begin(name);
    TrialPlace place;
    place.folder = folder, place.exec = exec, place.spheres = &spheres;
    const RandomVehicle vehicle = randomVehicle(static_cast<std::uint64_t>(c.seed), k);
    const RandomOutcome outcome = tryRandomVehicle(vehicle, place);
    // Scene for `grouser run`; it is written before the trials, because they mark the piece as finished.
    support::replaceTextFile(pieces.folder() / "runs" / (name + ".toml"),
                             sceneText(vehicle.what, outcome.trials.at(0).step));
    keepTrials(pieces, name, outcome.trials);
    fs::remove_all(folder);
  }
  progress.finish(fmt::format("{} of {} vehicles finished", c.vehicles - pieces.left(), c.vehicles));
}

} // namespace

void studyRandomVehicles(const RandomVehicles& c) {
  const auto begin = std::chrono::steady_clock::now();
  jobs::Pieces pieces("random_vehicles", c.place, c.pieces, {{"study", "random-vehicles"}, {"seed", c.seed}});
  const support::StopSignals signals;
  fmt::print("          {} random vehicles with seed {}\n", c.vehicles, c.seed);
  runAll(c, pieces);
  if (!pieces.whole()) return;
  std::array<int, kVerdictWords.size()> counts{};
  std::string csv = "vehicle,seed,file,drive,ground,arms,step [s],verdict,cause,reached [s],speed [m/s],dissipated [J],"
                    "left over [-],wall [s]\n";
  std::string lines;
  for (int k = 0; k < c.vehicles; ++k) {
    if (!pieces.has(nameOf(k))) continue;
    const RandomVehicle v = randomVehicle(static_cast<std::uint64_t>(c.seed), k);
    const RandomOutcome outcome{readTrials(pieces, nameOf(k))};
    const Judgement judgement = judgeRandom(v, outcome);
    const auto verdict = static_cast<std::size_t>(judgement.verdict);
    const VehicleTrial& run = outcome.trials.at(0);
    ++counts[verdict];
    double wall = 0;
    for (const VehicleTrial& t : outcome.trials) wall += t.wallSeconds;
    csv += fmt::format("{},{},{},{},{},{},{:.6g},{},{},{:.4g},{},{},{},{:.3g}\n", k, c.seed, v.base, v.drive,
                       v.onBed  ? "bed"
                       : v.bump ? "bump"
                                : "rigid",
                       v.rigidArms ? "rigid" : "sprung", run.step, kVerdictWords[verdict],
                       support::csvCell(judgement.why), run.reached, support::csvCell(run.figures.speed),
                       support::csvCell(run.figures.dissipated), support::csvCell(run.figures.energyResidual), wall);
    if (judgement.verdict != MapVerdict::sound)
      lines += fmt::format("{}: vehicle {}, {} {} on {}: {}\n", kVerdictWords[verdict], k, v.base, v.drive,
                           v.onBed ? "a bed" : "rigid ground", judgement.why);
  }
  fmt::print("{}\n", lines);
  for (std::size_t v = 0; v < kVerdictWords.size(); ++v) fmt::print("  {:<16}{:>5}\n", kVerdictWords[v], counts[v]);
  if (pieces.left() > 0) fmt::print("{} vehicles missing; repeat the command with --resume\n", pieces.left());
  nlohmann::ordered_json verdicts;
  for (std::size_t v = 0; v < kVerdictWords.size(); ++v) verdicts[kVerdictWords[v]] = counts[v];
  support::replaceTextFile(pieces.folder() / "random_vehicles.csv", csv);
  jobs::writeStudyOrigin(pieces.folder(), "random-vehicles",
                         std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
                         {{"vehicles", c.vehicles}, {"seed", c.seed}, {"verdicts", verdicts}});
  if (pieces.left() == 0) fs::remove_all(pieces.folder() / "kept");
  fmt::print("tables    {}\n", pieces.folder().string());
  const int wrong = counts[static_cast<std::size_t>(MapVerdict::wrongCause)] +
                    counts[static_cast<std::size_t>(MapVerdict::silentlyWrong)];
  if (wrong > 0)
    throw base::SimulationError(
        fmt::format("{} vehicles are silently wrong or stopped with a wrong cause (listed above)", wrong));
}

} // namespace grouser::studies
