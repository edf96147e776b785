// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/error.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// Thin wrappers of HDF5 handles. One process writes or reads a file, or all ranks write rows of a dataset together.
/// Several threads may use different files. Failures throw exceptions; HDF5 prints no errors.
///
/// Files of results have checksums of all data and metadata, so that HDF5 detects a flipped bit when it reads the file.
/// Sealed files (sealed_file.hpp) have one checksum of the whole file instead.
namespace grouser::support {

/// Number types that go into a file; always stored little-endian.
enum class NumberType { Float32, Float64, Int64, Int32, UInt32 };
template <class T> struct NumberTypeOf;
template <> struct NumberTypeOf<float> { static constexpr NumberType value = NumberType::Float32; };
template <> struct NumberTypeOf<double> { static constexpr NumberType value = NumberType::Float64; };
template <> struct NumberTypeOf<std::int64_t> { static constexpr NumberType value = NumberType::Int64; };
template <> struct NumberTypeOf<std::int32_t> { static constexpr NumberType value = NumberType::Int32; };
template <> struct NumberTypeOf<std::uint32_t> { static constexpr NumberType value = NumberType::UInt32; };

/// A dataset that grows by rows of `width` numbers: shape [rows, width], or [rows] if width is 0.
class GrowingDataset {
public:
  GrowingDataset() = default;
  GrowingDataset(GrowingDataset&& other) noexcept;
  GrowingDataset& operator=(GrowingDataset&& other) noexcept;
  ~GrowingDataset();

  /// Appends one row of max(width, 1) numbers.
  void append(const double* numbers);
  void append(const std::int64_t* numbers);

private:
  friend class Hdf5File;
  GrowingDataset(std::int64_t dataset, int width) : dataset_(dataset), width_(width) {}
  void appendRow(const void* numbers, std::int64_t memoryType);

  std::int64_t dataset_ = -1;
  int width_ = 0;
  std::uint64_t rows_ = 0;
};

class Hdf5File {
public:
  /// Creates or replaces the file, with checksums; or without checksums, for a sealed file, if the user block before
  /// the HDF5 data has `userBlock` > 0 bytes (512, 1024...). Throws NotWritten with the path.
  static Hdf5File create(const std::filesystem::path& path, std::size_t userBlock = 0);
  /// Opens a file for reading. Throws base::InputError if the file is missing or not an HDF5 file.
  static Hdf5File open(const std::filesystem::path& path);
  /// The same for reading and writing.
  static Hdf5File openToChange(const std::filesystem::path& path);
  /// Opens a file that this run has written and closed, for writing on all ranks of `comm`; on several ranks for
  /// writeRows() only. Throws NotWritten with the path.
  static Hdf5File openShared(const std::filesystem::path& path, const base::Comm& comm);
  Hdf5File(Hdf5File&& other) noexcept;
  Hdf5File& operator=(Hdf5File&& other) noexcept;
  ~Hdf5File();

  const std::filesystem::path& path() const { return path_; }

  /// Creates a group. This and the following functions create missing parent groups.
  void makeGroup(const std::string& group);
  void attribute(const std::string& object, const std::string& name, const std::string& value);
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name, const std::vector<std::string>& values);

  /// `compressed`: lossless compression with zlib, which HDF5 readers support.
  template <class T> void write(const std::string& dataset, const std::vector<T>& numbers,
                                const std::vector<std::uint64_t>& shape, bool compressed = false) {
    writeNumbers(dataset, numbers.data(), NumberTypeOf<T>::value, shape, compressed);
  }
  /// Creates a dataset whose rows are written later. A sealed file allocates disk space for all rows.
  template <class T> void reserve(const std::string& dataset, const std::vector<std::uint64_t>& shape) {
    reserveNumbers(dataset, NumberTypeOf<T>::value, shape);
  }
  /// Writes rows, starting at `first`, of an existing dataset. In a shared file, all ranks call it, each with its own
  /// rows.
  template <class T> void writeRows(const std::string& dataset, std::uint64_t first, const std::vector<T>& numbers) {
    writeRowNumbers(dataset, first, numbers.data(), numbers.size(), NumberTypeOf<T>::value);
  }
  /// Creates a growing dataset with chunks of `chunkRows` rows.
  GrowingDataset growing(const std::string& dataset, NumberType type, int width, int chunkRows);
  /// Adds a second name (hard link) to an object.
  void link(const std::string& existing, const std::string& name);
  void remove(const std::string& object);
  /// Flushes everything written so far, so that the file is readable even if the program is killed.
  void flush();
  friend void requireRoom(const Hdf5File& file, std::uint64_t bytes);
  friend void readThrough(const Hdf5File& file, const std::string& group, bool data);

  /// Whether the object exists. Throws base::InputError if the file is damaged there.
  bool has(const std::string& object) const;
  /// Names in a group, without its path; empty if the group is missing.
  std::vector<std::string> members(const std::string& group) const;
  /// Shape and numbers (converted to double) of a dataset. Throws base::InputError if the dataset is missing.
  std::vector<std::uint64_t> shape(const std::string& dataset) const;
  std::vector<double> numbers(const std::string& dataset) const;
  /// Numbers of a dataset that was written with the same type, bitwise identical. Throws base::InputError.
  template <class T> std::vector<T> read(const std::string& dataset) const {
    const std::uint64_t count = countOf(dataset);
    std::vector<T> values(count);
    readNumbers(dataset, values.data(), NumberTypeOf<T>::value, count);
    return values;
  }
  /// Reads `count` rows, starting at `first`, like read().
  template <class T>
  std::vector<T> readRows(const std::string& dataset, std::uint64_t first, std::uint64_t count) const {
    std::vector<T> values;
    const std::uint64_t all = countOf(dataset), rows = all ? shape(dataset).front() : 0;
    if (first > rows || count > rows - first) throw damaged("dataset " + dataset);
    values.resize(rows ? all / rows * count : 0);
    readRowNumbers(dataset, first, count, values.data(), NumberTypeOf<T>::value);
    return values;
  }
  /// A text attribute; empty if it is missing.
  std::string text(const std::string& object, const std::string& name) const;
  /// A numerical attribute; NaN if it is missing.
  double number(const std::string& object, const std::string& name) const;
  std::vector<std::string> texts(const std::string& object, const std::string& name) const;

private:
  Hdf5File(std::int64_t file, std::filesystem::path path) : file_(file), path_(std::move(path)) {}
  bool withChecksums() const;
  /// Error of a part of the file that cannot be read.
  base::InputError damaged(const std::string& what) const;
  /// Number of elements of a dataset. Throws base::InputError if the file does not contain this many.
  std::uint64_t countOf(const std::string& dataset) const;
  /// Creation properties of a dataset with this chunk shape, which get a checksum; or none.
  std::int64_t layoutOf(std::vector<std::uint64_t> shape, bool compressed) const;
  /// Handle of an attribute; -1 if it is missing.
  std::int64_t openAttribute(const std::string& object, const std::string& name) const;
  void writeTexts(const std::string& object, const std::string& name, const std::vector<std::string>& texts,
                  bool isList);
  void writeNumbers(const std::string& dataset, const void* numbers, NumberType type,
                    const std::vector<std::uint64_t>& shape, bool compressed);
  void reserveNumbers(const std::string& dataset, NumberType type, const std::vector<std::uint64_t>& shape);
  void writeRowNumbers(const std::string& dataset, std::uint64_t first, const void* numbers, std::size_t count,
                       NumberType type);
  void readRowNumbers(const std::string& dataset, std::uint64_t first, std::uint64_t count, void* numbers,
                      NumberType type) const;
  void readNumbers(const std::string& dataset, void* numbers, NumberType type, std::uint64_t count) const;
  void check(std::int64_t status, const char* what) const;

  std::int64_t file_ = -1;
  std::filesystem::path path_;
  bool shared_ = false;
};

/// Call before writing a block of `bytes`. HDF5 leaves an unreadable file if a write fails in the middle; if this
/// throws NotWritten, nothing has changed since flush().
void requireRoom(const Hdf5File& file, std::uint64_t bytes);

/// Reads the names of a group and, if `data`, all its data, to verify their checksums. Throws base::InputError if the
/// file is damaged.
void readThrough(const Hdf5File& file, const std::string& group, bool data = true);

} // namespace grouser::support
