// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"
#include "runs/scene/scene.hpp"

#include <string>
#include <vector>

/// Variations of a scene by `grouser check`.
namespace grouser::sweeps {

/// Numerical or unknown setting on which results should not depend.
enum class CheckAxis { base, step, skin, depth, width, floor, grainSize, spheres, precision, nodeSpacing, parameter };
inline constexpr CheckAxis kCheckAxes[] = {
    CheckAxis::step,      CheckAxis::skin,    CheckAxis::depth,     CheckAxis::width,       CheckAxis::floor,
    CheckAxis::grainSize, CheckAxis::spheres, CheckAxis::precision, CheckAxis::nodeSpacing, CheckAxis::parameter};
/// Axis by its word in --axes. Throws InputError that lists all words.
CheckAxis checkAxisOf(const std::string& word);

/// A variation of the scene, run with several seeds.
struct CheckCase {
  CheckAxis axis = CheckAxis::base;
  std::string name;                   ///< in folder names and tables: "step_over_2"
  std::string what;                   ///< "time step 5e-05 s"
  std::vector<std::string> overrides; ///< "key=value"
  int refinement = 0;                 ///< time step = 2^-refinement times that of the base
  double cost = 1;     ///< cost of the steps over that of the base, from the numbers of steps and grains [-]
  double settling = 1; ///< cost of settling the bed over that of the base [-]
  std::string refused; ///< reason why the case is invalid; empty if valid
};

/// Axis that does not apply to the scene, with the reason.
struct CheckOmission {
  CheckAxis axis;
  std::string why;
};

struct CheckCases {
  bool seeded = false;          ///< whether results depend on run.seed
  std::vector<CheckCase> cases; ///< the base first, then by priority
  std::vector<CheckOmission> omitted;
};

/// The cases of a scene. `file` and `fixed`: scene file and overrides, to load variants.
///
/// step: h/2 and 2 h; h/2, h/4, h/8, 2 h, 4 h without seed dependence. Output times are the same.
/// With run.tolerance, the tolerance is varied instead.
/// depth, width (along y): + 50 % of a granular terrain; no width if a plane, box, cylinder or mesh stands beside the
/// bed. floor: smooth instead of rough, or vice versa. grain size: radii x 0.8 in the same soil; stiffness of
/// linear contacts and cohesion shrink with the radius, so that strains and strength stay (C. Thakur et al., 2015).
/// spheres: half the radius, in vehicle and meshes. skin: 1.5 times. precision: single or double.
/// node spacing: half, deformable soil only. parameter: `draws` samples of the soil constants, one case each.
/// Throws InputError for draws in a scene without such constants.
CheckCases checkCases(const std::filesystem::path& file, const std::vector<std::string>& fixed,
                      const scene::Scene& scene, int draws = 0);

/// Approximate cost of a full check with `seeds` seeds, in runs of the scene [-]; loads nothing.
double runsOfWholeCheck(const scene::Scene& scene, int seeds);
/// The same for the cases that contribute to error bars; a check with --of runs them with three seeds first.
double runsOfBarCases(const scene::Scene& scene, int seeds);

/// Whether results depend on run.seed: random beds, fills, lattice shifts, rough floors, sources.
bool seedMatters(const scene::Scene& scene);

} // namespace grouser::sweeps

template <> struct grouser::base::EnumWords<grouser::sweeps::CheckAxis> {
  using E = sweeps::CheckAxis;
  static constexpr EnumWord<E> list[] = {{E::base, "base"},
                                         {E::step, "step"},
                                         {E::skin, "skin"},
                                         {E::depth, "depth"},
                                         {E::width, "width"},
                                         {E::floor, "floor"},
                                         {E::grainSize, "grain_size"},
                                         {E::spheres, "spheres"},
                                         {E::precision, "precision"},
                                         {E::nodeSpacing, "node_spacing"},
                                         {E::parameter, "parameter"}};
};
