// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// `grouser render`: pictures and a film of a run's frames.h5.
namespace grouser::commands {

struct RenderCommand {
  std::string frames;               ///< file with the frames
  std::string folder;               ///< empty: pictures/ beside the file
  std::string film;                 ///< film file; empty: none
  double framesPerSecond = 25;      ///< frame rate of the film [1/s]
  std::string color = "depth";      ///< colour quantity, see grainQuantity()
  std::vector<double> range;        ///< lower and upper end of the colour scale; empty: from the file
  std::vector<std::string> borders; ///< subdomain borders, see bordersOf()
  std::string lookAt;               ///< vehicle, all or X,Y,Z [m]; empty: the vehicle if there is one
  std::optional<double> azimuth;    ///< [deg]
  std::optional<double> elevation;  ///< [deg]
  std::optional<double> distance;   ///< [m]
  std::string size = "1600x900";    ///< WIDTHxHEIGHT
  std::size_t every = 1;            ///< draw every n-th frame
  double from = 0;                  ///< first time [s]
  std::optional<double> to;         ///< last time [s]
  std::vector<std::size_t> frame;   ///< numbers of single frames; empty: all
  bool labels = true;
  int processes = 1;
  int threads = 0; ///< threads per process; 0: all available cores, at most OMP_NUM_THREADS, shared among the processes
  bool force = false; ///< overwrite pictures and film
  base::Comm comm;    ///< ranks that share the frames
};

/// Width and height of "1600x900"; throws base::InputError.
std::pair<int, int> pictureSize(const std::string& text);

/// Divides the frames among the ranks, and those of a rank among its processes. Complete pictures are renamed to their
/// final names. Throws base::InputError before any file is written, and Stopped after a signal.
void renderCommand(const RenderCommand& command);

} // namespace grouser::commands
