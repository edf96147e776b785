// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/fields.hpp"

#include "runs/commands/commands.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/scene/soil.hpp"
#include "vehicle/spec_file.hpp"

#include <fmt/format.h>

namespace grouser::commands {

std::string keysDocument() {
  return "<!-- Written by `grouser fields --markdown > docs/keys.md`: change the tables in the source, not this file. "
         "-->\n\n# Keys of scene, vehicle and soil files\n\n" +
         scene::fieldHelp() + "\n" + vehicle::specFieldHelp() + "\n" + scene::soilFieldHelp();
}

void fieldsCommand(const FieldsCommand& command) {
  fmt::print("{}", command.markdown  ? keysDocument()
                   : command.files   ? filesDocument()
                   : command.vehicle ? vehicle::specFieldHelp()
                   : command.soil    ? scene::soilFieldHelp()
                                     : scene::fieldHelp());
}

} // namespace grouser::commands
