// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/hdf5_file.hpp"

#include "base/input_file.hpp"
#include "runs/support/detail/hdf5_handle.hpp"
#include "runs/support/disk_room.hpp"
#include "runs/support/not_written.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

namespace grouser::support {

using detail::Handle;
using detail::Turn;

static_assert(sizeof(hid_t) == sizeof(std::int64_t));

namespace {

hid_t fileType(NumberType type) {
  switch (type) {
  case NumberType::Float32:
    return H5T_IEEE_F32LE;
  case NumberType::Float64:
    return H5T_IEEE_F64LE;
  case NumberType::Int64:
    return H5T_STD_I64LE;
  case NumberType::Int32:
    return H5T_STD_I32LE;
  case NumberType::UInt32:
    return H5T_STD_U32LE;
  }
  return -1;
}

hid_t memoryType(NumberType type) {
  switch (type) {
  case NumberType::Float32:
    return H5T_NATIVE_FLOAT;
  case NumberType::Float64:
    return H5T_NATIVE_DOUBLE;
  case NumberType::Int64:
    return H5T_NATIVE_INT64;
  case NumberType::Int32:
    return H5T_NATIVE_INT32;
  case NumberType::UInt32:
    return H5T_NATIVE_UINT32;
  }
  return -1;
}

/// Link creation with intermediate groups.
hid_t makeParents() {
  const hid_t list = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(list, 1);
  return list;
}

/// Call before the first use of the library. Disables the error output of HDF5, since errors become exceptions, and its
/// cleanup at exit: HDF5 1.10 keeps a file that it could not write (full disk) and crashes at exit. All files are
/// closed earlier.
void quiet() {
  [[maybe_unused]] static const herr_t once = H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

constexpr std::uint64_t kChunkNumbers = std::uint64_t{1} << 18; // maximum numbers per chunk, except in one row
constexpr unsigned kCompression = 4;                            // zlib level, 1 to 9

NotWritten failure(const std::filesystem::path& path, const char* what) {
  return notWritten(path, fmt::format("HDF5 could not {}", what));
}

} // namespace

GrowingDataset::GrowingDataset(GrowingDataset&& other) noexcept
    : dataset_(std::exchange(other.dataset_, -1)), width_(other.width_), rows_(other.rows_) {}

GrowingDataset& GrowingDataset::operator=(GrowingDataset&& other) noexcept {
  std::swap(dataset_, other.dataset_), std::swap(width_, other.width_), std::swap(rows_, other.rows_);
  return *this;
}

GrowingDataset::~GrowingDataset() {
  const Turn turn;
  if (dataset_ >= 0) H5Dclose(dataset_);
}

void GrowingDataset::append(const double* numbers) {
  const Turn turn;
  appendRow(numbers, H5T_NATIVE_DOUBLE);
}
void GrowingDataset::append(const std::int64_t* numbers) {
  const Turn turn;
  appendRow(numbers, H5T_NATIVE_INT64);
}

void GrowingDataset::appendRow(const void* numbers, std::int64_t type) {
  const int rank = width_ ? 2 : 1;
  const hsize_t extent[2] = {rows_ + 1, static_cast<hsize_t>(width_)};
  const hsize_t start[2] = {rows_, 0}, count[2] = {1, static_cast<hsize_t>(width_)};
  bool good = H5Dset_extent(dataset_, extent) >= 0;
  const Handle space(H5Dget_space(dataset_), H5Sclose);
  const Handle row(H5Screate_simple(rank, count, nullptr), H5Sclose);
  good = good && H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr) >= 0;
  good = good && H5Dwrite(dataset_, type, row, space, H5P_DEFAULT, numbers) >= 0;
  if (!good) throw NotWritten("HDF5 could not append a row to the results; is the disk full?");
  ++rows_;
}

namespace {

/// Access properties of files with checksums: since format 1.10, all metadata have checksums. `first`: the file itself
/// in format 1.8, because format 1.10 has an "open for writing" flag, with which files of killed programs are
/// unreadable.
hid_t withAllChecksums(H5F_libver_t first = H5F_LIBVER_V110) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, first, H5F_LIBVER_V110);
  return access;
}

hid_t openedAs(unsigned access, const std::filesystem::path& path) {
  const Turn turn;
  quiet();
  base::requireInput(path, "specify the results.h5 of a run");
  const Handle properties(withAllChecksums(), H5Pclose);
  const hid_t file = H5Fopen(path.c_str(), access, properties);
  if (file < 0)
    throw base::InputError(fmt::format(
        "{}: is not an HDF5 file, is truncated or damaged; specify the results.h5 of a run", path.string()));
  return file;
}

} // namespace

Hdf5File Hdf5File::create(const std::filesystem::path& path, std::size_t userBlock) {
  // Names and attributes in the headers of their groups, up to these numbers: reading a damaged heap of names crashes
  // HDF5 1.10. Groups inherit this property.
  constexpr unsigned kMaxAttributes = 1000, kMaxNames = 65000;
  const Turn turn;
  quiet();
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_userblock(creation, userBlock);
  const Handle first(withAllChecksums(H5F_LIBVER_V18), H5Pclose), access(withAllChecksums(), H5Pclose);
  if (!userBlock)
    H5Pset_attr_phase_change(creation, kMaxAttributes, 0), H5Pset_link_phase_change(creation, kMaxNames, 0);
  hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, userBlock ? hid_t{H5P_DEFAULT} : hid_t{first});
  if (file >= 0 && !userBlock) file = H5Fclose(file) < 0 ? -1 : H5Fopen(path.c_str(), H5F_ACC_RDWR, access);
  if (file < 0) throw failure(path, "create the file; another program may have opened it");
  return {file, path};
}

Hdf5File Hdf5File::open(const std::filesystem::path& path) { return {openedAs(H5F_ACC_RDONLY, path), path}; }

Hdf5File Hdf5File::openToChange(const std::filesystem::path& path) { return {openedAs(H5F_ACC_RDWR, path), path}; }

Hdf5File Hdf5File::openShared(const std::filesystem::path& path, const base::Comm& comm) {
  const Turn turn;
  quiet();
  const Handle access(withAllChecksums(), H5Pclose);
  if (!comm.alone()) H5Pset_fapl_mpio(access, MPI_COMM_WORLD, MPI_INFO_NULL);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, access);
  if (file < 0) throw failure(path, comm.alone() ? "open the file again" : "open the file on all ranks");
  Hdf5File opened(file, path);
  opened.shared_ = !comm.alone();
  return opened;
}

Hdf5File::Hdf5File(Hdf5File&& other) noexcept
    : file_(std::exchange(other.file_, -1)), path_(std::move(other.path_)), shared_(other.shared_) {}

Hdf5File& Hdf5File::operator=(Hdf5File&& other) noexcept {
  std::swap(file_, other.file_), std::swap(path_, other.path_), std::swap(shared_, other.shared_);
  return *this;
}

Hdf5File::~Hdf5File() {
  // Closing a shared file is collective; after an error, other ranks may not reach this call.
  if (shared_ && std::uncaught_exceptions() > 0) return;
  const Turn turn;
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5File::check(std::int64_t status, const char* what) const {
  if (status < 0) throw failure(path_, what);
}

bool Hdf5File::withChecksums() const {
  const Handle creation(H5Fget_create_plist(file_), H5Pclose);
  hsize_t userBlock = 0;
  return H5Pget_userblock(creation, &userBlock) >= 0 && userBlock == 0;
}

base::InputError Hdf5File::damaged(const std::string& what) const {
  return base::InputError(fmt::format("{}: {} cannot be read: the file is damaged; run the scene again, or restore the "
                                      "file from a copy",
                                      path_.string(), what));
}

void Hdf5File::makeGroup(const std::string& group) {
  const Turn turn;
  if (has(group)) return;
  const Handle parents(makeParents(), H5Pclose);
  const Handle id(H5Gcreate2(file_, group.c_str(), parents, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  check(id, "create a group");
}

std::int64_t Hdf5File::layoutOf(std::vector<std::uint64_t> shape, bool compressed) const {
  const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  const bool isChecked = withChecksums(), isEmpty = std::find(shape.begin(), shape.end(), 0u) != shape.end();
  compressed = compressed && H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0;
  if (isEmpty || !(isChecked || compressed)) return layout;
  // Chunks of equal size, because the last chunk occupies its full size.
  std::uint64_t most = kChunkNumbers;
  for (std::size_t axis = 1; axis < shape.size(); ++axis) most = std::max<std::uint64_t>(1, most / shape[axis]);
  const std::uint64_t chunks = (shape.front() + most - 1) / most;
  shape.front() = (shape.front() + chunks - 1) / chunks;
  const std::vector<hsize_t> chunk(shape.begin(), shape.end());
  H5Pset_chunk(layout, static_cast<int>(chunk.size()), chunk.data());
  if (compressed) H5Pset_shuffle(layout), H5Pset_deflate(layout, kCompression);
  if (isChecked) H5Pset_fletcher32(layout);
  return layout;
}

void Hdf5File::writeNumbers(const std::string& dataset, const void* numbers, NumberType type,
                            const std::vector<std::uint64_t>& shape, bool compressed) {
  const Turn turn;
  const std::vector<hsize_t> extent(shape.begin(), shape.end());
  const bool isEmpty = std::find(shape.begin(), shape.end(), 0u) != shape.end();
  const Handle space(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose);
  const Handle parents(makeParents(), H5Pclose);
  const Handle layout(layoutOf(shape, compressed), H5Pclose);
  const Handle id(H5Dcreate2(file_, dataset.c_str(), fileType(type), space, parents, layout, H5P_DEFAULT), H5Dclose);
  check(id, "create a dataset");
  if (!isEmpty) check(H5Dwrite(id, memoryType(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers), "write a dataset");
}

void Hdf5File::reserveNumbers(const std::string& dataset, NumberType type, const std::vector<std::uint64_t>& shape) {
  const Turn turn;
  const std::vector<hsize_t> extent(shape.begin(), shape.end());
  const Handle space(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose);
  const Handle parents(makeParents(), H5Pclose);
  const Handle layout(layoutOf(shape, false), H5Pclose);
  if (H5Pget_layout(layout) != H5D_CHUNKED) H5Pset_alloc_time(layout, H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(layout, H5D_FILL_TIME_NEVER);
  const Handle id(H5Dcreate2(file_, dataset.c_str(), fileType(type), space, parents, layout, H5P_DEFAULT), H5Dclose);
  check(id, "create a dataset");
}

namespace {

/// Rows [first, first + count) of a dataset: the file dataspace with these rows selected, and a memory dataspace of
/// their shape.
struct RowSelection {
  Handle file, memory;
  RowSelection(hid_t dataset, std::uint64_t first, std::uint64_t count)
      : file(H5Dget_space(dataset), H5Sclose), memory(select(file, first, count), H5Sclose) {}

private:
  static hid_t select(hid_t space, std::uint64_t first, std::uint64_t count) {
    std::vector<hsize_t> extent(static_cast<std::size_t>(std::max(1, H5Sget_simple_extent_ndims(space))));
    H5Sget_simple_extent_dims(space, extent.data(), nullptr);
    std::vector<hsize_t> start(extent.size(), 0);
    start[0] = first, extent[0] = count;
    const hid_t memory = H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr);
    const bool none = std::find(extent.begin(), extent.end(), 0u) != extent.end();
    if (none) {
      H5Sselect_none(space);
      H5Sselect_none(memory);
    } else if (H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr) < 0) {
      return -1;
    }
    return memory;
  }
};

} // namespace

void Hdf5File::writeRowNumbers(const std::string& dataset, std::uint64_t first, const void* numbers, std::size_t count,
                               NumberType type) {
  const Turn turn;
  const Handle id(H5Dopen2(file_, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  check(id, "open a dataset");
  std::uint64_t width = 1;
  const std::vector<std::uint64_t> extent = shape(dataset);
  for (std::size_t axis = 1; axis < extent.size(); ++axis) width *= extent[axis];
  const RowSelection rows(id, first, width ? count / width : 0);
  const Handle transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  if (shared_) H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE);
  check(rows.memory, "select rows");
  check(H5Dwrite(id, memoryType(type), rows.memory, rows.file, transfer, numbers), "write rows");
}

void Hdf5File::readRowNumbers(const std::string& dataset, std::uint64_t first, std::uint64_t count, void* numbers,
                              NumberType type) const {
  const Turn turn;
  const Handle id(H5Dopen2(file_, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle stored(H5Dget_type(id), H5Tclose);
  const RowSelection rows(id, first, count);
  if (H5Tequal(stored, fileType(type)) <= 0 || rows.memory < 0 ||
      H5Dread(id, memoryType(type), rows.memory, rows.file, H5P_DEFAULT, numbers) < 0)
    throw damaged(fmt::format("dataset {}", dataset));
}

GrowingDataset Hdf5File::growing(const std::string& dataset, NumberType type, int width, int chunkRows) {
  const Turn turn;
  const int rank = width ? 2 : 1;
  const hsize_t none[2] = {0, static_cast<hsize_t>(width)};
  const hsize_t most[2] = {H5S_UNLIMITED, static_cast<hsize_t>(width)};
  const hsize_t chunk[2] = {static_cast<hsize_t>(chunkRows), static_cast<hsize_t>(width)};
  const Handle space(H5Screate_simple(rank, none, most), H5Sclose);
  const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(layout, rank, chunk);
  if (withChecksums()) H5Pset_fletcher32(layout);
  const Handle parents(makeParents(), H5Pclose);
  const hid_t id = H5Dcreate2(file_, dataset.c_str(), fileType(type), space, parents, layout, H5P_DEFAULT);
  check(id, "create a dataset");
  return {id, width};
}

void Hdf5File::link(const std::string& existing, const std::string& name) {
  const Turn turn;
  const Handle parents(makeParents(), H5Pclose);
  check(H5Lcreate_hard(file_, existing.c_str(), file_, name.c_str(), parents, H5P_DEFAULT), "create a link");
}

void Hdf5File::remove(const std::string& object) {
  const Turn turn;
  check(H5Ldelete(file_, object.c_str(), H5P_DEFAULT), "delete an object");
}

void Hdf5File::flush() {
  const Turn turn;
  check(H5Fflush(file_, H5F_SCOPE_GLOBAL), "flush the file");
}

void requireRoom(const Hdf5File& file, std::uint64_t bytes) {
  const Turn turn;
  void* handle = nullptr; // points to the file descriptor; the file may have been renamed
  file.check(H5Fget_vfd_handle(file.file_, H5P_DEFAULT, &handle), "get the handle of the file");
  requireRoom(*static_cast<const int*>(handle), file.path_, bytes);
}

bool Hdf5File::has(const std::string& object) const {
  const Turn turn;
  // H5Lexists() requires that all parent groups exist.
  for (std::size_t end = object.find('/', 1);; end = object.find('/', end + 1)) {
    const std::string part = object.substr(0, end);
    const htri_t exists = part == "/" ? 1 : H5Lexists(file_, part.c_str(), H5P_DEFAULT);
    if (exists < 0) throw damaged(part);
    if (exists == 0) return false;
    if (end == std::string::npos) return true;
  }
}

std::vector<std::string> Hdf5File::members(const std::string& group) const {
  const Turn turn;
  std::vector<std::string> names;
  if (!has(group)) return names;
  const auto take = [](hid_t, const char* name, const H5L_info_t*, void* found) -> herr_t {
    static_cast<std::vector<std::string>*>(found)->emplace_back(name);
    return 0;
  };
  const Handle id(H5Gopen2(file_, group.c_str(), H5P_DEFAULT), H5Gclose);
  if (id < 0 || H5Literate(id, H5_INDEX_NAME, H5_ITER_INC, nullptr, take, &names) < 0) throw damaged(group);
  return names;
}

std::vector<std::uint64_t> Hdf5File::shape(const std::string& dataset) const {
  const Turn turn;
  if (!has(dataset))
    throw base::InputError(
        fmt::format("{}: has no dataset {}; specify the results.h5 of a run of this program", path_.string(), dataset));
  const Handle id(H5Dopen2(file_, dataset.c_str(), H5P_DEFAULT), H5Dclose), space(H5Dget_space(id), H5Sclose);
  const int axes = H5Sget_simple_extent_ndims(space);
  std::vector<hsize_t> extent(static_cast<std::size_t>(std::max(0, axes)));
  if (axes < 0 || H5Sget_simple_extent_dims(space, extent.data(), nullptr) < 0) throw damaged("dataset " + dataset);
  return {extent.begin(), extent.end()};
}

std::uint64_t Hdf5File::countOf(const std::string& dataset) const {
  constexpr double kMaxCompression = 1032; // maximum ratio of zlib
  const Turn turn;
  const std::vector<std::uint64_t> extent = shape(dataset);
  const Handle id(H5Dopen2(file_, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle layout(H5Dget_create_plist(id), H5Pclose), type(H5Dget_type(id), H5Tclose);
  std::uint64_t count = 1;
  double needed = static_cast<double>(H5Tget_size(type));
  for (const std::uint64_t n : extent) count *= n, needed *= static_cast<double>(n);
  unsigned flags = 0;
  std::size_t none = 0;
  const bool isCompressed =
      H5Pget_filter_by_id2(layout, H5Z_FILTER_DEFLATE, &flags, &none, nullptr, 0, nullptr, nullptr) >= 0;
  const double stored = static_cast<double>(H5Dget_storage_size(id)) * (isCompressed ? kMaxCompression : 1);
  if (needed > stored)
    throw damaged(fmt::format("dataset {} of shape [{}], which is larger than its data in the file,", dataset,
                              fmt::join(extent, ", ")));
  return count;
}

std::vector<double> Hdf5File::numbers(const std::string& dataset) const {
  const Turn turn;
  const std::uint64_t count = countOf(dataset);
  std::vector<double> values(count);
  const Handle id(H5Dopen2(file_, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  if (count && H5Dread(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    throw damaged(fmt::format("dataset {}", dataset));
  return values;
}

void readThrough(const Hdf5File& file, const std::string& group, bool data) {
  const Turn turn;
  if (!file.has(group)) return;
  const Handle id(H5Oopen(file.file_, group.c_str(), H5P_DEFAULT), H5Oclose);
  std::vector<std::string> datasets;
  const auto take = [](hid_t, const char* name, const H5O_info_t* object, void* found) -> herr_t {
    if (object->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(found)->emplace_back(name);
    return 0;
  };
  if (id < 0 || H5Ovisit2(id, H5_INDEX_NAME, H5_ITER_INC, take, &datasets, H5O_INFO_BASIC) < 0)
    throw file.damaged(group);
  for (const std::string& dataset : datasets) {
    const std::string path = group + "/" + dataset;
    const std::uint64_t count = data ? file.countOf(path) : 0;
    const Handle numbers(H5Dopen2(file.file_, path.c_str(), H5P_DEFAULT), H5Dclose),
        type(H5Dget_type(numbers), H5Tclose);
    std::vector<char> bytes(count * H5Tget_size(type));
    if (count && H5Dread(numbers, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0)
      throw file.damaged("dataset " + path);
  }
}

void Hdf5File::readNumbers(const std::string& dataset, void* numbers, NumberType type, std::uint64_t count) const {
  const Turn turn;
  const Handle id(H5Dopen2(file_, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle stored(H5Dget_type(id), H5Tclose);
  if (H5Tequal(stored, fileType(type)) <= 0 ||
      (count && H5Dread(id, memoryType(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers) < 0))
    throw damaged(fmt::format("dataset {}", dataset));
}

} // namespace grouser::support
