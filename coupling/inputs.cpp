// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/inputs.hpp"

#include "base/bits.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <iterator>

namespace grouser::coupling {

std::array<double, Input::kNumbers> Input::numbers() const {
  std::array<double, kNumbers> n{static_cast<double>(step), static_cast<double>(kind), static_cast<double>(target),
                                 released ? 1.0 : 0.0};
  std::copy(value.begin(), value.end(), n.begin() + 4);
  return n;
}

Input Input::of(const double* n) {
  constexpr auto kKinds = static_cast<double>(std::size(base::EnumWords<InputKind>::list));
  if (!(n[0] >= 0) || !(n[1] >= 0) || !(n[1] < kKinds))
    throw base::InputError("unknown kind of input; resume or replay with the program version that wrote it");
  Input input{static_cast<std::int64_t>(n[0]),
              static_cast<InputKind>(static_cast<int>(n[1])),
              static_cast<std::int32_t>(n[2]),
              n[3] != 0,
              {}};
  std::copy(n + 4, n + kNumbers, input.value.begin());
  return input;
}

int width(InputKind kind) {
  if (kind == InputKind::bodyLoad) return 6;
  return kind == InputKind::gravity ? 3 : 1;
}

void Inputs::set(const Input& input) {
  act(input);
  for (auto i = series_.rbegin(); i != series_.rend() && i->step == input.step; ++i)
    if (i->kind == input.kind && i->target == input.target) {
      *i = input;
      return;
    }
  series_.push_back(input);
}

void Inputs::act(const Input& input) {
  const auto before = [](const Input& a, const Input& b) {
    return a.kind != b.kind ? a.kind < b.kind : a.target < b.target;
  };
  const auto at = std::lower_bound(acting_.begin(), acting_.end(), input, before);
  const bool there = at != acting_.end() && !before(input, *at);
  if (input.released) {
    if (there) acting_.erase(at);
  } else if (there) {
    *at = input;
  } else {
    acting_.insert(at, input);
  }
}

std::optional<std::array<double, 6>> Inputs::now(InputKind kind, std::int32_t target) const {
  for (const Input& i : acting_)
    if (i.kind == kind && i.target == target) return i.value;
  return {};
}

std::vector<std::uint64_t> Inputs::words() const {
  std::vector<std::uint64_t> words;
  for (const Input& i : acting_) {
    words.push_back(static_cast<std::uint64_t>(i.kind) << 32 | static_cast<std::uint32_t>(i.target));
    for (const double v : i.value) words.push_back(base::bitsAs<std::uint64_t>(v));
  }
  return words;
}

std::vector<double> Inputs::save() const {
  std::vector<double> numbers;
  for (const Input& i : series_) {
    const auto n = i.numbers();
    numbers.insert(numbers.end(), n.begin(), n.end());
  }
  return numbers;
}

void Inputs::restore(const std::vector<double>& saved) {
  if (saved.size() % Input::kNumbers != 0)
    throw base::InputError(
        "the inputs in the checkpoint are incomplete; resume with the program version that wrote it");
  series_.clear(), acting_.clear();
  for (std::size_t k = 0; k < saved.size(); k += Input::kNumbers) set(Input::of(saved.data() + k));
}

} // namespace grouser::coupling
