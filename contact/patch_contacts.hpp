// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/carry.hpp"
#include "contact/part_motion.hpp"
#include "contact/part_surface.hpp"
#include "contact/patch_buffers.hpp"
#include "contact/patch_law.hpp"

#include <vector>

namespace grouser::contact {

/// Candidate pair of parts; `a` is represented by its samples, `b` by its table of discs.
struct PartPair {
  int a{}, b{}; ///< part indices
};

/// Finds the deepest contact of a ball at world point `x` with a part; `grid` contains its discs. Sets outward normal
/// and overlap [m]. Returns false if there is no contact. The threads of `group` share the search.
template <class Group> GROUSER_HD bool deepestDisc(const SurfaceGridView& grid, const PartMotion& part,
                                                   const base::Vec3d& x, double radius, const Group& group,
                                                   base::Vec3d& normal, double& overlap) {
  const base::Vec3d local = part.toPart(x);
  const std::int64_t cell = grid.cellAt(local);
  if (cell < 0) return false;
  const std::uint32_t last = grid.start[cell + 1];
  std::uint32_t deepest = last;
  overlap = 0;
  for (std::uint32_t k = grid.start[cell] + static_cast<std::uint32_t>(group.rank); k < last; k += Group::width) {
    const Disc& disc = grid.disc[grid.entry[k]];
    if (outOfReach(disc, local, radius)) continue;
    const double depth =
        radius + static_cast<double>(disc.radius) - static_cast<double>(distanceTo(disc, local).distance);
    if (depth > overlap) overlap = depth, deepest = k;
  }
  group.agreeOnGreatest(overlap, deepest);
  if (overlap <= 0) return false;
  const base::Vec3f outward = distanceTo(grid.disc[grid.entry[deepest]], local).normal;
  normal = part.rotation * outward.as<double>();
  return true;
}

/// Contacts between rigid parts made of spheres: track shoes against sprocket, wheels, rollers and idler.
class PartPartContacts {
public:
  struct Model {
    PatchLaw law;
    PatchQuanta quanta;
    double timeStep{};
    double margin{}; ///< maximum gap of listed samples [m]
  };
  /// `sets`: unique sphere sets; `setOfPart`: index of each part's set.
  PartPartContacts(const base::Exec& exec, const Model& model, const std::vector<const base::SphereSet*>& sets,
                   const std::vector<int>& setOfPart, const std::vector<PartPair>& pairs);

  /// Lists the samples within the margin, at the current poses of the parts.
  void refresh(const base::Array<PartMotion>& motion);
  /// Adds this step's contact loads to `loads` (one per part). `travelled`: upper bound of the relative motion of any
  /// two parts since the refresh [m]; at most the margin.
  void compute(const base::Array<PartMotion>& motion, const double* travelled, PartLoad* loads);
  /// Same, for work launched ahead, after clearing clearedSums(). `off`: see base::Gate.
  void computeOnCleared(const base::Exec& exec, const base::Array<PartMotion>& motion, const double* travelled,
                        PartLoad* loads, const std::uint32_t* off);
  /// Device sums of the last compute; clear before the next one.
  base::Parcel clearedSums() { return {buffers_.sums.data(), nullptr, buffers_.sums.size() * sizeof(PatchSums)}; }

  std::size_t samplesListed() const { return buffers_.entries; }
  PatchBuffers::Ledger ledger() const { return buffers_.ledger(model_.quanta); }
  SavedPatches save() const { return buffers_.save(); }
  void restore(const SavedPatches& saved) { buffers_.restore(saved); }

  /// Surfaces of the pairs, as plain data for kernels.
  struct Target {
    const PartPair* pair;
    const SurfaceGridView* grids; ///< by set
    const int* setOfPart;
    const double* reach; ///< by set: bounding radius [m]
    PatchLaw patchLaw;
    int pairs;

    GROUSER_HD int partA(int p) const { return pair[p].a; }
    GROUSER_HD int partB(int p) const { return pair[p].b; }
    GROUSER_HD PatchLaw law(int) const { return patchLaw; }
    GROUSER_HD bool near(int p, const PartMotion* motion, double margin) const {
      const double r = reach[setOfPart[pair[p].a]] + reach[setOfPart[pair[p].b]] + margin;
      return norm2(motion[pair[p].a].origin - motion[pair[p].b].origin) < r * r;
    }
    template <class Group> GROUSER_HD bool findContact(int p, const PartMotion* motion, const base::Vec3d& x,
                                                       double radius, const Group& group, base::Vec3d& normal,
                                                       double& overlap) const {
      const int b = pair[p].b;
      return deepestDisc(grids[setOfPart[b]], motion[b], x, radius, group, normal, overlap);
    }
  };

private:
  Target target() const;

  Model model_;
  PatchBuffers buffers_;
  std::vector<SurfaceGrid> grids_;
  base::Array<SurfaceGridView> gridViews_;
  base::Array<PartPair> pairs_;
  base::Array<double> reach_;
};

} // namespace grouser::contact
