// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground.hpp"
#include "coupling/laid_ground.hpp"
#include "terrain/rigid_contacts.hpp"

namespace grouser::coupling {

/// Rigid ground with the surface of a height map: an elastic foundation under each shoe; an obstacle for the hull.
class RigidGround : public Ground {
public:
  /// `laid` must have a rigid height field and outlive this object.
  explicit RigidGround(const LaidGround& laid) : laid_(laid) {}

  std::function<double(double, double)> surface() const override { return surfaceHeight(laid_); }
  GroundTraits traits() const override;
  LoadQuanta meet(const PartsOnGround& parts) override;
  void computeOnHost(const contact::PartMotion* motion, contact::PartLoad* loads) override {
    feet_->compute(motion, loads);
  }
  void collect(const contact::PartLoad&) override;
  void addContactsTo(ContactLedger& ledger) const override;
  void saveContacts(ContactsState& state) const override;
  void restoreContacts(const ContactsState& state) override;

private:
  const LaidGround& laid_;
  const ContactParts* parts_ = nullptr;
  std::unique_ptr<terrain::RigidContacts> feet_; ///< null until meet() is called
};

} // namespace grouser::coupling
