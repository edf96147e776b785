// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::support {

/// Description of an item of a results file: a dataset, or an attribute (after an @). In paths and shapes, words in
/// capitals are placeholders for names (SIDE, NAME) and for frame numbers (FRAME).
struct FileField {
  std::string path;  ///< "vehicle/SIDE/slip/value", "/@version"
  std::string type;  ///< "float64", "uint32", "text", "texts"
  std::string shape; ///< "[rows, 3]"; empty for one number or text
  std::string unit;  ///< "m"; "-" if dimensionless; empty for texts
  std::string help;  ///< one line
};

} // namespace grouser::support
