// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/bench/bench.hpp"
#include "terrain/grains.hpp"

#include <string>
#include <vector>

namespace grouser::bench {

/// The grains of `bench.start`, a line each as in files of a scene. Throws base::InputError where it holds others than
/// the bed: so many, and of its radius, the box being made for them.
std::vector<terrain::GrainSpec> readBed(const BedBench& bench);

/// Writes the grains as they are now, for readBed(), scenes and other programs: 17 digits give back what frames have.
/// What contacts remember is not among it. Throws base::InputError where the file cannot be written.
void saveBed(const terrain::Grains& grains, const std::string& path);

} // namespace grouser::bench
