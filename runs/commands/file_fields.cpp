// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/fields.hpp"

#include "runs/output/frames_file.hpp"
#include "runs/output/result_fields.hpp"
#include "runs/storage/checkpoint_fields.hpp"

#include <fmt/format.h>

#include <vector>

namespace grouser::commands {

namespace {

std::string tableOf(const std::vector<support::FileField>& fields) {
  std::string text = "| dataset, or attribute behind @ | type | shape | unit | what it is |\n|---|---|---|---|---|\n";
  for (const support::FileField& f : fields)
    text += fmt::format("| `{}{}` | {} | {} | {} | {} |\n", f.path.starts_with('/') ? "" : "/", f.path, f.type, f.shape,
                        f.unit, f.help);
  return text;
}

constexpr const char* kHead =
    R"(<!-- Written by `grouser fields --files > docs/files.md`: change the tables in the source, not this file. -->

# Files of results

All that `results.h5`, `frames.h5` and `checkpoint.h5` may hold, from the tables that write them; a file holds what its
scene has. HDF5; numbers are little-endian. Words in capitals stand for names, shapes in words for how many there are.
Definitions: [reports.md](reports.md#definitions). Reading from Python: [control.md](control.md).

## results.h5

Of each quantity of a series the group holds `value`, with the attributes `unit`, `help` and, of vectors, `labels`;
`step` and `time` beside it are those of `series`. SIDE is `left` or `right`, NAME the name of a surface, a body or a
joint. Other datasets have the attributes `unit` and `help`.

)";

constexpr const char* kFrames = R"(
## frames.h5

A group for each frame, from `000000` on. `frames.xdmf` says the same to ParaView.

)";

constexpr const char* kCheckpoint = R"(
## checkpoint.h5, and beds that are kept

The state, to go on from ([large_runs.md](large_runs.md#stop-and-resume)); behind 512 bytes with its seal. Lists of several numbers that have
no names are for the program alone. A bed that is kept (`bed-*.h5`) is the same, with the grains and how they settled.

)";

} // namespace

std::string filesDocument() {
  return kHead + tableOf(output::resultFields()) + kFrames + tableOf(output::frameFields()) + kCheckpoint +
         tableOf(storage::checkpointFields());
}

} // namespace grouser::commands
