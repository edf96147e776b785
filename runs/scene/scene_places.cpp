// SPDX-License-Identifier: BSD-3-Clause
// File positions of a loaded scene's sections and keys.
#include "base/table.hpp"
#include "runs/scene/scene.hpp"

#include <fmt/format.h>

namespace grouser::scene {

void Scene::fail(const std::string& section, const std::string& key, const std::string& message) const {
  if (document && document->root().has(section)) document->root().section(section).fail(key, message);
  throw base::InputError(fmt::format("{}: {}{}{} {}", file.string(), section, key.empty() ? "" : ".", key, message));
}

void Scene::fail(const std::string& list, std::size_t number, const std::string& key,
                 const std::string& message) const {
  if (document)
    if (const std::vector<base::Section> all = document->root().list(list); number < all.size())
      all[number].fail(key, message);
  throw base::InputError(
      fmt::format("{}: {}.{}{}{} {}", file.string(), list, number, key.empty() ? "" : ".", key, message));
}

void Scene::failMaterial(const std::string& name, const std::string& key, const std::string& message) const {
  if (document)
    for (const auto& [known, section] : document->root().named("material"))
      if (known == name) section.fail(key, message);
  throw base::InputError(fmt::format("{}: material.{}.{} {}", file.string(), name, key, message));
}

std::string Scene::placeOf(const std::string& list, std::size_t number) const {
  if (document)
    if (const std::vector<base::Section> all = document->root().list(list); number < all.size())
      return fmt::format("{}: {}", all[number].origin(), all[number].path());
  return fmt::format("{}: {}.{}", file.string(), list, number);
}

} // namespace grouser::scene
