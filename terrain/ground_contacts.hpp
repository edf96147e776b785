// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/patch_contacts.hpp"
#include "terrain/feet_search.hpp"
#include "terrain/searched_height_field.hpp"

namespace grouser::terrain {

/// Contacts of rigid parts with rigid ground that follows a height-field.
class GroundContacts {
public:
  struct Model {
    contact::PatchLaw law;
    contact::PatchQuanta quanta;
    double timeStep{};
    double margin{}; ///< [m]
  };
  /// `parts`: which parts (indices into motions and loads) may touch the ground.
  GroundContacts(const base::Exec& exec, const Model& model, const HeightField& ground,
                 const std::vector<const base::SphereSet*>& sets, const std::vector<int>& setOfPart,
                 const std::vector<int>& parts);

  void refresh(const base::Array<contact::PartMotion>& motion);
  /// `travelled`, on the device: no part has moved farther than this since the refresh [m]; at most the margin.
  void compute(const base::Array<contact::PartMotion>& motion, const double* travelled, contact::PartLoad* loads);

  std::size_t samplesListed() const { return buffers_.entries; }
  contact::PatchBuffers::Ledger ledger() const { return buffers_.ledger(model_.quanta); }
  contact::SavedPatches save() const { return buffers_.save(); }
  void restore(const contact::SavedPatches& saved) { buffers_.restore(saved); }

  struct Target {
    const int* part;
    const int* setOfPart;
    const double* reach;
    HeightFieldView ground;
    contact::PatchLaw patchLaw;
    int pairs;

    GROUSER_HD int partA(int p) const { return part[p]; }
    GROUSER_HD int partB(int) const { return -1; }
    GROUSER_HD contact::PatchLaw law(int) const { return patchLaw; }
    GROUSER_HD bool near(int p, const contact::PartMotion* motion, double margin) const {
      return !ground.clearOf(motion[part[p]].origin, reach[setOfPart[part[p]]] + margin);
    }
    template <class Group> GROUSER_HD bool findContact(int, const contact::PartMotion*, const base::Vec3d& x,
                                                       double radius, const Group&, base::Vec3d& normal,
                                                       double& overlap) const {
      FootPoint foot;
      if (ground.clearOf(x, radius) || !deepestFoot(ground, x, radius, foot)) return false;
      overlap = radius - foot.distance;
      normal = foot.normal;
      return overlap > 0;
    }
  };

private:
  Target target() const;

  Model model_;
  contact::PatchBuffers buffers_;
  base::Array<int> parts_;
  base::Array<double> reach_;
  SearchedHeightField ground_;
};

} // namespace grouser::terrain
