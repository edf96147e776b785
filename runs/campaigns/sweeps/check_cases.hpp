// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"
#include "runs/scene/scene.hpp"

#include <string>
#include <vector>

/// Variations of a scene that `grouser check` runs.
namespace grouser::sweeps {

/// Numerical or uncertain setting on which results should not depend.
enum class CheckAxis { base, step, skin, depth, width, floor, grainSize, spheres, precision, nodeSpacing, parameter };
inline constexpr CheckAxis kCheckAxes[] = {
    CheckAxis::step,      CheckAxis::skin,    CheckAxis::depth,     CheckAxis::width,       CheckAxis::floor,
    CheckAxis::grainSize, CheckAxis::spheres, CheckAxis::precision, CheckAxis::nodeSpacing, CheckAxis::parameter};
/// Axis with this name in --axes. Throws InputError, with a list of the names, for an unknown name.
CheckAxis checkAxisOf(const std::string& word);

/// A variation of the scene, run with several seeds.
struct CheckCase {
  CheckAxis axis = CheckAxis::base;
  std::string name;                   ///< name in folder names and tables: "step_over_2"
  std::string what;                   ///< description: "time step 5e-05 s"
  std::vector<std::string> overrides; ///< "key=value"
  int refinement = 0;                 ///< time step = 2^-refinement times the step of the base
  double cost = 1;     ///< cost of the steps / cost of the base's steps, from numbers of steps and grains [-]
  double settling = 1; ///< cost of settling the bed / that cost for the base [-]
  std::string refused; ///< reason why the case is invalid; empty if valid
};

/// Axis that is not varied, with the reason.
struct CheckOmission {
  CheckAxis axis;
  std::string why;
};

struct CheckCases {
  bool seeded = false;          ///< whether results depend on run.seed
  std::vector<CheckCase> cases; ///< base first, the others by priority
  std::vector<CheckOmission> omitted;
};

/// The cases of a scene. `file` and `fixed`: scene file and overrides, to load variants.
///
/// step: h/2 and 2 h; without seed dependence h/2, h/4, h/8, 2 h, 4 h. All cases have the same output times.
/// With run.tolerance, varies the tolerance instead.
/// depth, width (along y): + 50 % of a granular bed; no width case if a plane, box, cylinder or mesh is beside the
/// bed. floor: smooth instead of rough, or vice versa. grain size: radii x 0.8 in the same soil; stiffness of linear
/// contacts and cohesion are scaled with the radius, which preserves strains and strength (C. Thakur et al., 2015).
/// spheres: half the sphere radius in vehicle and meshes. skin: x 1.5. precision: the other of single and double.
/// node spacing: half, deformable soil only. parameter: `draws` samples of the soil constants, one case each.
/// Throws InputError for `draws` in a scene without such constants.
CheckCases checkCases(const std::filesystem::path& file, const std::vector<std::string>& fixed,
                      const scene::Scene& scene, int draws = 0);

/// Approximate cost of a full check with `seeds` seeds / cost of a run of the scene [-]. Reads no files.
double runsOfWholeCheck(const scene::Scene& scene, int seeds);
/// The same for the cases that contribute to error bars, which a check with --of runs first, with three seeds.
double runsOfBarCases(const scene::Scene& scene, int seeds);

/// Whether results depend on run.seed: true with random beds, fills, lattice shifts, rough floors or sources.
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
