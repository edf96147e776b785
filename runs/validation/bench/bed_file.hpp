// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/bench/bench.hpp"
#include "terrain/grains.hpp"

#include <string>
#include <vector>

namespace grouser::bench {

/// Reads the grains of `bench.start`, which has one grain per line, as grain files of scenes have. Throws
/// base::InputError if the number or the radius of the grains differs from the options of the bed.
std::vector<terrain::GrainSpec> readBed(const BedBench& bench);

/// Writes the current grains for readBed(), scenes and other programs: positions with 17 digits, no contact history.
/// Throws base::InputError if the file cannot be written.
void saveBed(const terrain::Grains& grains, const std::string& path);

} // namespace grouser::bench
