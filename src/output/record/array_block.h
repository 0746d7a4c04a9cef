// Named arrays in one block of bytes, and the table that says where each of them is.
#pragma once

#include "base/types.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace sprung {

/// Little-endian: unsigned 8 bits, signed 32 bits, IEEE 754 double.
enum class NumberType : std::uint8_t { u8, i32, f64 };

/// A matrix, stored column after column. It begins at a multiple of 8 bytes.
struct ArrayEntry {
  NumberType type = NumberType::u8;
  std::uint64_t rows = 0;
  std::uint64_t columns = 0;
  std::uint64_t offset = 0;  ///< from the begin of the block [bytes]
};

using ArrayTable = std::map<std::string, ArrayEntry>;

/// Rounded up to a multiple of 8 bytes.
[[nodiscard]] std::size_t aligned(std::size_t size);

/// Collects arrays.
class ArrayBlock {
 public:
  void add(const std::string& name, const std::vector<std::uint8_t>& numbers);
  void add(const std::string& name, const std::vector<Index>& numbers);
  void add(const std::string& name, const std::vector<double>& numbers);
  void add(const std::string& name, const Points& columns);
  void add(const std::string& name, const Triangles& columns);
  void add(const std::string& name, const Edges& columns);

  /// A multiple of 8 bytes.
  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] const ArrayTable& table() const { return table_; }

 private:
  void append(const std::string& name, NumberType type, Eigen::Index rows, Eigen::Index columns, const void* numbers);

  std::string bytes_;
  ArrayTable table_;
};

/// Finds arrays in a block. Each function throws InputError that names the file and the array if the block has no such array, or
/// one of another type or size.
class ArrayBlockReader {
 public:
  /// `file` is named in errors.
  ArrayBlockReader(std::string bytes, ArrayTable table, std::filesystem::path file);

  [[nodiscard]] bool has(const std::string& name) const { return table_.contains(name); }
  [[nodiscard]] std::vector<std::uint8_t> bytes(const std::string& name) const;
  [[nodiscard]] std::vector<Index> indices(const std::string& name) const;
  [[nodiscard]] std::vector<double> numbers(const std::string& name) const;
  [[nodiscard]] Points points(const std::string& name) const;
  [[nodiscard]] Triangles triangles(const std::string& name) const;
  [[nodiscard]] Edges edges(const std::string& name) const;

  /// Throws InputError about an array of the file.
  [[noreturn]] void fail(const std::string& name, const std::string& rule) const;

 private:
  template <class Array>
  [[nodiscard]] Array matrix(const std::string& name, NumberType type) const;
  template <class Number>
  [[nodiscard]] std::vector<Number> list(const std::string& name, NumberType type) const;
  [[nodiscard]] const ArrayEntry& find(const std::string& name, NumberType type) const;

  std::string bytes_;
  ArrayTable table_;
  std::filesystem::path file_;
};

}  // namespace sprung
