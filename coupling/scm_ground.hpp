// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground.hpp"
#include "scm/soil_contacts.hpp"
#include "terrain/height_field.hpp"

#include <memory>

namespace grouser::coupling {

/// Options of the soil contact model (SCM).
struct ScmSetup {
  scm::SoilConstants soil;
  scm::Displacement displacement;
  double spacing{}; ///< spacing of the nodes [m]
  double deepest{}; ///< maximum sinkage of the pressure table [m]

  /// Maximum unloading stiffness under a loaded area of width `breadth` [Pa/m], for sinkages of 0.1 mm to 0.1 m.
  double stiffest(double breadth) const;
};

/// Deformable soil under track shoes and bodies, with persistent ruts. For the hull the undisturbed surface is rigid.
/// See the folder scm/ for the soil model.
class ScmGround : public Ground {
public:
  /// `surface`: initial surface; must outlive this object.
  ScmGround(const ScmSetup& setup, const terrain::HeightField& surface);

  std::function<double(double, double)> surface() const override;
  GroundTraits traits() const override;
  LoadQuanta meet(const PartsOnGround& parts) override;
  void computeOnHost(const contact::PartMotion* motion, contact::PartLoad* loads) override;
  void addContactsTo(ContactLedger& ledger) const override;
  std::vector<double> surfaceNow() const override;
  std::optional<GroundFields> fieldsNow() const override;
  void restore(const SimulationState& state) override;
  void save(SimulationState& state) const override;

  const scm::SoilContacts& contacts() const { return *contacts_; } ///< valid after meet()

private:
  ScmSetup setup_;
  const terrain::HeightField& laid_;
  scm::SoilMap map_;
  std::unique_ptr<scm::SoilContacts> contacts_;
  std::vector<double> saved_; ///< state to restore in meet(); empty in a new simulation
  LoadQuanta quanta_;
};

} // namespace grouser::coupling
