// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"
#include "runs/scene/scene.hpp"

#include <string>
#include <vector>

/// What `grouser check` varies in a scene.
namespace grouser::sweeps {

/// One setting that no user chooses for its own sake, and on which no answer should depend.
enum class CheckAxis { base, step, skin, depth, width, floor, grainSize, spheres, precision, nodeSpacing, parameter };
inline constexpr CheckAxis kCheckAxes[] = {
    CheckAxis::step,      CheckAxis::skin,    CheckAxis::depth,     CheckAxis::width,       CheckAxis::floor,
    CheckAxis::grainSize, CheckAxis::spheres, CheckAxis::precision, CheckAxis::nodeSpacing, CheckAxis::parameter};
/// The axis of such a word, of --axes. Throws InputError that names them all.
CheckAxis checkAxisOf(const std::string& word);

/// One run of a check, but for its seed.
struct CheckCase {
  CheckAxis axis = CheckAxis::base;
  std::string name;                   ///< of its runs' folders, and in tables: "step_over_2"
  std::string what;                   ///< "time step 5e-05 s"
  std::vector<std::string> overrides; ///< "key=value"
  int refinement = 0;                 ///< of the step: it is 2^-refinement of the base's
  double cost = 1;     ///< of a run's steps over those of the base, from the numbers of steps and grains [-]
  double settling = 1; ///< of its bed's settling over that of the base's, likewise [-]
  std::string refused; ///< why it cannot be run; empty where it can
};

/// Why an axis is no question of this scene.
struct CheckOmission {
  CheckAxis axis;
  std::string why;
};

struct CheckCases {
  bool seeded = false;          ///< whether run.seed makes a difference
  std::vector<CheckCase> cases; ///< the base first, then in the order in which they are worth their time
  std::vector<CheckOmission> omitted;
};

/// The cases of a scene. `file` and `fixed`: what it was loaded from, to load it again with one thing changed.
///
/// step: h/2 and 2 h; h/2, h/4, h/8, 2 h, 4 h where seeds make no difference. Steps fall on the same output times.
/// A scene with run.tolerance has that varied instead.
/// depth, width: + 50 %, width along y, of a granular terrain; no width where a plane, box, cylinder or mesh stands at
/// the bed's sides, for it would stay where it is. floor: smooth instead of rough, and the other way.
/// grain size: radii x 0.8 in the same soil; stiffness of linear contacts and cohesion shrink with the radius, so that
/// strains and strength stay (C. Thakur et al., 2015).
/// spheres: those of vehicle and meshes at half their radius. skin: 1.5 times. precision: the other one.
/// node spacing: half, of deformable soil. parameter: `draws` samples of its constants, each a case.
/// Throws InputError where constants are to be drawn and the scene has none.
CheckCases checkCases(const std::filesystem::path& file, const std::vector<std::string>& fixed,
                      const scene::Scene& scene, int draws = 0);

/// About what a whole check of so many seeds costs, in runs of the scene [-]; loads nothing.
double runsOfWholeCheck(const scene::Scene& scene, int seeds);
/// The same of all cases that have a part in bars, which a check with --of runs with three seeds first.
double runsOfBarCases(const scene::Scene& scene, int seeds);

/// Whether run.seed makes a difference: random beds, fills, shifts of lattices, rough floors, sources.
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
