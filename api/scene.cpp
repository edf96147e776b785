// SPDX-License-Identifier: BSD-3-Clause
#include <grouser/scene.hpp>

#include "api/detail/run.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/support/locations.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace grouser {

namespace {

std::string textOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::shared_ptr<const detail::SceneData> loaded(std::optional<std::string> text, const std::filesystem::path& file,
                                                std::vector<std::string> overrides) {
  return detail::translated([&] {
    auto data = std::make_shared<detail::SceneData>();
    data->scene = text ? setup::parseScene(*text, file, overrides) : setup::loadScene(file, overrides);
    data->text = text ? std::move(*text) : textOf(file);
    data->file = file, data->overrides = std::move(overrides);
    return std::shared_ptr<const detail::SceneData>(std::move(data));
  });
}

std::string quoted(std::string_view text) {
  std::string all = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') all += '\\';
    all += c;
  }
  return all + '"';
}

} // namespace

Scene Scene::fromFile(const std::filesystem::path& file) { return Scene(loaded({}, file, {})); }

Scene Scene::fromText(std::string_view toml, const std::filesystem::path& folder, const std::string& file) {
  return Scene(loaded(std::string(toml), folder / file, {}));
}

/// Appends an override; removes an earlier override of the same key.
Scene& Scene::put(std::string_view key, std::string value) {
  std::vector<std::string> overrides = data_->overrides;
  const std::string begin = std::string(key) + '=';
  overrides.erase(std::remove_if(overrides.begin(), overrides.end(),
                                 [&](const std::string& o) { return o.compare(0, begin.size(), begin) == 0; }),
                  overrides.end());
  overrides.push_back(begin + std::move(value));
  data_ = loaded(data_->text, data_->file, std::move(overrides));
  return *this;
}

Scene& Scene::set(std::string_view key, double value) { return put(key, fmt::format("{}", value)); }
Scene& Scene::set(std::string_view key, bool value) { return put(key, value ? "true" : "false"); }
Scene& Scene::set(std::string_view key, const char* value) { return put(key, quoted(value)); }
Scene& Scene::set(std::string_view key, std::string_view value) { return put(key, quoted(value)); }

Scene& Scene::set(std::string_view key, const std::vector<double>& values) {
  std::string list = "[";
  for (const double v : values) list += fmt::format("{}{}", list.size() > 1 ? ", " : "", v);
  return put(key, list + "]");
}

Scene& Scene::set(const std::vector<std::string>& assignments) {
  std::vector<std::string> overrides = data_->overrides;
  overrides.insert(overrides.end(), assignments.begin(), assignments.end());
  data_ = loaded(data_->text, data_->file, std::move(overrides));
  return *this;
}

void detail::setInstalledShare(const char* folder) { support::setInstalledShare(folder); }

std::string Scene::name() const { return data_->scene.name(); }
double Scene::duration() const { return data_->scene.run.duration; }
std::string Scene::resolved() const {
  return detail::translated([&] { return setup::provenanceOf(data_->scene).resolved; });
}

} // namespace grouser
