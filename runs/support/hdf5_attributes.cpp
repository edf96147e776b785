// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "runs/support/detail/hdf5_handle.hpp"
#include "runs/support/file_hash.hpp"
#include "runs/support/hdf5_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace grouser::support {

using detail::Handle;
using detail::Turn;

namespace {

/// An attribute above this size lies outside the checksums of HDF5, so its own checksum is stored beside it [bytes].
constexpr std::size_t kMaxProtected = 60000;
constexpr const char* kChecksum = "_crc32";

/// Type of texts of up to `bytes` bytes, or of any length.
hid_t textType(std::size_t bytes) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, bytes);
  if (bytes != H5T_VARIABLE) H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

/// Texts one after another, each padded with zeros to `width` bytes.
std::string padded(const std::vector<std::string>& texts, std::size_t width) {
  std::string all;
  for (const std::string& text : texts) {
    all += text;
    all.resize(all.size() + width - text.size());
  }
  return all;
}

} // namespace

/// Texts of a fixed length, because HDF5 protects them by the checksum of their object; texts of variable length lie in
/// a heap without checksums, and a flipped bit in this heap can crash the HDF5 library.
void Hdf5File::writeTexts(const std::string& object, const std::string& name, const std::vector<std::string>& texts,
                          bool isList) {
  const Turn turn;
  std::size_t width = 1;
  for (const std::string& text : texts) width = std::max(width, text.size());
  const hsize_t count = texts.size();
  const Handle space(isList ? H5Screate_simple(1, &count, nullptr) : H5Screate(H5S_SCALAR), H5Sclose);
  const Handle type(textType(withChecksums() ? width : H5T_VARIABLE), H5Tclose);
  const Handle id(
      H5Acreate_by_name(file_, object.c_str(), name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  check(id, "create an attribute");
  if (!count) return;
  if (!withChecksums()) {
    std::vector<const char*> pointers;
    for (const std::string& text : texts) pointers.push_back(text.c_str());
    check(H5Awrite(id, type, pointers.data()), "write an attribute");
    return;
  }
  const std::string all = padded(texts, width);
  check(H5Awrite(id, type, all.data()), "write an attribute");
  if (all.size() > kMaxProtected) attribute(object, name + kChecksum, static_cast<double>(crc32(all)));
}

void Hdf5File::attribute(const std::string& object, const std::string& name, const std::string& value) {
  writeTexts(object, name, {value}, false);
}

void Hdf5File::attribute(const std::string& object, const std::string& name, const std::vector<std::string>& values) {
  writeTexts(object, name, values, true);
}

void Hdf5File::attribute(const std::string& object, const std::string& name, double value) {
  const Turn turn;
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle id(H5Acreate_by_name(file_, object.c_str(), name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT,
                                    H5P_DEFAULT, H5P_DEFAULT),
                  H5Aclose);
  check(id, "create an attribute");
  check(H5Awrite(id, H5T_NATIVE_DOUBLE, &value), "write an attribute");
}

std::int64_t Hdf5File::openAttribute(const std::string& object, const std::string& name) const {
  if (!has(object)) return -1;
  const htri_t exists = H5Aexists_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT);
  if (exists == 0) return -1;
  const hid_t id =
      exists > 0 ? H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT) : hid_t{-1};
  if (id < 0) throw damaged(fmt::format("the attribute {} of {}", name, object));
  return id;
}

double Hdf5File::number(const std::string& object, const std::string& name) const {
  const Turn turn;
  double value = std::numeric_limits<double>::quiet_NaN();
  const Handle id(openAttribute(object, name), H5Aclose);
  if (id < 0) return value;
  const Handle space(H5Aget_space(id), H5Sclose);
  if (H5Sget_simple_extent_npoints(space) != 1 || H5Aread(id, H5T_NATIVE_DOUBLE, &value) < 0)
    throw damaged(fmt::format("the attribute {} of {}", name, object));
  return value;
}

std::string Hdf5File::text(const std::string& object, const std::string& name) const {
  const std::vector<std::string> all = texts(object, name);
  return all.empty() ? "" : all.front();
}

std::vector<std::string> Hdf5File::texts(const std::string& object, const std::string& name) const {
  const Turn turn;
  const Handle id(openAttribute(object, name), H5Aclose);
  if (id < 0) return {};
  const Handle type(H5Aget_type(id), H5Tclose), space(H5Aget_space(id), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING) return {};
  const auto count = static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space)));
  std::vector<std::string> values;
  if (count == 0) return values;
  const std::string what = fmt::format("the attribute {} of {}", name, object);
  if (H5Tis_variable_str(type) > 0) { // checkpoints, and results of older versions
    std::vector<char*> raw(count, nullptr);
    const Handle memory(textType(H5T_VARIABLE), H5Tclose);
    if (H5Aread(id, memory, raw.data()) < 0) throw damaged(what);
    for (const char* s : raw) values.emplace_back(s ? s : "");
    H5Dvlen_reclaim(memory, space, H5P_DEFAULT, raw.data());
    return values;
  }
  const std::size_t width = H5Tget_size(type);
  std::string all(H5Aget_storage_size(id), '\0');
  if (width == 0 || all.size() / width != count || H5Aread(id, type, all.data()) < 0) throw damaged(what);
  if (all.size() > kMaxProtected && number(object, name + kChecksum) != static_cast<double>(crc32(all)))
    throw damaged(what);
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(all.substr(i * width, width));
    values.back().resize(values.back().find_last_not_of('\0') + 1);
  }
  return values;
}

} // namespace grouser::support
