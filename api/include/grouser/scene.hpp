// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <grouser/types.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace grouser {

namespace detail {
struct Run;
struct SceneData;
void setInstalledShare(const char* folder);
#if defined(GROUSER_INSTALLED_PATH) && !defined(GROUSER_INSTALLED_SHARE) // from pkg-config, whose words have no quotes
#define GROUSER_TEXT_OF(...) #__VA_ARGS__
#define GROUSER_TEXT(...) GROUSER_TEXT_OF(__VA_ARGS__)
#define GROUSER_INSTALLED_SHARE GROUSER_TEXT(GROUSER_INSTALLED_PATH)
#endif
#ifdef GROUSER_INSTALLED_SHARE // from the target grouser::grouser: folder of vehicles, soils and height-maps
inline const bool kShareIsKnown = (setInstalledShare(GROUSER_INSTALLED_SHARE), true);
#endif
} // namespace detail

/// A scene from a file or TOML text, with overrides. docs/keys.md lists all keys. Every setter validates the whole
/// scene; if the scene would become invalid, the setter throws InputError and changes nothing. Copies are cheap.
class Scene {
public:
  /// Reads a scene file; later changes of the file have no effect.
  static Scene fromFile(const std::filesystem::path& file);
  /// Reads a scene from TOML text. Paths in the text are relative to `folder`; assets are found by name as for a scene
  /// file. Messages use the name `file`.
  static Scene fromText(std::string_view toml, const std::filesystem::path& folder = ".",
                        const std::string& file = "scene.toml");

  /// Sets a key by its full name, e.g. set("driver.sprocket_speed", 1.5) or set("material.soil.friction", 0.6).
  Scene& set(std::string_view key, double value);
  Scene& set(std::string_view key, bool value);
  template <class Integer>
  requires(std::is_integral_v<Integer> && !std::is_same_v<Integer, char>) Scene& set(std::string_view key,
                                                                                     Integer value) {
    return put(key, std::to_string(value));
  }
  Scene& set(std::string_view key, const char* value);
  Scene& set(std::string_view key, std::string_view value);
  Scene& set(std::string_view key, const std::vector<double>& values);

  /// Sets several keys and validates the scene once, for keys that depend on each other:
  /// {"driver.left=1", "driver.right=2"}, in the syntax of `grouser run --set`.
  Scene& set(const std::vector<std::string>& assignments);

  std::string name() const;
  double duration() const;      ///< run.duration [s]; Simulation::step() can continue beyond this time
  std::string resolved() const; ///< the scene as TOML, including all defaults

private:
  friend struct detail::Run;
  explicit Scene(std::shared_ptr<const detail::SceneData> data) : data_(std::move(data)) {}
  Scene& put(std::string_view key, std::string value);
  std::shared_ptr<const detail::SceneData> data_;
};

} // namespace grouser
