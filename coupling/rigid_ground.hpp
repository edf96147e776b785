// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground.hpp"
#include "coupling/laid_ground.hpp"
#include "terrain/ground_contacts.hpp"

namespace grouser::coupling {

/// Rigid ground that follows a height-map: an elastic foundation under each shoe. The hull meets it with the obstacles.
class RigidGround : public Ground {
public:
  /// `laid`, which has a rigid height-field, outlives it.
  RigidGround(const LaidGround& laid, const base::Exec& exec) : laid_(laid), exec_(exec) {}

  std::function<double(double, double)> surface() const override { return surfaceHeight(laid_); }
  GroundTraits traits() const override;
  LoadQuanta meet(const PartsOnGround& parts) override;
  void refreshContacts(const base::Array<contact::PartMotion>& motion) override { shoes_->refresh(motion); }
  void compute(const base::Exec& exec, const base::Array<contact::PartMotion>& motion, const double* travelled,
               contact::PartLoad* loads) override;
  void addContactsTo(ContactLedger& ledger) const override;
  ListedContacts listed() const override { return {shoes_->samplesListed(), 0}; }
  void saveContacts(VehicleState& state) const override;
  void restoreContacts(const VehicleState& state) override;

private:
  const LaidGround& laid_;
  base::Exec exec_;
  std::unique_ptr<terrain::GroundContacts> shoes_; ///< null without a vehicle
};

} // namespace grouser::coupling
