// SPDX-License-Identifier: BSD-3-Clause
#include "runs/storage/kept_frictions.hpp"

#include "runs/support/kept_json.hpp"

#include <nlohmann/json.hpp>

namespace grouser::storage {

constexpr auto kFriction = support::KeptFiles::Kind::friction;

std::optional<double> KeptFrictions::find(const std::string& origin) const {
  const nlohmann::json json = support::keptJson(files_, kFriction, origin);
  if (!json.is_object() || !json.contains("friction") || !json["friction"].is_number()) return {};
  const double friction = json["friction"].get<double>();
  return friction > 0 ? std::optional(friction) : std::nullopt;
}

void KeptFrictions::keep(const std::string& origin, double friction) const {
  support::keepJson(files_, kFriction, origin, nlohmann::json::object({{"friction", friction}}));
}

} // namespace grouser::storage
