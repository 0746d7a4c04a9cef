// Values as bytes, and back: numbers, texts, lists and structs that list their members.
//
// A struct is supported if it has a function visit_members(value, visit) that calls visit(member...) with all of its members; a
// template over the constness of `value` serves both directions:
//     template <Same<Slip> S, class Visit>
//     void visit_members(S& slip, const Visit& visit) { visit(slip.displacement, slip.obstacle); }
// A class with private members declares the function as a friend.
#pragma once

#include "base/types.h"

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace sprung {

/// T, or const T.
template <class S, class T>
concept Same = std::same_as<std::remove_const_t<S>, T>;

/// Numbers are copied byte by byte.
template <class T>
concept PlainNumber = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// A vector of numbers in a register (see base/machine/simd.h) is copied byte by byte too.
template <class T>
concept PlainVector = !std::is_class_v<T> && !std::is_array_v<T> && !std::is_pointer_v<T> && requires(T & lanes) {
  lanes[0];
};

/// An array of Eigen.
template <class T>
concept EigenArray = std::derived_from<T, Eigen::PlainObjectBase<T>>;

/// A list whose size follows from what its owner was made of: bytes with another size are no values of it. Its entries are read in
/// place, so that members which they do not list stay.
template <class List>
struct FixedSize {
  List& list;
};
template <class List>
[[nodiscard]] FixedSize<List> fixed_size(List& list) {
  return {list};
}

/// Writes values to `sink(const void* data, std::size_t size)`. The count of a list stands before its entries. Equal values, bit by
/// bit, give the same bytes, and others do not.
template <class Sink>
class BinaryWriter {
 public:
  explicit BinaryWriter(Sink sink) : sink_(std::move(sink)) {}

  template <class Number>
  requires(PlainNumber<Number> || PlainVector<Number>) void write(const Number& number) { sink_(&number, sizeof(number)); }
  void write(const std::string& text) {
    write(text.size());
    sink_(text.data(), text.size());
  }
  template <EigenArray Matrix>
  void write(const Matrix& matrix) {
    write(matrix.rows());
    write(matrix.cols());
    sink_(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(typename Matrix::Scalar));
  }
  void write(const RigidTransform& pose) { sink_(pose.data(), sizeof(double) * static_cast<std::size_t>(pose.matrix().size())); }
  void write(const Box3& box) {
    write(box.min());
    write(box.max());
  }
  template <class Entry, class Allocator>
  void write(const std::vector<Entry, Allocator>& entries) {
    write(entries.size());
    if constexpr (PlainNumber<Entry>) {
      sink_(entries.data(), entries.size() * sizeof(Entry));
    } else {
      for (const Entry& entry : entries) write(entry);
    }
  }
  template <class List>
  void write(const FixedSize<List>& fixed) {
    write(fixed.list);
  }
  template <class Entry, std::size_t n>
  void write(const Entry (&entries)[n]) {
    for (const Entry& entry : entries) write(entry);
  }
  template <class Entry, std::size_t n>
  void write(const std::array<Entry, n>& entries) {
    for (const Entry& entry : entries) write(entry);
  }
  template <class Entry>
  void write(const std::optional<Entry>& entry) {
    write(entry.has_value());
    if (entry) write(*entry);
  }
  template <class Key, class Entry>
  void write(const std::map<Key, Entry>& entries) {
    write(entries.size());
    for (const auto& [key, entry] : entries) {
      write(key);
      write(entry);
    }
  }
  template <class Struct>
  requires(std::is_class_v<Struct> && !EigenArray<Struct>) void write(const Struct& value) {
    visit_members(value, [this](const auto&... members) { (this->write(members), ...); });
  }

 private:
  Sink sink_;
};

/// Appends to a text.
struct ByteSink {
  std::string& bytes;
  void operator()(const void* data, std::size_t size) const { bytes.append(static_cast<const char*>(data), size); }
};
using ByteWriter = BinaryWriter<ByteSink>;

/// The bytes of a value.
template <class Value>
[[nodiscard]] std::string to_bytes(const Value& value) {
  std::string bytes;
  ByteWriter(ByteSink{bytes}).write(value);
  return bytes;
}

/// Bytes that are no values of the wanted type.
class BytesError : public std::runtime_error {
 public:
  BytesError() : std::runtime_error("the bytes do not hold such values") {}
};

/// Reads what BinaryWriter wrote. Throws BytesError if the bytes end too early or hold an impossible count; never asks for more
/// memory than a small multiple of their number.
class BinaryReader {
 public:
  /// Keeps a reference to the bytes.
  explicit BinaryReader(std::string_view bytes) : bytes_(bytes) {}

  /// The number of bytes that are not read yet.
  [[nodiscard]] std::size_t remaining() const { return bytes_.size(); }

  template <class Number>
  requires(PlainNumber<Number> || PlainVector<Number>) void read(Number& number) { copy(&number, sizeof(number)); }
  void read(bool& flag) {
    char byte = 0;
    copy(&byte, 1);
    if (byte != 0 && byte != 1) throw BytesError();
    flag = byte == 1;
  }
  void read(std::string& text) {
    text.resize(read_count(1));
    copy(text.data(), text.size());
  }
  template <EigenArray Matrix>
  void read(Matrix& matrix) {
    Eigen::Index rows = 0;
    Eigen::Index cols = 0;
    read(rows);
    read(cols);
    const auto most = static_cast<Eigen::Index>(bytes_.size() / sizeof(typename Matrix::Scalar));
    const bool fits = (Matrix::RowsAtCompileTime == Eigen::Dynamic || Matrix::RowsAtCompileTime == rows) &&
                      (Matrix::ColsAtCompileTime == Eigen::Dynamic || Matrix::ColsAtCompileTime == cols);
    if (!fits || rows < 0 || cols < 0 || (rows > 0 && cols > most / rows)) throw BytesError();
    matrix.resize(rows, cols);
    copy(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(typename Matrix::Scalar));
  }
  void read(RigidTransform& pose) { copy(pose.data(), sizeof(double) * static_cast<std::size_t>(pose.matrix().size())); }
  void read(Box3& box) {
    read(box.min());
    read(box.max());
  }
  template <class List>
  void read(FixedSize<List>& fixed) {
    if (read_count(1) != fixed.list.size()) throw BytesError();
    for (auto& entry : fixed.list) read(entry);
  }
  template <class Entry, std::size_t n>
  void read(Entry (&entries)[n]) {
    for (Entry& entry : entries) read(entry);
  }
  template <class Entry, class Allocator>
  void read(std::vector<Entry, Allocator>& entries) {
    entries.clear();
    if constexpr (PlainNumber<Entry>) {
      entries.resize(read_count(sizeof(Entry)));
      copy(entries.data(), entries.size() * sizeof(Entry));
    } else {
      const std::size_t count = read_count(1);
      for (std::size_t k = 0; k < count; ++k) read(entries.emplace_back());
    }
  }
  template <class Entry, std::size_t n>
  void read(std::array<Entry, n>& entries) {
    for (Entry& entry : entries) read(entry);
  }
  template <class Entry>
  void read(std::optional<Entry>& entry) {
    bool has_value = false;
    read(has_value);
    entry.reset();
    if (has_value) read(entry.emplace());
  }
  template <class Key, class Entry>
  void read(std::map<Key, Entry>& entries) {
    entries.clear();
    const std::size_t count = read_count(1);
    for (std::size_t k = 0; k < count; ++k) {
      Key key{};
      read(key);
      read(entries[std::move(key)]);
    }
  }
  template <class Struct>
  requires(std::is_class_v<Struct> && !EigenArray<Struct>) void read(Struct& value) {
    visit_members(value, [this](auto&&... members) { (this->read(members), ...); });
  }

 private:
  void copy(void* to, std::size_t size) {
    if (size > bytes_.size()) throw BytesError();
    if (size > 0) std::memcpy(to, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  /// Of entries that have at least `size` bytes each.
  [[nodiscard]] std::size_t read_count(std::size_t size) {
    std::size_t count = 0;
    read(count);
    if (count > bytes_.size() / size) throw BytesError();
    return count;
  }

  std::string_view bytes_;
};

/// Throws BytesError, also if bytes are left.
template <class Value>
void from_bytes(std::string_view bytes, Value& value) {
  BinaryReader reader(bytes);
  reader.read(value);
  if (reader.remaining() > 0) throw BytesError();
}

}  // namespace sprung
