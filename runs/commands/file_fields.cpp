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
  std::string text = "| dataset, or attribute behind @ | type | shape | unit | meaning |\n|---|---|---|---|---|\n";
  for (const support::FileField& f : fields)
    text += fmt::format("| `{}{}` | {} | {} | {} | {} |\n", f.path.starts_with('/') ? "" : "/", f.path, f.type, f.shape,
                        f.unit, f.help);
  return text;
}

constexpr const char* kHead =
    R"(<!-- Written by `grouser fields --files > docs/files.md`: change the tables in the source, not this file. -->

# Files of results

Datasets and attributes of the HDF5 files `results.h5`, `frames.h5` and `checkpoint.h5`. A file contains only the
datasets that apply to its scene. Numbers are little-endian. In paths, words in capitals are placeholders for names; in
shapes, words are placeholders for numbers.
For definitions, see [reports.md](reports.md#definitions). To read the files from Python, see [control.md](control.md).

## results.h5

The group of each time series contains the dataset `value`, with the attributes `unit`, `help` and, for vectors,
`labels`, and links `step` and `time` to the datasets of `series`. SIDE is `left` or `right`; NAME is the name of a
surface, body or joint. Datasets that are not time series have the attributes `unit` and `help`.

)";

constexpr const char* kFrames = R"(
## frames.h5

One group per frame, numbered from `000000`. `frames.xdmf` describes the file to ParaView.

)";

constexpr const char* kCheckpoint = R"(
## checkpoint.h5 and cached beds

The file contains the state from which a run resumes ([large_runs.md](large_runs.md#stop-and-resume)), after a header of
512 bytes with a checksum. Lists of unnamed numbers are internal to the program. A cached bed (`bed-*.h5`) has the same
format, but contains only grains and settling data.

)";

} // namespace

std::string filesDocument() {
  return kHead + tableOf(output::resultFields()) + kFrames + tableOf(output::frameFields()) + kCheckpoint +
         tableOf(storage::checkpointFields());
}

} // namespace grouser::commands
