// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/simd_rows.hpp"
#include "terrain/grain_kernel_data.cuh"

namespace grouser::terrain::detail {

using base::Double4;
using base::Float4;
using base::Int4;
using base::load;
using base::Simd;
using base::store;

/// What grains of one block are booked with: GrainStep::book(), four grains side by side. One by one each would wait
/// for the one before.
template <unsigned kFeatures> class BlockBooks {
public:
  static constexpr bool kManySizes = kFeatures & kManyRadii;
  static constexpr int kGrains = 64;

  GROUSER_SIMD explicit BlockBooks(const GrainKernelData& data) : data_(data) {}

  GROUSER_SIMD void begin() { waiting_ = 0; }
  /// `work`: by axis; `massShare`: of the mass of the model.
  GROUSER_SIMD void add(const Double4& work, const Lost& lost, const Int4& place, double massShare) {
    workOf_[waiting_] = work, workOf_[waiting_][3] = lost.damped;
    rubbedOf_[waiting_] = lost.rubbed, rolledOf_[waiting_] = lost.rolled, placeOf_[waiting_] = place;
    if (kManySizes) shareOf_[waiting_] = massShare;
    ++waiting_;
  }

  /// Books what was added since begin().
  GROUSER_SIMD void bookAll() {
    booked_ += waiting_;
    for (int g = waiting_; g % 4 != 0; ++g)
      workOf_[g] = Double4{}, rubbedOf_[g] = rolledOf_[g] = shareOf_[g] = 0, placeOf_[g] = Int4{};
    for (int g = 0; g < waiting_; g += 4) {
      Double4 work[4] = {workOf_[g], workOf_[g + 1], workOf_[g + 2], workOf_[g + 3]};
      base::transpose(work); // by axis; what is damped
      const double perEnergy = data_.bookScale.perEnergy;
      const Double4 all = (work[0] + work[2]) + work[1];
      work_ += wholeOf(all * perEnergy), turnover_ += wholeOf((all < 0.0 ? -all : all) * perEnergy);
      damped_ += wholeOf(work[3] * perEnergy);
      if (kFeatures & contact::kFriction) rubbed_ += wholeOf(load<Double4>(rubbedOf_ + g) * perEnergy);
      if (kFeatures & contact::kRollingFriction) rolled_ += wholeOf(load<Double4>(rolledOf_ + g) * perEnergy);
      Int4 place[4] = {placeOf_[g], placeOf_[g + 1], placeOf_[g + 2], placeOf_[g + 3]};
      base::transpose(place);
      const auto share = load<Double4>(shareOf_ + g);
      if (kManySizes) mass_ += wholeOf(share * static_cast<double>(kMassQuanta));
      for (int a = 0; a < 3; ++a) {
        const Long4 u = axisOf(place[a], place[3], a);
        moment_[a] += kManySizes ? wholeOf(share * toDouble(u)) : u;
      }
    }
  }

  /// Of all that was booked.
  GROUSER_SIMD void addTo(GrainBooks& books) const {
    for (int l = 0; l < 4; ++l) {
      books.of[kWork] += work_[l], books.of[kTurnover] += turnover_[l];
      books.of[kDamped] += damped_[l], books.of[kRubbed] += rubbed_[l], books.of[kRolled] += rolled_[l];
      for (int a = 0; a < 3; ++a) books.of[kMoment + a] += moment_[a][l];
      books.of[kMass] += mass_[l];
    }
    if (!kManySizes) books.of[kMass] += booked_ * kMassQuanta;
  }

private:
  using Long4 = Simd<std::int64_t, 4>;

  /// wholeQuanta() of four.
  GROUSER_SIMD static Long4 wholeOf(Double4 quanta) {
    const Double4 most = base::broadcast<Double4>(0x1p51), shift = base::broadcast<Double4>(0x1.8p52);
    quanta = quanta > -most ? quanta : -most;
    quanta = quanta < most ? quanta : most;
    return base::bitsAs<Long4>(quanta + shift) - base::bitsAs<Long4>(shift);
  }
  /// base::axisOf() of four places.
  GROUSER_SIMD static Long4 axisOf(const Int4& low, const Int4& high, int axis) {
    const Int4 top = high << (22 - 10 * axis) >> 22;
    return base::convert<std::int64_t>(top) << 32 |
           base::convert<std::int64_t>(base::bitsAs<Simd<std::uint32_t, 4>>(low));
  }
  /// Exact: coordinates have 42 bits.
  GROUSER_SIMD static Double4 toDouble(const Long4& u) {
    const Double4 shift = base::broadcast<Double4>(0x1.8p52);
    return base::bitsAs<Double4>(u + base::bitsAs<Long4>(shift)) - shift;
  }

  const GrainKernelData& data_;
  Long4 work_{}, turnover_{}, damped_{}, rubbed_{}, rolled_{}, mass_{}, moment_[3] = {};
  std::int64_t booked_ = 0; ///< grains
  int waiting_ = 0;
  Double4 workOf_[kGrains]; ///< by axis, and what is damped
  double rubbedOf_[kGrains], rolledOf_[kGrains], shareOf_[kGrains];
  Int4 placeOf_[kGrains];
};

} // namespace grouser::terrain::detail
