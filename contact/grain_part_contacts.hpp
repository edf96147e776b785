// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/carry.hpp"
#include "base/comm.hpp"
#include "base/position.hpp"
#include "contact/contact_law.hpp"
#include "contact/contact_moment.hpp"
#include "contact/crushing.hpp"
#include "contact/exchange.hpp"
#include "contact/grain_loads.hpp"
#include "contact/grain_part_model.hpp"
#include "contact/grains_view.hpp"
#include "contact/part_motion.hpp"
#include "contact/part_surface.hpp"
#include "contact/saved_contacts.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace grouser::contact {

template <unsigned kFeatures> struct GrainPartForces;
struct PartPatches;

/// Contacts of grains with rigid parts made of spheres.
///
/// Pairs of grain and part that may touch are listed with a margin; every step each listed pair looks up one cell of
/// the part's table. The grains get their loads as integers, the parts exactly the opposite.
///
/// Each rank computes the pairs of its own grains; the loads on the parts are then this rank's share.
class GrainPartContacts {
public:
  /// `sets`: the unique sphere sets; `parts`: instances of them.
  GrainPartContacts(const base::Exec& exec, const GrainPartModel& model,
                    const std::vector<const base::SphereSet*>& sets, std::vector<GrainPart> parts,
                    const base::Comm& comm = {}, const GrainPartMaterials& materials = {});

  /// For terrain::GrainDistribution::onMigrate(): sends the history of pairs to where their grains go. Refresh before
  /// the next compute. All ranks call it.
  void migrate(const std::uint32_t* destination);

  /// Lists the pairs for grains in their present slots; history is restored by grain id and part.
  void refresh(const GrainsView& grains, const base::Array<PartMotion>& motion);

  /// Adds the contact loads of this step to `loads`: one per part and, if grains crush, one more, whose force.x counts
  /// the pairs whose grain is crushed to its middle.
  void compute(const GrainsView& grains, const base::Array<PartMotion>& motion, PartLoad* loads) {
    computeOn(exec_, grains, motion, loads);
  }
  /// The same on a side stream.
  void computeOn(const base::Exec& exec, const GrainsView& grains, const base::Array<PartMotion>& motion,
                 PartLoad* loads);
  /// The same for work launched ahead, after clearing clearedSums() and clearedCount(). `off`: see base::Gate.
  void computeOnCleared(const base::Exec& exec, const GrainsView& grains, const base::Array<PartMotion>& motion,
                        PartLoad* loads, const std::uint32_t* off);
  /// Returns the surfaces near each listed grain, for the solver of complementarity contacts, which replaces compute().
  /// `loads`: as in compute(). Clear clearedSums() before each step. Valid until the next refresh.
  PartPatches patches(const GrainsView& grains, const base::Array<PartMotion>& motion, PartLoad* loads);
  /// Contact laws of all part materials with all grain materials; see GrainPart::firstLaw.
  const std::vector<ContactLaw>& laws() const { return scaledLaws_; }
  const GrainPartModel& model() const { return model_; }
  /// Device memory to clear before each step.
  base::Parcel clearedSums();
  base::Parcel clearedCount();

  /// Loads for the grains' step; valid until the next refresh.
  GrainLoadsView grainLoads();

  /// Contact moments at the present positions of grains and parts; refresh the pairs first. No side effects. Valid
  /// until the next call or refresh.
  PartMomentsView measure(const GrainsView& grains, const base::Array<PartMotion>& motion);

  std::size_t pairs() const { return pairs_; }
  /// Parts in contact with a grain in the last compute, over all ranks; collective.
  struct Press {
    int part;
    float overlap; ///< [m]
  };
  std::vector<Press> pressing(std::uint32_t grain) const;
  /// A grain and a part in contact at the last compute.
  struct Touch {
    std::uint32_t grain;
    int part;
  };
  /// Sorted by grain, then part, over all ranks; collective. Visits all listed pairs: for output rows, not for steps.
  std::vector<Touch> touching() const;
  /// Ids of the grains crushed to their middle in the last compute, ascending, over all ranks; collective.
  std::vector<std::uint32_t> ended() const;
  /// Removes contacts of grains that are deleted before the next step: their energy counts as dissipated by crushing.
  /// Refresh before the next compute. Collective.
  void takeOut(const std::vector<std::uint32_t>& ids);
  bool crush() const { return crushes_; }
  /// The grain with the largest overlap over radius since resetDeepestOverlap(), over all ranks.
  struct MostPressed {
    int part;
    std::uint32_t grain;
    double share; ///< of its radius [-]
  };
  std::optional<MostPressed> mostPressed() const;
  void resetDeepestOverlap();
  struct Ledger {
    std::int64_t contacts{};             ///< patches in contact at the last compute
    std::int64_t squeezed{};             ///< pairs deeper than kSqueezed then
    double elastic{};                    ///< held in their springs [J]
    double damped{}, rubbed{}, rolled{}; ///< dissipated by dashpots, sliding, rolling resistance since the start [J]
    double slipped{};                    ///< the same by changes of the stiffness of Hertz springs [J]
    double crushed{};                    ///< the same by crushing [J]
    double cutImpulse{};                 ///< impulse removed by the crushing force cap since the start [N s]
    std::int64_t capped{};               ///< patches at the crushing force at the last compute
    base::Vec3d impulseOnGrains;         ///< since the start [N s], from the loads the grains were given
  };
  Ledger ledger() const; ///< of all ranks, which all call it
  /// State over all ranks, for hashes and checkpoints; collective. restore() throws InputError if the state is of other
  /// parts; refresh before the next compute.
  SavedGrainPatches save() const;
  void restore(const SavedGrainPatches& saved);
  std::size_t bytes() const;

private:
  template <unsigned kFeatures> GrainPartForces<kFeatures>
  forcesOf(const GrainsView& grains, const base::Array<PartMotion>& motion, PartLoad* loads, const std::uint32_t* off);
  std::vector<std::int64_t> allSums() const;
  std::vector<std::uint64_t> allDeepest() const;
  std::vector<ExchangeField> history();

  base::Exec exec_;
  base::Comm comm_;
  GrainPartModel model_;
  std::vector<ContactLaw> scaledLaws_;
  std::vector<SurfaceGrid> grids_;
  std::size_t partCount_;
  base::Array<SurfaceGridView> gridViews_;
  base::Array<GrainPart> parts_;
  std::size_t pairs_{0};
  /// Set of pairs on this rank.
  enum class Held {
    listed,     ///< those of its own grains, with their slots
    migrated,   ///< those of its own grains, some without slots: the next refresh finds them
    everywhere, ///< all pairs of the scene, the same on every rank: after a restore
  };
  Held held_{Held::everywhere};
  std::unique_ptr<Exchange> exchange_;
  base::Array<std::uint32_t> range_, count_, slot_, oldIndex_;
  static constexpr std::size_t kNearCount = 2; ///< words before the list; the first counts near pairs
  base::Array<std::uint32_t> near_;            ///< empty below searchFrom_ pairs
  std::size_t searchFrom_{0};                  ///< pairs
  base::Array<std::uint64_t> key_, oldKey_;
  base::Array<PatchMemory> memory_, oldMemory_;
  bool rolling_, crushes_;
  base::Array<base::Vec3f> angle_,
      oldAngle_;                         ///< rolling angles [rad] beside the memories; empty without rolling friction
  base::Array<float> dent_, oldDent_;    ///< [m] beside the memories; empty where no grain crushes
  base::Array<std::int64_t> energyHeld_; ///< of each pair [quanta]; empty where no grain crushes
  base::Array<BasicLaw<float>> laws_;    ///< by material
  base::Array<Crushing> crushing_;       ///< by material; empty where none crushes
  base::Array<double> massPerCube_;
  unsigned features_;
  bool allHertz_{true}; ///< every law
  base::Array<GrainLoad> load_;
  base::Array<ContactMoment> moments_; ///< [pair]; empty until measure() is called
  base::Array<std::int64_t> sums_;     ///< [kPartSums]
  base::Array<std::uint64_t> deepest_; ///< by part, since resetDeepestOverlap()
};

} // namespace grouser::contact
