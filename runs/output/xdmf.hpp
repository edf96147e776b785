// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <string>

/// Pieces of frames.xdmf.
namespace grouser::output::xdmf {

/// A <DataItem> that points into frames.h5.
inline std::string item(const std::string& shape, const char* type, int bytes, const std::string& dataset) {
  return fmt::format("<DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"{}\" Endian=\"Little\" Format=\"HDF\">"
                     "frames.h5:{}</DataItem>",
                     shape, type, bytes, dataset);
}

/// Nothing without content.
inline std::string grid(const char* name, const std::string& content) {
  return content.empty()
             ? ""
             : fmt::format("      <Grid Name=\"{}\" GridType=\"Uniform\">\n{}      </Grid>\n", name, content);
}

} // namespace grouser::output::xdmf
