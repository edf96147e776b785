// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/bench/bench.hpp"
#include "terrain/grains.hpp"

#include <string>
#include <vector>

namespace grouser::bench {

/// The grains of `bench.start`, one per line as in grain files of scenes. Throws base::InputError if their number or
/// radius differs from the bed's.
std::vector<terrain::GrainSpec> readBed(const BedBench& bench);

/// Writes the current grains for readBed(), scenes and other programs, with 17 digits, without contact history. Throws
/// base::InputError if the file cannot be written.
void saveBed(const terrain::Grains& grains, const std::string& path);

} // namespace grouser::bench
