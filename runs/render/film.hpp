// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace grouser::render {

/// Throws base::InputError where no film could be made into this file: its name is not that of a film, its folder is
/// not there, or the program ffmpeg is not installed.
void checkFilm(const std::filesystem::path& film);

/// The latter alone; the message begins with `word`, an option and perhaps its value.
void checkFilmProgram(const std::string& word);

/// Makes PNG pictures of the same size, in this order, into a film (H.264; MP4, MKV or MOV by the file's name) by the
/// program ffmpeg. The file is put in place by renaming when it is whole. Throws support::NotWritten with ffmpeg's
/// words, base::DeviceError where the machine has no process for it.
void makeFilm(const std::vector<std::filesystem::path>& pictures, double framesPerSecond,
              const std::filesystem::path& film);

} // namespace grouser::render
