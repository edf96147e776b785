// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground.hpp"
#include "scm/pad_contacts.hpp"
#include "terrain/height_field.hpp"

#include <memory>

namespace grouser::coupling {

/// Options of a deformable ground by Bekker's and Janosi's relations, the soil contact model (SCM).
struct ScmSetup {
  scm::SoilConstants soil;
  double spacing{}; ///< of the nodes [m]
  double deepest{}; ///< sinkage up to which the pressure is tabulated [m]

  /// Greatest slope of unloading under shoes of this width [Pa/m], on soil that has sunk by 0.1 mm to 0.1 m.
  double stiffest(double breadth) const;
};

/// Deformable ground: the plates of track shoes sink into it, compact and shear it; ruts stay. The hull meets the
/// undisturbed surface as rigid ground.
class ScmGround : public Ground {
public:
  /// `surface`, as laid, outlives it.
  ScmGround(const ScmSetup& setup, const terrain::HeightField& surface);

  std::function<double(double, double)> surface() const override;
  GroundTraits traits() const override;
  double clearance(const vehicle::Assembly&) const override { return 0; }
  LoadQuanta meet(const PartsOnGround& parts) override;
  void computeOnHost(const contact::PartMotion* motion, contact::PartLoad* loads) override;
  void addContactsTo(ContactLedger& ledger) const override;
  std::vector<double> surfaceNow() const override;
  void restore(const SimulationState& state) override;
  void save(SimulationState& state) const override;

  const scm::PadContacts& contacts() const { return *contacts_; } ///< after meet()
  const scm::SoilMap& soil() const { return map_; }

private:
  ScmSetup setup_;
  const terrain::HeightField& laid_;
  scm::SoilMap map_;
  std::unique_ptr<scm::PadContacts> contacts_;
  std::vector<double> saved_; ///< of a simulation that goes on, until meet()
  LoadQuanta quanta_;
  double timeStep_{};
};

} // namespace grouser::coupling
