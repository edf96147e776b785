// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/host_patches.hpp"
#include "contact/part_surface.hpp"
#include "contact/point_tree.hpp"
#include "contact/whole_contact.hpp"
#include "terrain/faces_in_part.hpp"
#include "terrain/foot_lanes.hpp"
#include "terrain/height_field_cells.hpp"
#include "terrain/rigid_surface.hpp"
#include "terrain/searched_height_field.hpp"

#include <optional>
#include <vector>

namespace grouser::terrain {

/// Contacts of rigid parts with rigid surfaces: height field, planes, boxes, cylinders, capsules, meshes. A surface may
/// move, e.g. as the shape of another part. Surface points of the part press on an elastic foundation. Runs on the host
/// in SIMD lanes of eight points, without contact lists.
class RigidContacts {
public:
  /// Rigid surface. Its pose is stored with the motions of the parts.
  struct Surface {
    enum class Kind { shape, mesh, field };
    Kind kind{};
    SurfaceGeometry geometry; ///< geometry of a closed-form shape
    int set{-1};              ///< sphere set of a mesh
    int motion{-1};           ///< index of its motion and load; -1: a height field whose load is not needed
  };
  /// Candidate pair of part and surface.
  struct Pair {
    int part{}, surface{};
    contact::PatchLaw law;
  };
  struct Model {
    contact::PatchQuanta quanta;
    double timeStep{};
    std::vector<contact::PartBody> bodies{}; ///< by motion, for laws damped as a whole; motions beyond are at rest
  };
  /// Contact whose overlap exceeds PatchLaw::largestOverlap.
  struct TooDeep {
    int part, surface;
    double overlap; ///< [m]
    Vec3d place;    ///< in the world [m]
    double most;    ///< [m]
  };
  /// `points`: by set; `setOfPart`: point set of each part; `meshes`: sphere sets of meshes, by Surface::set; `field`:
  /// null without a height-field surface.
  RigidContacts(const Model& model, std::vector<contact::PointTree> points, const std::vector<int>& setOfPart,
                const std::vector<Surface>& surfaces, const std::vector<Pair>& pairs,
                const std::vector<const base::SphereSet*>& meshes, const HeightField* field);

  /// Adds the loads of this step to parts and, with opposite sign, to surfaces.
  void compute(const contact::PartMotion* motion, contact::PartLoad* loads);

  /// The deepest contact of the last step relative to its limit, if it exceeds the limit.
  const std::optional<TooDeep>& tooDeep() const { return tooDeep_; }

  contact::PatchBuffers::Ledger ledger() const { return patches_.ledger(); }
  contact::SavedPatches save() const { return patches_.save(); }
  void restore(const contact::SavedPatches& saved) { patches_.restore(saved); }

private:
  struct Press;
  const contact::PointTree& treeOf(int part) const {
    return points_[static_cast<std::size_t>(setOfPart_[static_cast<std::size_t>(part)])];
  }
  void press(std::size_t pair, const contact::PartMotion* motion, contact::PartLoad* loads);
  void addWhole(std::size_t pair, int cluster, const Press& press, const contact::PartMotion* motion);
  void pressWhole(const contact::PartMotion* motion, contact::PartLoad* loads);
  void pressNodes(Press& press, std::uint32_t from, std::uint32_t to) const;
  void pressBlock(Press& press, const contact::PointBlock& block) const;
  void pressOnPlane(Press& press, const Plane& plane, std::uint32_t from, std::uint32_t to) const;
  bool mayTouch(const Press& press, const contact::PointTree::Node& node, std::optional<Plane>& plane) const;
  bool mayTouch(const Surface& surface, const contact::PartMotion* motion, const base::Vec3d& x, double radius) const;
  bool touches(const Surface& surface, const contact::PartMotion* motion, const base::Vec3d& x, double radius,
               base::Vec3d& normal, double& overlap) const;
  bool gapsOf(const contact::PointBlock& block, const Surface& surface, const contact::PartMotion* motion,
              const contact::PartMotion& part, contact::Vec3P& normal, contact::PointLanes& overlap) const;
  std::optional<Plane> planeOf(const Surface& surface, const contact::PartMotion* motion,
                               const contact::PartMotion& part) const;

  Model model_;
  std::vector<contact::PointTree> points_;
  std::vector<int> setOfPart_;
  std::vector<Surface> surfaces_;
  std::vector<Pair> pairs_;
  std::vector<contact::SurfaceGrid> grids_; ///< by set of meshes
  SearchedHeightField field_;
  HeightFieldCells cells_;
  FootLanes feet_;
  std::optional<Plane> fieldPlane_; ///< set if the whole height field is planar
  contact::HostPatches patches_;
  std::optional<TooDeep> tooDeep_;
  std::vector<const contact::PointBlock*> touched_; ///< scratch of one step
  contact::FoundationSums wholePlanar_{};           ///< scratch of one patch
  contact::FoundationLanes wholeOther_;             ///< scratch of one patch
  std::vector<contact::WholePatch> whole_;          ///< scratch of one step
  std::vector<contact::DampedPatch> damped_;        ///< scratch of one step
};

} // namespace grouser::terrain
