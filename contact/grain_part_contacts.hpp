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
/// The list contains all pairs of a grain and a part closer than a margin. In every step, each pair looks up one cell
/// in the part's table. Grain loads are integers; parts receive exactly the opposite.
///
/// Each rank computes the pairs of its own grains; the part loads are then this rank's partial sums.
class GrainPartContacts {
public:
  /// `sets`: unique sphere sets; `parts`: instances of them.
  GrainPartContacts(const base::Exec& exec, const GrainPartModel& model,
                    const std::vector<const base::SphereSet*>& sets, std::vector<GrainPart> parts,
                    const base::Comm& comm = {}, const GrainPartMaterials& materials = {});

  /// Callback for terrain::GrainDistribution::onMigrate(): sends the history of pairs with their grains. Call refresh()
  /// before the next compute(). Collective.
  void migrate(const std::uint32_t* destination);

  /// Lists the pairs of the grains in their current slots; restores the history by grain id and part.
  void refresh(const GrainsView& grains, const base::Array<PartMotion>& motion);

  /// Adds the contact loads of this step to `loads`: one entry per part and, if grains crush, an extra entry. Its
  /// force.x counts the pairs with a grain crushed to its centre.
  void compute(const GrainsView& grains, const base::Array<PartMotion>& motion, PartLoad* loads) {
    computeOn(exec_, grains, motion, loads);
  }
  /// Same as compute(), on a side stream.
  void computeOn(const base::Exec& exec, const GrainsView& grains, const base::Array<PartMotion>& motion,
                 PartLoad* loads);
  /// Same, for work launched ahead, after clearing clearedSums() and clearedCount(). `off`: see base::Gate.
  void computeOnCleared(const base::Exec& exec, const GrainsView& grains, const base::Array<PartMotion>& motion,
                        PartLoad* loads, const std::uint32_t* off);
  /// Replaces compute() with complementarity contacts: returns the surfaces near each listed grain for their solver.
  /// `loads`: as in compute(). Clear clearedSums() before each step. Valid until the next refresh.
  PartPatches patches(const GrainsView& grains, const base::Array<PartMotion>& motion, PartLoad* loads);
  /// Contact laws of all grain materials with all part materials; see GrainPart::firstLaw.
  const std::vector<ContactLaw>& laws() const { return scaledLaws_; }
  const GrainPartModel& model() const { return model_; }
  /// Device memory to clear before each step.
  base::Parcel clearedSums();
  base::Parcel clearedCount();

  /// Loads for the grain step; valid until the next refresh.
  GrainLoadsView grainLoads();

  /// Computes contact moments at the current positions of grains and parts; requires refreshed pairs. No side effects.
  /// Valid until the next call or refresh.
  PartMomentsView measure(const GrainsView& grains, const base::Array<PartMotion>& motion);

  std::size_t pairs() const { return pairs_; }
  /// Parts in contact with a grain at the last compute, over all ranks; collective.
  struct Press {
    int part;
    float overlap; ///< [m]
  };
  std::vector<Press> pressing(std::uint32_t grain) const;
  /// Grain and part in contact at the last compute.
  struct Touch {
    std::uint32_t grain;
    int part;
  };
  /// Returns the contacts of all ranks, sorted by grain, then part; collective. Slow, since it visits all listed pairs.
  std::vector<Touch> touching() const;
  /// Ids of the grains crushed to their centre at the last compute, ascending, over all ranks; collective.
  std::vector<std::uint32_t> ended() const;
  /// Removes contacts of grains that are deleted before the next step; their energy counts as dissipated by crushing.
  /// Call refresh() before the next compute. Collective.
  void takeOut(const std::vector<std::uint32_t>& ids);
  bool crush() const { return crushes_; }
  /// Grain with the largest overlap / radius since resetDeepestOverlap(), over all ranks.
  struct MostPressed {
    int part;
    std::uint32_t grain;
    double share; ///< overlap / radius [-]
  };
  std::optional<MostPressed> mostPressed() const;
  void resetDeepestOverlap();
  struct Ledger {
    std::int64_t contacts{};             ///< patches in contact at the last compute
    std::int64_t squeezed{};             ///< pairs deeper than kDeepOverlap at the last compute
    double elastic{};                    ///< elastic energy of their springs at the last compute [J]
    double damped{}, rubbed{}, rolled{}; ///< cumulative dissipation by dashpots, sliding, rolling resistance [J]
    double slipped{};                    ///< cumulative dissipation by stiffness changes of Hertz springs [J]
    double crushed{};                    ///< cumulative dissipation by crushing [J]
    double cutImpulse{};                 ///< cumulative impulse removed by the crushing force cap [N s]
    std::int64_t capped{};               ///< patches at the crushing force at the last compute
    base::Vec3d impulseOnGrains;         ///< cumulative impulse [N s] of the loads applied to the grains
  };
  Ledger ledger() const; ///< sums over all ranks; collective
  /// State of all ranks, for hashes and checkpoints; collective. restore() throws InputError if the state belongs to
  /// other parts; call refresh() before the next compute.
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
  /// Selection of pairs that this rank stores.
  enum class Held {
    listed,     ///< pairs of its own grains, with their slots
    migrated,   ///< pairs of its own grains, some without slots until the next refresh
    everywhere, ///< all pairs of the scene, identical on every rank: after a restore
  };
  Held held_{Held::everywhere};
  std::unique_ptr<Exchange> exchange_;
  base::Array<std::uint32_t> range_, count_, slot_, oldIndex_;
  static constexpr std::size_t kNearCount = 2; ///< words before the list; the first is the number of near pairs
  base::Array<std::uint32_t> near_;            ///< empty below searchFrom_ pairs
  std::size_t searchFrom_{0};                  ///< minimum number of pairs for the search
  base::Array<std::uint64_t> key_, oldKey_;
  base::Array<PatchMemory> memory_, oldMemory_;
  bool rolling_, crushes_;
  base::Array<base::Vec3f> angle_,
      oldAngle_;                         ///< rolling angles [rad] of the memories; empty without rolling friction
  base::Array<float> dent_, oldDent_;    ///< dents [m], parallel to the memories; empty if no grain crushes
  base::Array<std::int64_t> energyHeld_; ///< spring energy per pair [quanta]; empty if no grain crushes
  base::Array<BasicLaw<float>> laws_;    ///< one per material
  base::Array<Crushing> crushing_;       ///< one per material; empty if none crushes
  base::Array<double> massPerCube_;
  unsigned features_;
  bool allHertz_{true}; ///< true if every law is Hertz
  base::Array<GrainLoad> load_;
  base::Array<ContactMoment> moments_; ///< [pair]; empty until measure() is called
  base::Array<std::int64_t> sums_;     ///< [kPartSums]
  base::Array<std::uint64_t> deepest_; ///< [part] key since resetDeepestOverlap(): see pressKey()
};

} // namespace grouser::contact
