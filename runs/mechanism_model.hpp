// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"
#include "multibody/model.hpp"
#include "runs/mechanism_sections.hpp"

#include <string>
#include <vector>

/// From the sections of a scene file to the model that multibody/ solves.
namespace grouser::runs {

/// What is wrong with one key of a section; who reads the file adds its place and the key's value.
class SectionFault : public base::InputError {
public:
  SectionFault(std::string key, const std::string& message) : InputError(message), key_(std::move(key)) {}
  const std::string& key() const { return key_; }

private:
  std::string key_;
};

/// Adds section after section and checks each against what has been added so far. Throws SectionFault.
class MechanismBuilder {
public:
  void add(const BodySection& body);
  void add(const JointSection& joint);
  void add(const SpringSection& spring);
  void add(const DriveSection& drive);

  const multibody::Model& model() const { return model_; }

private:
  /// Index of a body by name; "world" is multibody::kWorld.
  int body(const std::string& key, const std::string& name) const;
  int axisJoint(const std::string& key, const std::string& name) const;
  void checkName(const std::string& kind, const std::string& name);

  multibody::Model model_;
  std::vector<std::pair<std::string, std::string>> names_; ///< kind, name
};

multibody::Model buildModel(const MechanismSections& sections);

/// Throws SectionFault, for key "" of joint `joint`, where the velocities of its two bodies at the start do not go
/// together with it. Velocities must agree to 1e-5 of their size.
void checkStartVelocity(const multibody::Model& model, int joint);

/// Value of a drive at time `t` [s]: linear between the points of its table, constant outside.
double driveValue(const DriveSection& drive, double t);

} // namespace grouser::runs
