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

/// `grouser soil --calibrate`: contact parameters that give a soil wanted constants, at a grain size.
namespace grouser::virtual_tests {

/// What a file of targets says. See readTargets().
struct CalibrationTargets {
  std::map<Quantity, double> wanted;  ///< in unitOf()
  std::optional<double> k, breadth;   ///< [kN/m^(n+2)] at a breadth [m], instead of k_c and k_phi
  double angleTolerance = 1;          ///< [deg]
  double cohesionTolerance = 0.5;     ///< [kPa]
  double stiffnessTolerance = 0.1;    ///< of the pressure at the sinkage wanted [-]
  std::optional<CurveTargets> curves; ///< instead of all above
  TestedSoil start;                   ///< the material that the search begins with

  bool wantsSinkage() const;
  /// k of Bekker's form for a breadth [kN/m^(n+2)].
  double kAt(double breadth) const;
  /// At which a plate of this breadth is to carry the track's pressure [m].
  double sinkageAt(double breadth) const;
};

/// Reads [targets] (phi, c, K, n, k_c, k_phi, or k and b), [tolerances] (phi, c, k), [start], the keys of a scene's
/// material, and [bed], as in a soil file; or with [plates] and [search] (curve_targets.hpp) [targets] repose and
/// bulk_density. Throws base::InputError with file:line and key.
CalibrationTargets readTargets(const std::filesystem::path& file, double grainRadius);

/// One trial of a search for the x at which y, which rises with x, is wanted.
struct Trial {
  double x = 0, y = 0;
};
/// Where to try next, in [low, high]; empty where the nearest trial is within `tolerance` or none can be nearer.
/// Between trials on both sides by the line through them, kept off their ends; else on from the outermost by the slope
/// to the trial next to it, at first by `slope`, about which it stays.
std::optional<double> nextTrial(const std::vector<Trial>& trials, double wanted, double tolerance, double low,
                                double high, double slope);
/// The trial whose y is nearest.
Trial nearestTrial(const std::vector<Trial>& trials, double wanted);

/// Friction and rolling friction on the way along which a soil grows stronger: from no friction to that of the start
/// (-1 to 0), then rolling friction up to 0.5 (0 to 1), then friction up to 1 (1 to 2).
struct Strength {
  double friction = 0, rollingFriction = 0;
};
Strength strengthAt(double way, double startFriction);
/// Where on it rolling friction is this much.
double wayOf(double rollingFriction);

/// Where a trial stands on that way, and the energy that pulls grains together [J/m2].
struct StrengthPoint {
  double way = 0, pull = 0;
};

/// The search for an angle and a cohesion at once, since each depends on both numbers: Broyden's method, in units of
/// what the tolerances are worth by the slopes expected. One of them may be left out.
class StrengthSearch {
public:
  struct Target {
    double wanted = 0, tolerance = 1, slope = 1; ///< slope: expected, of the angle over the way, of c over the pull
  };
  /// Throws nothing; without a target its number stays where it starts.
  StrengthSearch(std::optional<Target> angle, std::optional<Target> cohesion, StrengthPoint start);

  StrengthPoint at() const { return trials_.empty() ? start_ : next_; }
  /// What the trial at() has come to [deg], [kPa]. Returns whether another one is worth while, then at the new at().
  bool tried(double angle, double cohesion);
  /// The trial that came nearest, by the greater of both distances in tolerances; to the bit, for who compares soils.
  StrengthPoint nearest() const;

private:
  using Two = std::array<double, 2>;
  struct Done {
    StrengthPoint where;
    Two x, off; ///< in units: where, and what is missing
  };
  double farOff(const Done& trial) const;
  void learn(const Done& before, const Done& now);
  Two stepFrom(const Done& trial) const;

  std::array<std::optional<Target>, 2> targets_;
  Two unit_{1, 1};                                  ///< of way and pull
  std::array<Two, 2> slopes_{Two{1, 0}, Two{0, 1}}; ///< of both results over both numbers, in units
  StrengthPoint start_, next_;
  std::vector<Done> trials_;
};

struct CalibrationCommand {
  std::filesystem::path targets;
  double grainRadius = 0; ///< [m]; 0: the file's
  jobs::StudyPlace place; ///< folder empty: out/calibrate_NAME
  jobs::PieceOptions pieces;
  int jobs = 1;
  PlanOptions plan;
  std::string words; ///< the whole command line
};
void calibrateCommand(const CalibrationCommand& command);

/// A soil file.
std::string soilFileText(const TestedSoil& soil, const std::string& description, const SoilResults& reached,
                         const std::string& command);

} // namespace grouser::virtual_tests
