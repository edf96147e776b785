// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::support {

/// Description of an item of a results file: a dataset, or an attribute behind an @. In paths and shapes
/// words in capitals stand for names (SIDE, NAME) and for what counts the frames (FRAME).
struct FileField {
  std::string path;  ///< "vehicle/SIDE/slip/value", "/@version"
  std::string type;  ///< "float64", "uint32", "text", "texts"
  std::string shape; ///< "[rows, 3]"; empty for one number or text
  std::string unit;  ///< "m"; "-" where dimensionless; empty for texts
  std::string help;  ///< one line
};

} // namespace grouser::support
