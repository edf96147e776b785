// SPDX-License-Identifier: BSD-3-Clause
// Checks the options of `grouser study plates` for all cases before any of them runs.
#include "base/error.hpp"
#include "runs/validation/studies/plates.hpp"

#include <fmt/format.h>

namespace grouser::studies {

namespace {

constexpr double kNarrowest = 3.5;      // minimum width / largest diameter: 3, plus the margin of the neighbour list
constexpr double kLatticeHeight = 5.05; // [d] height of the five layers of a lattice

/// Names of the options that determine a case.
struct Names {
  std::string breadth = "--breadth", bin = "--strip-bin", depth = "--strip-depth";
  explicit Names(const PlateCase& plate) {
    if (plate.test.shape == virtual_tests::PlateShape::circular) bin = "--circular-bin", depth = "--circular-depth";
    if (plate.test.young > 0) breadth = "--fine-breadth";
  }
};

/// Checks of a case; lengths in mean grain diameters.
class CaseCheck {
public:
  CaseCheck(const PlateCase& plate, const virtual_tests::Soil& soil)
      : name_(plate.name), test_(plate.test), names_(plate), preparation_(plate.test.preparation(soil)),
        deeper_(plate.timesDeeper), wider_(plate.timesWider),
        coarsest_(plate.test.lattice ? 1 : preparation_.coarsest(soil)), largest_(coarsest_ * (1 + soil.spread)),
        bin_(preparation_.size.length / soil.grains.diameter()),
        height_(plate.test.lattice ? kLatticeHeight : preparation_.size.depth / soil.grains.diameter()) {}

  void check() const {
    checkWidth();
    checkFineDepth();
    checkDepth();
    checkSinkage();
  }

private:
  [[noreturn]] void fail(const std::string& option, double value, const std::string& unit,
                         const std::string& why) const {
    throw base::InputError(fmt::format("{} {:g} [{}], case {}: {}", option, value, unit, name_, why));
  }

  /// No grain may touch two periodic images of another grain.
  void checkWidth() const {
    const double least = kNarrowest * largest_;
    if (bin_ < least)
      fail(names_.bin, test_.bin / wider_, "plate widths",
           fmt::format("the boundaries are {:g} d apart, but the largest grains need {:.3g} d; use at least {:.3g}, or "
                       "increase {} from {:g} d",
                       bin_, least, least / test_.breadth / wider_, names_.breadth, test_.breadth));
    const bool isStrip = test_.shape == virtual_tests::PlateShape::strip;
    if (isStrip && test_.thickness < least)
      fail(test_.young > 0 ? "--fine-thickness" : "--strip-thickness", test_.thickness, "d",
           fmt::format("the largest grains require {:.3g} d between the periodic boundaries; increase this value",
                       least));
  }

  void checkFineDepth() const {
    if (test_.coarsening > 0 && test_.fineDepth >= test_.depth)
      fail("--fine-depth", test_.fineDepth, "plate widths",
           fmt::format(
               "no part of the bed would have coarser grains; use less than the bed depth, {} = {:g} plate widths",
               names_.depth, test_.depth));
  }

  /// The porosity is measured away from floor and surface.
  void checkDepth() const {
    const double least = 1 + virtual_tests::PlateTest::kOffEnds * (1 + coarsest_);
    if (!test_.lattice && height_ < least)
      fail(names_.depth, test_.depth / deeper_, "plate widths",
           fmt::format("the bed is {:g} d deep; this is too thin to measure its porosity {:g} d away from floor and "
                       "surface; use at least {:.3g}, or increase {} from {:g} d",
                       height_, virtual_tests::PlateTest::kOffEnds, least / test_.breadth / deeper_, names_.breadth,
                       test_.breadth));
  }

  /// The plate must stay above the floor.
  void checkSinkage() const {
    const double most = (height_ - largest_) / test_.breadth;
    if (test_.sinkage <= most) return;
    const std::string remedy =
        test_.lattice ? fmt::format("a smaller {} than {:g} d", names_.breadth, test_.breadth)
                      : fmt::format("a bed deeper than {} = {:g} plate widths", names_.depth, test_.depth / deeper_);
    fail("--sinkage", test_.sinkage, "plate widths",
         fmt::format(
             "the plate would come closer to the floor than the largest grain diameter; use at most {:.3g}, or {}",
             most, remedy));
  }

  std::string name_;
  virtual_tests::PlateTest test_;
  Names names_;
  virtual_tests::BedPreparation preparation_;
  double deeper_, wider_;     // factors on the options [-]
  double coarsest_, largest_; // [d] mean and largest diameter at the floor
  double bin_, height_;       // [d]
};

} // namespace

void checkPlates(const std::vector<PlateCase>& cases, const virtual_tests::Soil& soil) {
  for (const PlateCase& plate : cases) CaseCheck(plate, soil).check();
}

} // namespace grouser::studies
