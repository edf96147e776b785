// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/patch_contacts.hpp"
#include "terrain/feet_search.hpp"
#include "terrain/rigid_surface.hpp"
#include "terrain/searched_height_field.hpp"

#include <vector>

namespace grouser::terrain {

/// Largest sample radius of all parts [m].
double widestSample(const std::vector<const base::SphereSet*>& sets, const std::vector<int>& setOfPart);

/// Contacts of rigid parts with the rigid surfaces of a scene: planes, boxes, cylinders, meshes, and for some parts a
/// height-field. As GroundContacts: samples of the part, an elastic foundation.
class SurfaceContacts {
public:
  /// One of the surfaces. Its place and motion stand among the motions of the parts.
  struct Surface {
    enum class Kind { shape, mesh, field };
    Kind kind{};
    SurfaceGeometry geometry; ///< of a shape
    int set{-1};              ///< of a mesh: its sphere set
    int motion{};             ///< its place among motions and loads
    double friction{};        ///< [-] against all parts
  };
  /// A part that may touch a surface.
  struct Pair {
    int part{}, surface{};
  };
  struct Model {
    contact::PatchLaw law; ///< but for its friction
    contact::PatchQuanta quanta;
    double timeStep{};
    double margin{}; ///< [m]
  };
  /// `sets`: unique sphere sets of parts and meshes; `setOfPart`: which one each part has; `field`: null where no
  /// surface is one.
  SurfaceContacts(const base::Exec& exec, const Model& model, const std::vector<const base::SphereSet*>& sets,
                  const std::vector<int>& setOfPart, const std::vector<Surface>& surfaces,
                  const std::vector<Pair>& pairs, const HeightField* field);

  /// Lists the samples within the margin, at the present places of parts and surfaces.
  void refresh(const base::Array<contact::PartMotion>& motion);
  /// Adds this step's loads, opposite ones to part and surface. `travelled`, on the device: no part has moved farther
  /// than this since the refresh [m]; at most the margin. The surfaces rest.
  void compute(const base::Array<contact::PartMotion>& motion, const double* travelled, contact::PartLoad* loads);

  std::size_t samplesListed() const { return buffers_.entries; }
  contact::PatchBuffers::Ledger ledger() const { return buffers_.ledger(model_.quanta); }
  contact::SavedPatches save() const { return buffers_.save(); }
  void restore(const contact::SavedPatches& saved) { buffers_.restore(saved); }

  /// How pairs find their surfaces; plain data for kernels.
  struct Target {
    const Pair* pair;
    const Surface* surfaces;
    const contact::SurfaceGridView* grids; ///< by set
    const int* setOfPart;
    const double* reach; ///< by set: enclosing radius [m]
    HeightFieldView field;
    contact::PatchLaw patchLaw;
    int pairs;

    GROUSER_HD const Surface& surface(int p) const { return surfaces[pair[p].surface]; }
    GROUSER_HD int partA(int p) const { return pair[p].part; }
    GROUSER_HD int partB(int p) const { return surface(p).motion; }
    GROUSER_HD contact::PatchLaw law(int p) const {
      contact::PatchLaw law = patchLaw;
      law.friction = surface(p).friction;
      return law;
    }
    GROUSER_HD bool near(int p, const contact::PartMotion* motion, double margin) const {
      const Surface& s = surface(p);
      const base::Vec3d& x = motion[pair[p].part].origin;
      const double within = reach[setOfPart[pair[p].part]] + margin;
      if (s.kind == Surface::Kind::field) return !field.clearOf(x, within);
      if (s.kind == Surface::Kind::shape) return gapTo(s.geometry, motion[s.motion].toPart(x)).distance < within;
      const double both = within + reach[s.set];
      return norm2(x - motion[s.motion].origin) < both * both;
    }
    template <class Group> GROUSER_HD bool findContact(int p, const contact::PartMotion* motion, const base::Vec3d& x,
                                                       double radius, const Group& group, base::Vec3d& normal,
                                                       double& overlap) const {
      const Surface& s = surface(p);
      if (s.kind == Surface::Kind::field) {
        if (field.clearOf(x, radius)) return false;
        FootPoint foot;
        if (!deepestFoot(field, x, radius, foot)) return false;
        overlap = radius - foot.distance, normal = foot.normal;
        return overlap > 0;
      }
      const contact::PartMotion& at = motion[s.motion];
      if (s.kind == Surface::Kind::mesh)
        return contact::deepestDisc(grids[s.set], at, x, radius, group, normal, overlap);
      const SurfaceGap gap = gapTo(s.geometry, at.toPart(x));
      overlap = radius - gap.distance, normal = at.rotation * gap.normal;
      return overlap > 0;
    }
  };

private:
  Target target() const;

  Model model_;
  contact::PatchBuffers buffers_;
  base::Array<Pair> pairs_;
  base::Array<Surface> surfaces_;
  std::vector<contact::SurfaceGrid> grids_;
  base::Array<contact::SurfaceGridView> gridViews_;
  base::Array<double> reach_;
  SearchedHeightField field_;
};

} // namespace grouser::terrain
