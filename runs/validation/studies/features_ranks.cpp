// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "runs/support/program_call.hpp"
#include "runs/validation/studies/features.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace grouser::studies {

namespace {

constexpr int kRanks = 2;
constexpr int kBatches = 3;
constexpr double kUsual = 100e-9; // typical time per grain and step on one core [s]; determines the number of steps

/// Results of one call of `grouser bench bed`.
struct BedTimes {
  double step = 0;  ///< time per grain and step [ns]
  double bytes = 0; ///< memory per grain, sum over all ranks
  std::string hash;
};

BedTimes timesOf(const FeaturesCommand& c, bool ranks, const std::filesystem::path& file) {
  const auto steps = std::max<std::int64_t>(20, std::llround(c.turn / kBatches / (c.grains * kUsual / kRanks)));
  std::vector<std::string> words;
  support::Environment environment;
  if (ranks) {
    words = {"mpirun", "-np", std::to_string(kRanks)};
    environment = {{"OMPI_MCA_rmaps_base_oversubscribe", "1"}, // Open MPI 4, then 5
                   {"PRTE_MCA_rmaps_default_mapping_policy", ":oversubscribe"}};
    if (geteuid() == 0)
      for (const char* name : {"OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"})
        environment.emplace_back(name, "1");
  }
  const std::vector<std::string> bed = {std::filesystem::read_symlink("/proc/self/exe").string(),
                                        "bench",
                                        "bed",
                                        "--ledger",
                                        "--hash",
                                        "--settle",
                                        "0.02",
                                        "--grains",
                                        std::to_string(c.grains),
                                        "--device",
                                        c.pieces.device,
                                        "--threads",
                                        std::to_string(ranks ? 1 : kRanks),
                                        "--batches",
                                        std::to_string(kBatches),
                                        "--steps",
                                        std::to_string(steps),
                                        "--json",
                                        file.string()};
  words.insert(words.end(), bed.begin(), bed.end());
  const support::CallOutcome outcome = support::callProgram(words, environment);
  if (ranks && !outcome.started)
    throw base::InputError(fmt::format(
        "study features: ranks: {}; install openmpi-bin, or omit this feature from --features", outcome.output));
  std::ifstream in(file);
  const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  if (outcome.status != 0 || !json.is_object())
    throw base::InputError(fmt::format("study features: ranks: {} failed with exit code {}: {}", fmt::join(words, " "),
                                       outcome.status, outcome.output));
  return {1e3 * json.at("microseconds_a_step").at("median").get<double>() / json.at("grains").get<double>(),
          json.at("bytes_a_grain").get<double>(), json.at("state_hash").get<std::string>()};
}

} // namespace

jobs::Table measureRanks(const FeaturesCommand& c, const std::filesystem::path& folder) {
  jobs::Table table{kFeatureColumns, {}};
  for (int k = 0; k < c.pairs; ++k) {
    jobs::stopStudyOnRequest();
    BedTimes times[2];
    for (const bool ranks : {k % 2 != 0, k % 2 == 0})
      times[ranks ? 1 : 0] = timesOf(c, ranks, folder / (ranks ? "ranks.json" : "alone.json"));
    const double same = times[0].hash == times[1].hash ? 1 : 0, n = c.grains;
    table.rows.push_back({times[0].step, times[1].step, times[0].bytes, times[1].bytes, n, n, same});
  }
  return table;
}

} // namespace grouser::studies
