// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

/// Elements of frames.xdmf.
namespace grouser::output::xdmf {

/// A <DataItem> that refers to a dataset in frames.h5.
inline std::string item(const std::string& shape, const char* type, int bytes, const std::string& dataset) {
  return fmt::format("<DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"{}\" Endian=\"Little\" Format=\"HDF\">"
                     "frames.h5:{}</DataItem>",
                     shape, type, bytes, dataset);
}

/// Empty if there is no content.
inline std::string grid(const char* name, const std::string& content) {
  return content.empty()
             ? ""
             : fmt::format("      <Grid Name=\"{}\" GridType=\"Uniform\">\n{}      </Grid>\n", name, content);
}

inline std::string geometry(std::size_t vertices, const std::string& dataset) {
  return fmt::format("        <Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
                     item(fmt::format("{} 3", vertices), "Float", 4, dataset));
}

/// `width`: 1 for a scalar, 3 for a vector.
inline std::string attribute(const char* name, const char* centre, std::size_t count, std::uint64_t width,
                             const char* type, const std::string& dataset) {
  const std::string shape = width == 1 ? fmt::format("{}", count) : fmt::format("{} {}", count, width);
  return fmt::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n", name,
                     width == 1 ? "Scalar" : "Vector", centre, item(shape, type, 4, dataset));
}

inline std::string triangles(std::size_t count, const std::string& dataset) {
  return fmt::format("        <Topology TopologyType=\"Triangle\" NumberOfElements=\"{}\">{}</Topology>\n", count,
                     item(fmt::format("{} 3", count), "UInt", 4, dataset));
}

} // namespace grouser::output::xdmf
