// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/ledger.hpp"

#include "base/error.hpp"

namespace grouser::coupling {

namespace {

/// Calls visit(number) for all accumulated values.
template <class Self, class Visit> void forCounted(Self& l, const Visit& visit) {
  visit(l.driveWork), visit(l.kinetic), visit(l.potential), visit(l.elastic), visit(l.grainElastic);
  for (const DissipationCause& cause : kDissipationCauses) visit(l.dissipated.*cause.heat);
  visit(l.work), visit(l.turnover);
  for (auto* v : {&l.momentumResidual, &l.angularResidual}) visit(v->x), visit(v->y), visit(v->z);
}

} // namespace

std::vector<double> Ledger::counted() const {
  std::vector<double> numbers;
  forCounted(*this, [&](double x) { numbers.push_back(x); });
  return numbers;
}

void Ledger::setCounted(const std::vector<double>& numbers) {
  if (numbers.size() != counted().size())
    throw base::InputError("the checkpoint's energy ledger has a different layout; resume with the program version "
                           "that wrote it");
  std::size_t k = 0;
  forCounted(*this, [&](double& x) { x = numbers[k++]; });
}

void Ledger::countFrom(const Ledger& start) {
  const std::vector<double> from = start.counted();
  std::size_t k = 0;
  forCounted(*this, [&](double& x) { x -= from[k++]; });
  integrationError = driveWork - dissipated.total() - work - potential - elastic;
  residual = kinetic - work;
}

void Ledger::move(const Ledger& before, const Ledger& after) {
  const std::vector<double> then = before.counted(), now = after.counted();
  std::size_t k = 0;
  forCounted(*this, [&](double& x) { x += now[k] - then[k], ++k; });
}

} // namespace grouser::coupling
