// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/file_field.hpp"
#include "runs/support/hdf5_file.hpp"
#include "terrain/soil_fields.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Fields of the soil in frames.h5: /000012/fields/{origin, spacing, porosity [z, y, x], stress [z, y, x, 6], ...}.
namespace grouser::output {

/// Size of the fields of one frame in the file [bytes].
std::uint64_t bytesOfFields(std::size_t cells);
/// `frame`: the group of the frame.
void writeFields(support::Hdf5File& file, const std::string& frame, const terrain::SoilFields& fields);
/// The grid of that frame for frames.xdmf; empty where it has no fields.
std::string fieldsXdmf(const support::Hdf5File& file, const std::string& frame);
/// The box and cells of the fields of the first frame in a folder, without periodic axes; none where there are none.
std::optional<terrain::FieldGrid> formerFieldGrid(const std::filesystem::path& folder);

/// For docs/files.md; `frame`: "FRAME/".
std::vector<support::FileField> soilFieldFields(const std::string& frame);

} // namespace grouser::output
