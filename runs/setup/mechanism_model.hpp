// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/model.hpp"
#include "runs/scene/mechanism_structs.hpp"
#include "runs/support/section_fault.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace grouser::vehicle {
struct Assembly;
}

/// Builds the multibody model from the sections of a scene file.
namespace grouser::setup {

/// Adds sections, and checks each one against the earlier sections. Throws SectionFault.
class MechanismBuilder {
public:
  MechanismBuilder() = default;
  /// Begins with the vehicle's parts; "vehicle" names its chassis.
  explicit MechanismBuilder(const vehicle::Assembly& vehicle);
  void add(const scene::BodySection& body);
  void add(const scene::JointSection& joint);
  void add(const scene::SpringSection& spring);
  void add(const scene::BushingSection& bushing);
  void add(const scene::DriveSection& drive);
  void add(const scene::CouplingSection& coupling);

  const multibody::Model& model() const { return model_; }

private:
  // Indices by name; "world" is multibody::kWorld. `key`: key that contains the name.
  int body(const std::string& key, const std::string& name) const;
  int joint(const std::string& key, const std::string& name) const;
  std::pair<int, int> twoBodies(const std::vector<std::string>& names) const;
  /// The named axis of a joint, or its only axis.
  multibody::JointAxis axis(int index, const std::string& key, std::optional<multibody::JointAxis> named) const;
  base::Pose pose(int index) const;
  void checkName(const std::string& kind, const std::string& name);
  void addOnAxis(const scene::SpringSection& spring);
  void addBetweenPoints(const scene::SpringSection& spring);

  multibody::Model model_;
  std::map<std::string, int> bodies_, joints_;
  std::set<std::string> names_; ///< "body rod"
};

/// `vehicle`: the model begins with its parts; may be null.
multibody::Model buildModel(const scene::MechanismSections& sections, const vehicle::Assembly* vehicle = nullptr);

/// Throws SectionFault, with key "", if the initial velocities of the two bodies of joint `index` violate the joint by
/// more than 1e-5 of their magnitude.
void checkStartVelocity(const multibody::Model& model, int index);

} // namespace grouser::setup
