// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/sweep_summary.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/campaigns/sweeps/run_manifest.hpp"
#include "runs/campaigns/sweeps/run_notices.hpp"
#include "runs/campaigns/sweeps/sweep_files.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/drive_length.hpp"
#include "runs/setup/scene_surfaces.hpp"
#include "runs/support/csv_cell.hpp"
#include "runs/support/hdf5_file.hpp"
#include "runs/support/text_file.hpp"
#include "vehicle/observers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>

namespace grouser::sweeps {

namespace fs = std::filesystem;

namespace {

/// Mean and maximum of the numbers that are not NaN.
struct Spread {
  double sum = 0, most = base::kNaN;
  std::size_t count = 0;
  void add(double v) {
    if (std::isnan(v)) return;
    sum += v, ++count;
    most = std::isnan(most) ? v : std::max(most, v);
  }
  double mean() const { return count ? sum / static_cast<double>(count) : base::kNaN; }
};

/// Steady rows of the series of a run. All values are NaN without a file.
class Steady {
public:
  Steady(const support::Hdf5File* file, double from) : file_(file), from_(from) {
    if (file) times_ = file->numbers("/series/time");
    while (first_ < times_.size() && !(times_[first_] >= from)) ++first_;
    part_ = first_, first_ = firstOfWholeTeeth();
  }
  /// Start of the interval of the means [s]; NaN without a file.
  double from() const { return !file_ ? base::kNaN : first_ > part_ ? times_[first_ - 1] : from_; }
  Spread of(const std::string& path) const {
    Spread spread;
    for (const double v : rows(path)) spread.add(v);
    return spread;
  }
  /// Values of both tracks and all shoes.
  Spread ofTracks(const std::string& name) const {
    Spread spread;
    for (const std::string side : {"left", "right"})
      for (const double v : rows("vehicle/" + side + "/" + name)) spread.add(v);
    return spread;
  }
  /// Mean of entry `k` of a vector.
  double meanOf(const std::string& path, std::size_t k) const {
    const std::vector<double> all = rows(path);
    Spread spread;
    for (std::size_t i = k; i < all.size(); i += 3) spread.add(all[i]);
    return spread.mean();
  }
  /// Sum of the means of the existing tracks.
  double sumOfTracks(const std::string& name) const {
    double sum = base::kNaN;
    for (const std::string side : {"left", "right"})
      if (const double mean = of("vehicle/" + side + "/" + name).mean(); std::isfinite(mean))
        sum = std::isfinite(sum) ? sum + mean : mean;
    return sum;
  }
  /// Number of teeth that pass the sprocket of each track in the whole steady part, forward or backward [-].
  Spread teeth() const {
    Spread spread;
    for (const std::string side : {"left", "right"})
      if (const std::vector<double> until = teethUntilEnd(side); part_ < until.size()) spread.add(until[part_]);
    return spread;
  }
  /// Common slip of both tracks: 1 - hull travel / sprocket travel, in the direction of each track.
  double slip() const {
    double went = 0, asked = 0;
    for (const std::string side : {"left", "right"}) {
      const std::vector<double> speed = rows("vehicle/" + side + "/speed"),
                                turns = rows("vehicle/" + side + "/sprocket_speed");
      for (std::size_t i = 0; i < std::min(speed.size(), turns.size()); ++i) {
        if (std::fabs(turns[i]) < vehicle::kStanding || !std::isfinite(speed[i] * turns[i])) continue;
        went += turns[i] > 0 ? speed[i] : -speed[i], asked += std::fabs(turns[i]);
      }
    }
    return asked > 0 ? 1 - went / (asked * constant("vehicle/pitch_radius")) : base::kNaN;
  }
  /// Minimum and maximum of the hull's speed [m/s], averaged over the tracks; infinite and reversed without a vehicle.
  std::array<double, 2> speedRange() const {
    const std::vector<double> left = rows("vehicle/left/speed"), right = rows("vehicle/right/speed");
    const std::vector<double>& one = left.empty() ? right : left;
    std::array<double, 2> range{base::kInfinity, -base::kInfinity};
    for (std::size_t i = 0; i < one.size(); ++i)
      if (const double speed = i < left.size() && i < right.size() ? 0.5 * (left[i] + right[i]) : one[i];
          std::isfinite(speed))
        range = {std::min(range[0], speed), std::max(range[1], speed)};
    return range;
  }
  /// Whether the direction of motion changes: gross traction has the sign of the torques only in forward motion.
  bool turnsRound() const {
    const std::vector<double> traction = rows("vehicle/gross_traction"), left = rows("vehicle/left/mean_torque"),
                              right = rows("vehicle/right/mean_torque");
    bool forward = false, backward = false;
    for (std::size_t i = 0; i < std::min(traction.size(), left.size()); ++i) {
      const double sign = traction[i] * (left[i] + (i < right.size() ? right[i] : 0));
      forward = forward || sign > 0, backward = backward || sign < 0;
    }
    return forward && backward;
  }
  double last(const std::string& path) const {
    const std::vector<double> all = numbers(path);
    return all.empty() ? base::kNaN : all.back();
  }
  double last(const std::string& path, std::size_t k) const {
    const std::vector<double> all = numbers(path);
    return all.size() < 3 ? base::kNaN : all[all.size() - 3 + k];
  }
  double lastNorm(const std::string& path) const {
    const double x = last(path, 0), y = last(path, 1), z = last(path, 2);
    return std::sqrt(x * x + y * y + z * z);
  }
  double constant(const std::string& path) const {
    return file_ && file_->has("/" + path) ? file_->numbers("/" + path).front() : base::kNaN;
  }

private:
  std::vector<double> numbers(const std::string& path) const {
    const std::string dataset = "/" + path + "/value";
    return file_ && file_->has(dataset) ? file_->numbers(dataset) : std::vector<double>{};
  }
  /// Number of teeth that pass the sprocket of a track between each row and the last row [-].
  std::vector<double> teethUntilEnd(const std::string& side) const {
    std::vector<double> teeth = numbers("vehicle/" + side + "/teeth_passed");
    double sum = 0;
    for (std::size_t i = teeth.size(); i-- > 0;) {
      const double change = i > 0 ? std::fabs(teeth[i] - teeth[i - 1]) : 0;
      teeth[i] = sum, sum += change;
    }
    return teeth;
  }
  /// First row of the (nearly) whole number of teeth at the end of the steady part: a mean over a fraction of a tooth
  /// would contain a part of the ripple. The interval of a row ends at the time of the row.
  std::size_t firstOfWholeTeeth() const {
    for (const std::string side : {"left", "right"}) {
      const std::vector<double> until = teethUntilEnd(side);
      if (first_ == 0 || first_ >= until.size() || !(until[first_ - 1] >= 1)) continue;
      const double whole = std::floor(until[first_ - 1]);
      std::size_t row = first_;
      while (row + 1 < until.size() && std::fabs(until[row] - whole) < std::fabs(until[row - 1] - whole)) ++row;
      return row;
    }
    return first_;
  }
  std::vector<double> rows(const std::string& path) const {
    std::vector<double> all = numbers(path);
    const std::size_t width = times_.empty() ? 0 : all.size() / times_.size();
    all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), first_ * width)));
    return all;
  }

  const support::Hdf5File* file_;
  double from_; ///< start of the steady part [s]
  std::vector<double> times_;
  std::size_t part_ = 0;  ///< first row of the steady part
  std::size_t first_ = 0; ///< first row of the means
};

/// Figures measured along the direction of motion.
constexpr std::array kAlongMotion{"gross traction [N]", "drawbar pull [N]", "motion resistance [N]"};
constexpr const char* kTurned = "direction of motion changes: gross traction, drawbar pull, motion resistance";

struct Figure {
  std::string column;
  double value;
};

/// Vehicle and surfaces of all runs of a sweep; they determine the columns.
struct Columns {
  bool vehicle = false;
  std::vector<std::string> surfaces; ///< names

  explicit Columns(const SweepPlan& plan) {
    for (const SweepRun& run : plan.runs) {
      vehicle = vehicle || run.scene.vehicle;
      for (const setup::SceneSurface& s : setup::surfacesOf(run.scene))
        if (std::find(surfaces.begin(), surfaces.end(), s.name) == surfaces.end()) surfaces.push_back(s.name);
    }
  }
};

/// Loads on the surfaces, and their final positions.
void addSurfaces(const Steady& steady, const std::vector<std::string>& names, std::vector<Figure>& figures) {
  for (const std::string& name : names) {
    const std::string group = "surfaces/" + name + "/";
    for (std::size_t k = 0; k < 3; ++k)
      figures.push_back({fmt::format("{} force {} [N]", name, "xyz"[k]), steady.meanOf(group + "force", k)});
    for (std::size_t k = 0; k < 3; ++k)
      figures.push_back({fmt::format("{} torque {} [N m]", name, "xyz"[k]), steady.meanOf(group + "torque", k)});
    figures.push_back({name + " power [W]", steady.of(group + "power").mean()});
    for (std::size_t k = 0; k < 3; ++k)
      figures.push_back(
          {fmt::format("{} position {} at the end [m]", name, "xyz"[k]), steady.last(group + "position", k)});
  }
}

/// The figures of one run, for header and rows; all NaN if `file` is null.
std::vector<Figure> figuresOf(const Steady& steady, const Columns& columns) {
  std::vector<Figure> figures{{"drive work [J]", steady.last("ledger/drive_work")},
                              {"integration error [J]", steady.last("ledger/integration_error")}};
  if (!columns.surfaces.empty() && !columns.vehicle) figures.push_back({"steady from [s]", steady.from()});
  addSurfaces(steady, columns.surfaces, figures);
  if (!columns.vehicle) return figures;
  const Spread sinkage = steady.ofTracks("sinkage"), tension = steady.ofTracks("tension");
  const std::vector<Figure> ofVehicle{{"steady from [s]", steady.from()},
                                      {"teeth passed [-]", steady.teeth().mean()},
                                      {"speed [m/s]", steady.ofTracks("speed").mean()},
                                      {"slip [-]", steady.slip()},
                                      {"sinkage mean [m]", sinkage.mean()},
                                      {"sinkage max [m]", sinkage.most},
                                      {"drive torque [N m]", steady.sumOfTracks("mean_torque")},
                                      {"drive power [W]", steady.sumOfTracks("drive_power")},
                                      {"tension mean [N]", tension.mean()},
                                      {"tension peak [N]", tension.most},
                                      {"gross traction [N]", steady.of("vehicle/gross_traction").mean()},
                                      {"drawbar pull [N]", steady.of("vehicle/drawbar_pull").mean()},
                                      {"motion resistance [N]", steady.of("vehicle/motion_resistance").mean()}};
  figures.insert(figures.begin(), ofVehicle.begin(), ofVehicle.end());
  figures.push_back({"impulse residual [N s]", steady.lastNorm("ledger/impulse_residual")});
  return figures;
}

/// Reason why figures of the steady part are inconclusive; empty if valid or missing.
std::string doubtOf(const scene::Scene& scene, const SweepOutcome& outcome, double teeth) {
  if (outcome.status == output::RunStatus::incomplete) return outcome.message;
  if (!setup::commandsDrive(scene) || !(teeth < setup::kFewestTeeth)) return {};
  return fmt::format("the steady part covers {:.2g} teeth, fewer than {:g}", teeth, setup::kFewestTeeth);
}

/// Adds the figures of one run to `all`; NaN if it has not ended.
void addFigures(const SweepRun& run, const SweepOutcome& outcome, const fs::path& folder, const Columns& columns,
                SweepFigures& all) {
  std::optional<support::Hdf5File> file;
  const fs::path results = folder / run.name / "results.h5";
  const bool ended = output::hasEnded(outcome.status);
  if (ended && fs::exists(results)) file.emplace(support::Hdf5File::open(results));
  const double from = ended ? steadyFrom(run.scene, RunManifest(folder / run.name)) : base::kNaN;
  const support::Hdf5File* const read = file ? &*file : nullptr;
  std::vector<double>& values = all.values.emplace_back();
  const Steady steady(read, from);
  for (const Figure& f : figuresOf(steady, columns)) values.push_back(f.value);
  all.from.push_back(steady.from()), all.speedRange.push_back(steady.speedRange());
  all.inconclusive.push_back(ended ? doubtOf(run.scene, outcome, steady.teeth().most) : "");
  all.turned.emplace_back(steady.turnsRound() ? kTurned : "");
}

/// The cells of one run, in the order of the header.
std::vector<std::string> row(const SweepRun& run, const SweepOutcome& outcome, const fs::path& folder,
                             const std::vector<double>& figures, const std::string& doubt) {
  std::vector<std::string> cells = {support::csvCell(run.name)};
  for (const std::string& value : run.values) cells.push_back(support::csvCell(value));
  cells.emplace_back(base::wordOf(outcome.status));
  cells.push_back(support::csvCell(outcome.message));
  cells.push_back(support::csvCell(!doubt.empty() && doubt == outcome.message ? "see message" : doubt));
  const RunManifest manifest(output::hasEnded(outcome.status) ? folder / run.name : fs::path());
  for (const double number : {manifest.wallTime(), manifest.number("steps"), manifest.number("simulated_time_s")})
    cells.push_back(support::csvCell(number));
  for (const double value : figures) cells.push_back(support::csvCell(value));
  cells.push_back(manifest.text("state_hash"));
  cells.push_back(manifest.commit());
  cells.push_back(support::csvCell(noticesOfRun(run, folder)));
  return cells;
}

} // namespace

double steadyFrom(const scene::Scene& scene, double driveStart, double end) {
  const double duration = std::isfinite(end) ? end : scene.run.duration;
  if (!scene.vehicle) return 0.5 * duration;
  const double begins = std::isfinite(driveStart) ? driveStart : scene.driver.driveBegins();
  double ramped = begins + scene.driver.rampOfDrive();
  if (const auto& course = scene.driver.course) ramped = begins + std::fabs(course->speed) / course->acceleration;
  if (const auto& torques = scene.driver.torqueTable) ramped = std::max(ramped, begins + torques->time.back());
  if (scene.driver.table) ramped = std::max(ramped, begins + scene.driver.table->time.back());
  return ramped < duration ? 0.5 * (ramped + duration) : base::kNaN;
}

double steadyFrom(const scene::Scene& scene, const RunManifest& manifest) {
  // [stop] and --steps end runs early; otherwise the last step may differ from the duration by rounding.
  const double end = manifest.number("simulated_time_s"), step = end / manifest.number("steps");
  return steadyFrom(scene, manifest.figure("drive_start_s"), scene.run.duration - end > step ? end : base::kNaN);
}

SweepFigures sweepFigures(const SweepPlan& plan, const std::vector<SweepOutcome>& outcomes, const fs::path& folder) {
  const Columns columns(plan);
  SweepFigures all;
  for (const Figure& f : figuresOf(Steady(nullptr, base::kNaN), columns)) all.columns.push_back(f.column);
  for (std::size_t i = 0; i < plan.runs.size(); ++i) addFigures(plan.runs[i], outcomes[i], folder, columns, all);
  return all;
}

std::string SweepFigures::doubtOf(const std::vector<std::size_t>& runs) const {
  std::string first;
  for (const std::size_t i : runs) {
    const bool has = std::any_of(values[i].begin(), values[i].end(), [](double v) { return std::isfinite(v); });
    if (i >= inconclusive.size() || (has && inconclusive[i].empty())) return {};
    if (first.empty()) first = inconclusive[i];
  }
  return first;
}

std::string SweepFigures::doubtOf(std::size_t run) const {
  return inconclusive[run].empty() ? turned[run] : inconclusive[run];
}

void SweepFigures::dropInconclusive(const std::vector<std::size_t>& runs) {
  for (const std::size_t i : runs)
    for (std::size_t c = 0; i < turned.size() && !turned[i].empty() && c < columns.size(); ++c)
      if (std::find(kAlongMotion.begin(), kAlongMotion.end(), columns[c]) != kAlongMotion.end())
        values[i][c] = base::kNaN;
  if (inconclusive.empty() || !doubtOf(runs).empty()) return;
  for (const std::size_t i : runs)
    if (!inconclusive[i].empty()) values[i].assign(columns.size(), base::kNaN);
}

void checkSweepFiles(const fs::path& folder) {
  std::ifstream file(folder / kSummaryFile);
  std::string header;
  std::getline(file, header);
  if (header.starts_with("run,") && header.find(",status,message,") != std::string::npos) return;
  std::error_code error;
  for (const char* name : kSweepFiles)
    if (fs::exists(folder / name, error))
      throw base::InputError(fmt::format(
          "{}: exists but was not written by a sweep; choose another folder with --out, or overwrite it with --force",
          (folder / name).string()));
}

fs::path writeSummary(const SweepPlan& plan, const std::vector<SweepOutcome>& outcomes, const fs::path& folder) {
  const SweepFigures figures = sweepFigures(plan, outcomes, folder);
  std::vector<std::string> header = {"run"};
  for (const std::string& key : plan.keys) header.push_back(support::csvCell(key));
  for (const char* column : {"status", "message", "inconclusive", "wall time [s]", "steps", "simulated time [s]"})
    header.emplace_back(column);
  for (const std::string& column : figures.columns) header.push_back(support::csvCell(column));
  header.insert(header.end(), {"state hash", "commit", "warnings and notes"});
  std::string text = fmt::format("{}\n", fmt::join(header, ","));
  for (std::size_t i = 0; i < plan.runs.size(); ++i)
    text += fmt::format("{}\n",
                        fmt::join(row(plan.runs[i], outcomes[i], folder, figures.values[i], figures.doubtOf(i)), ","));

  fs::path path = folder / kSummaryFile;
  support::replaceTextFile(path, text);
  return path;
}

} // namespace grouser::sweeps
