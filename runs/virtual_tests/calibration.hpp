// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/bevameter.hpp"
#include "runs/virtual_tests/curve_targets.hpp"
#include "runs/virtual_tests/results.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

/// `grouser soil --calibrate`: contact parameters that reproduce the target constants of a soil at a given grain size.
namespace grouser::virtual_tests {

/// Contents of a target file. See readTargets().
struct CalibrationTargets {
  std::map<Quantity, double> wanted;  ///< in unitOf()
  std::optional<double> k, breadth;   ///< [kN/m^(n+2)] at a breadth [m], instead of k_c and k_phi
  double angleTolerance = 1;          ///< [deg]
  double cohesionTolerance = 0.5;     ///< [kPa]
  double stiffnessTolerance = 0.1;    ///< relative, of the pressure at the target sinkage [-]
  std::optional<CurveTargets> curves; ///< replaces all of the above
  TestedSoil start;                   ///< initial material of the search

  bool requestsSinkage() const;
  /// k of Bekker's equation for a breadth [kN/m^(n+2)].
  double kAt(double breadth) const;
  /// Target sinkage of a plate of this breadth at the track's pressure [m].
  double sinkageAt(double breadth) const;
};

/// Reads [targets] (phi, c, K, n, k_c and k_phi, or k and b), [tolerances] (phi, c, k), [start] (keys of a scene's
/// material) and [bed] (as in a soil file). With [plates] and [search] (curve_targets.hpp), [targets] may only contain
/// repose and bulk_density. Throws base::InputError with file:line and key.
CalibrationTargets readTargets(const std::filesystem::path& file, double grainRadius);

/// One trial of a search for x at a target y, which increases with x.
struct Trial {
  double x = 0, y = 0;
};
/// Next x to try in [low, high]; empty if the nearest trial is within `tolerance` or cannot be improved. Uses regula
/// falsi if there are trials on both sides of the target; otherwise extrapolates from the outermost trial with the
/// slope to its neighbour. `slope`: expected slope; used for the first step, and limits the measured slope.
std::optional<double> nextTrial(const std::vector<Trial>& trials, double wanted, double tolerance, double low,
                                double high, double slope);
/// The trial with the y that is closest to `wanted`.
Trial nearestTrial(const std::vector<Trial>& trials, double wanted);

/// Friction and rolling friction on a path of increasing strength. From -1 to 0, friction rises from 0.01 to its
/// initial value; from 0 to 1, rolling friction rises to 0.5; from 1 to 2, friction rises to 1.
struct Strength {
  double friction = 0, rollingFriction = 0;
};
Strength strengthAt(double way, double startFriction);
/// Position on the path of Strength for a rolling friction.
double wayOf(double rollingFriction);

/// Position of a trial on the path of Strength, and its adhesion energy [J/m2].
struct StrengthPoint {
  double way = 0, pull = 0;
};

/// Simultaneous search for a target angle and a target cohesion; both depend on both parameters. Broyden's method,
/// scaled by tolerances and expected slopes. Either target may be absent.
class StrengthSearch {
public:
  struct Target {
    double wanted = 0, tolerance = 1, slope = 1; ///< slope: expected, of the angle over the path or of c over the pull
  };
  /// The parameter of an absent target keeps its initial value.
  StrengthSearch(std::optional<Target> angle, std::optional<Target> cohesion, StrengthPoint start);

  StrengthPoint at() const { return trials_.empty() ? start_ : next_; }
  /// Adds the result [deg], [kPa] of the trial at(). Returns true if another trial is worthwhile; at() then returns it.
  bool tried(double angle, double cohesion);
  /// The trial with the smallest distance from the targets; the distance is the larger of both errors / tolerance.
  StrengthPoint nearest() const;

private:
  using Two = std::array<double, 2>;
  struct Done {
    StrengthPoint where;
    Two x, off; ///< scaled position, and distance from the targets
  };
  double farOff(const Done& trial) const;
  void learn(const Done& before, const Done& now);
  Two stepFrom(const Done& trial) const;

  std::array<std::optional<Target>, 2> targets_;
  Two unit_{1, 1};                                  ///< scales of path and pull
  std::array<Two, 2> slopes_{Two{1, 0}, Two{0, 1}}; ///< scaled slopes of both results over both parameters
  StrengthPoint start_, next_;
  std::vector<Done> trials_;
};

struct CalibrationCommand {
  std::filesystem::path targets;
  double grainRadius = 0; ///< [m]; 0: radius in the target file
  jobs::StudyPlace place; ///< an empty folder means out/calibrate_NAME
  jobs::PieceOptions pieces;
  int jobs = 1;
  PlanOptions plan;
  std::string words; ///< the whole command line
};
void calibrateCommand(const CalibrationCommand& command);

/// Text of the soil file with the calibrated parameters.
std::string soilFileText(const TestedSoil& soil, const std::string& description, const SoilResults& reached,
                         const std::string& command);

} // namespace grouser::virtual_tests
