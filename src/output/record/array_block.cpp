#include "output/record/array_block.h"

#include "base/error.h"
#include "output/record/record_format.h"

#include <bit>
#include <cstring>
#include <utility>

namespace sprung {
namespace {

static_assert(std::endian::native == std::endian::little, "records are little-endian");
static_assert(sizeof(Index) == 4 && sizeof(double) == 8);

constexpr std::size_t kAlignment = 8;

std::uint64_t size_of(NumberType type) {
  switch (type) {
    case NumberType::u8:
      return 1;
    case NumberType::i32:
      return 4;
    case NumberType::f64:
      return 8;
  }
  return 0;
}

/// Whether the array lies within a block of so many bytes. No product overflows.
bool lies_within(const ArrayEntry& entry, std::uint64_t size) {
  if (entry.offset > size) return false;
  const std::uint64_t most = (size - entry.offset) / size_of(entry.type);
  return entry.columns == 0 || entry.rows <= most / entry.columns;
}

}  // namespace

std::size_t aligned(std::size_t size) { return (size + kAlignment - 1) / kAlignment * kAlignment; }

void ArrayBlock::append(const std::string& name, NumberType type, Eigen::Index rows, Eigen::Index columns, const void* numbers) {
  const ArrayEntry entry{type, static_cast<std::uint64_t>(rows), static_cast<std::uint64_t>(columns), bytes_.size()};
  table_[name] = entry;
  bytes_.append(static_cast<const char*>(numbers), entry.rows * entry.columns * size_of(type));
  bytes_.resize(aligned(bytes_.size()), '\0');
}

void ArrayBlock::add(const std::string& name, const std::vector<std::uint8_t>& numbers) {
  append(name, NumberType::u8, 1, std::ssize(numbers), numbers.data());
}

void ArrayBlock::add(const std::string& name, const std::vector<Index>& numbers) {
  append(name, NumberType::i32, 1, std::ssize(numbers), numbers.data());
}

void ArrayBlock::add(const std::string& name, const std::vector<double>& numbers) {
  append(name, NumberType::f64, 1, std::ssize(numbers), numbers.data());
}

void ArrayBlock::add(const std::string& name, const Points& columns) {
  append(name, NumberType::f64, 3, columns.cols(), columns.data());
}

void ArrayBlock::add(const std::string& name, const Triangles& columns) {
  append(name, NumberType::i32, 3, columns.cols(), columns.data());
}

void ArrayBlock::add(const std::string& name, const Edges& columns) {
  append(name, NumberType::i32, 2, columns.cols(), columns.data());
}

ArrayBlockReader::ArrayBlockReader(std::string bytes, ArrayTable table, std::filesystem::path file)
    : bytes_(std::move(bytes)), table_(std::move(table)), file_(std::move(file)) {}

void ArrayBlockReader::fail(const std::string& name, const std::string& rule) const {
  throw InputError({file_.string(), name, "", rule, kDamagedRecordRemedy});
}

const ArrayEntry& ArrayBlockReader::find(const std::string& name, NumberType type) const {
  const auto found = table_.find(name);
  if (found == table_.end()) fail(name, "is missing");
  if (found->second.type != type) fail(name, "has numbers of the wrong type");
  if (!lies_within(found->second, bytes_.size())) fail(name, "does not lie within its block");
  return found->second;
}

template <class Array>
Array ArrayBlockReader::matrix(const std::string& name, NumberType type) const {
  const ArrayEntry& entry = find(name, type);
  Array array(Array::RowsAtCompileTime, 0);
  if (static_cast<Eigen::Index>(entry.rows) != Array::RowsAtCompileTime) fail(name, "has the wrong number of rows");
  array.resize(Eigen::NoChange, static_cast<Eigen::Index>(entry.columns));
  if (array.size() > 0) std::memcpy(array.data(), bytes_.data() + entry.offset, entry.rows * entry.columns * size_of(type));
  return array;
}

template <class Number>
std::vector<Number> ArrayBlockReader::list(const std::string& name, NumberType type) const {
  const ArrayEntry& entry = find(name, type);
  if (entry.rows != 1) fail(name, "has the wrong number of rows");
  std::vector<Number> numbers(entry.columns);
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes_.data() + entry.offset, numbers.size() * sizeof(Number));
  return numbers;
}

std::vector<std::uint8_t> ArrayBlockReader::bytes(const std::string& name) const {
  return list<std::uint8_t>(name, NumberType::u8);
}

std::vector<Index> ArrayBlockReader::indices(const std::string& name) const { return list<Index>(name, NumberType::i32); }

std::vector<double> ArrayBlockReader::numbers(const std::string& name) const { return list<double>(name, NumberType::f64); }

Points ArrayBlockReader::points(const std::string& name) const { return matrix<Points>(name, NumberType::f64); }

Triangles ArrayBlockReader::triangles(const std::string& name) const { return matrix<Triangles>(name, NumberType::i32); }

Edges ArrayBlockReader::edges(const std::string& name) const { return matrix<Edges>(name, NumberType::i32); }

}  // namespace sprung
