// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/detail/section_entry.hpp"

/// The sections of a scene file by subject, each list in the order in which its sections are read, written and
/// described. A new section requires a struct and a member in scene.hpp, and an entry in one of these lists; a new key
/// requires a member and a line in the section's table.
namespace grouser::scene::detail {

SectionList runSections();
SectionList materialSections();
SectionList grainSections();
SectionList surfaceSections();
SectionList terrainSections();
SectionEntry scmSection();
SectionList mechanismSections();
SectionList vehicleSections();
SectionList hitchSections();
SectionList fluidSections();
SectionList outputSections();

} // namespace grouser::scene::detail
