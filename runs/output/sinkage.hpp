// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace grouser::output {

/// Writes sinkage.csv into `folder`: time and one column a shoe [m], NaN while the shoe has no ground contact; for
/// given `shoes`, counted from 0, of `track` ("left", "right"; empty: both), sinkage_shoes.csv. Throws base::InputError
/// where `results` is no results.h5 of a run with a vehicle, or has no such shoe. Returns the file's path.
std::filesystem::path writeSinkageCsv(const std::filesystem::path& results, const std::filesystem::path& folder,
                                      const std::vector<int>& shoes = {}, const std::string& track = {});

/// Shoes of a list "10-13,20", in its order. Throws base::InputError for an invalid list.
std::vector<int> shoesNamed(const std::string& list);
/// Throws base::InputError where `results` has no sinkage, or fewer shoes.
void requireShoes(const std::filesystem::path& results, const std::vector<int>& shoes, const std::string& track = {});

} // namespace grouser::output
