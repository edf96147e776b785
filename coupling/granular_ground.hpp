// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/grains_on_parts.hpp"
#include "coupling/ground.hpp"
#include "coupling/laid_ground.hpp"

namespace grouser::coupling {

/// Granular ground: a bed under a vehicle, or grains in a container, in a mixer, or alone. The ranks share the grains.
class GranularGround : public Ground {
public:
  /// `laid`, which must contain grains, and `setup` must outlive this object.
  GranularGround(LaidGround& laid, const GroundSetup& setup, const base::Exec& exec)
      : laid_(laid), setup_(setup), exec_(exec) {}

  void restore(const SimulationState& state) override;
  std::function<double(double, double)> surface() const override { return surfaceHeight(laid_); }
  double clearance(const vehicle::Assembly& assembly) const override;
  GroundTraits traits() const override;
  LoadQuanta meet(const PartsOnGround& parts) override;
  void restoreContacts(const ContactsState& state) override { onParts_->restore(state); }
  bool refreshLists() override { return grains().refreshNeighbours(); }
  void refreshContacts(const base::Array<contact::PartMotion>& motion) override { onParts_->refresh(motion); }
  void beginUncoupled() override;
  const void* buffer() const override { return grains().view().position; }
  void compute(const base::Exec& exec, const base::Array<contact::PartMotion>& motion, const double* travelled,
               contact::PartLoad* loads) override;
  void collect(const contact::PartLoad& own) override { onParts_->countEnded(own.force.x); }
  void solve(contact::BodyResponse& bodies) override;
  void beginStep() override;
  void endStep() override { grains().endStep(); }
  void setGravity(const base::Vec3d& gravity) override;
  void addTo(Ledger& ledger) override;
  void addContactsTo(ContactLedger& ledger) const override { onParts_->addTo(ledger); }
  ListedContacts listed() const override { return {0, onParts_->contacts().pairs()}; }
  std::vector<double> surfaceNow() const override;
  void restartMeans() override;
  void save(SimulationState& state) const override;
  void saveContacts(ContactsState& state) const override { onParts_->save(state); }

  // Functions specific to granular ground.
  terrain::Grains& grains() const { return *laid_.grains; }
  GrainsOnParts* onParts() const { return onParts_.get(); } ///< null until meet() is called
  /// Sets the loads of the scene's meshes, which must outlive this object; null without meshes.
  void meetMeshes(const contact::GrainLoadsView* loads) { onMeshes_ = loads; }

private:
  LaidGround& laid_;
  const GroundSetup& setup_;
  base::Exec exec_;
  std::unique_ptr<GrainsOnParts> onParts_;
  const contact::GrainLoadsView* onMeshes_{nullptr};
  terrain::ImpulseParts solved_; ///< arguments of the complementarity solver
  bool begun_{false};            ///< solve() has begun the step
};

} // namespace grouser::coupling
