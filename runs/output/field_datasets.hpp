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

/// File size of the fields of one frame [bytes].
std::uint64_t bytesOfFields(std::size_t cells);
/// `frame`: group of the frame.
void writeFields(support::Hdf5File& file, const std::string& frame, const terrain::SoilFields& fields);
/// Grid of the fields of a frame for frames.xdmf; empty if the frame has no fields.
std::string fieldsXdmf(const support::Hdf5File& file, const std::string& frame);
/// Box and cells of the fields in the first frame of a folder, without periodic axes; empty if it has no fields.
std::optional<terrain::FieldGrid> formerFieldGrid(const std::filesystem::path& folder);

/// For docs/files.md; `frame`: "FRAME/".
std::vector<support::FileField> soilFieldFields(const std::string& frame);

} // namespace grouser::output
