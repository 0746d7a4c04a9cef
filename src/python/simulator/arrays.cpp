#include "python/simulator/arrays.h"

#include "python/simulator/errors.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace py = pybind11;

namespace sprung::python {
namespace {

using Numbers = py::array_t<double, py::array::c_style>;

constexpr py::ssize_t kSize = sizeof(double);
constexpr std::size_t kLongestValue = 60;  // letters of a value in a message

py::array frozen(py::array array) {
  array.attr("flags").attr("writeable") = false;
  return array;
}

template <class Number>
py::array copy_of_span(std::span<const Number> numbers) {
  py::array_t<Number> array(static_cast<py::ssize_t>(numbers.size()));
  std::ranges::copy(numbers, array.mutable_data());
  return frozen(std::move(array));
}

std::string shape_of(const py::array& array) { return py::str(array.attr("shape")).cast<std::string>(); }

/// Floating point numbers, without those of which NumPy would make some silently: complex numbers and texts.
Numbers numbers_from(const py::object& value, const std::string& key, const std::string& wanted) {
  const std::string rule = "must be an array of numbers, " + wanted;
  py::object array;
  try {
    array = py::module_::import("numpy").attr("asarray")(value);
  } catch (const py::error_already_set&) {
    refuse(key, type_name(value), rule, "give an array");
  }
  const auto kind = array.attr("dtype").attr("kind").cast<std::string>();
  if (kind != "f" && kind != "i" && kind != "u" && kind != "b") {
    refuse(key, "dtype " + py::str(array.attr("dtype")).cast<std::string>(), rule, "give an array of float64");
  }
  return Numbers(array);
}

[[noreturn]] void refuse_shape(const py::array& array, const std::string& key, const std::string& wanted) {
  refuse(key, "shape " + shape_of(array), "must have the shape " + wanted, "reshape it, or give one row for each");
}

}  // namespace

py::array view_of(double* data, Index count, const py::object& owner) {
  return py::array_t<double>({py::ssize_t{count}, py::ssize_t{3}}, {3 * kSize, kSize}, data, owner);
}

py::array copy_of(const Eigen::Ref<const Points>& points) {
  py::array_t<double> array({py::ssize_t{points.cols()}, py::ssize_t{3}});
  Eigen::Map<Points>(array.mutable_data(), 3, points.cols()) = points;
  return frozen(std::move(array));
}

py::array copy_of(std::span<const double> numbers) { return copy_of_span(numbers); }
py::array copy_of(std::span<const Index> numbers) { return copy_of_span(numbers); }

py::array copy_of(const Eigen::Ref<const Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic>>& indices) {
  py::array_t<Index> array({py::ssize_t{indices.cols()}, py::ssize_t{indices.rows()}});
  Eigen::Map<Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic>>(array.mutable_data(), indices.rows(), indices.cols()) = indices;
  return frozen(std::move(array));
}

py::array matrix_of(const RigidTransform& pose) {
  py::array_t<double> array({4, 4});
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.mutable_data()) = pose.matrix();
  return frozen(std::move(array));
}

Points points_of(const py::object& value, const std::string& key) {
  const Numbers numbers = numbers_from(value, key, "shape (n, 3)");
  if (numbers.ndim() != 2 || numbers.shape(1) != 3) refuse_shape(numbers, key, "(n, 3)");
  return Eigen::Map<const Points>(numbers.data(), 3, numbers.shape(0));
}

Points points_of(const py::object& value, const std::string& key, Index count) {
  const std::string wanted = "(" + std::to_string(count) + ", 3)";
  const Numbers numbers = numbers_from(value, key, "shape " + wanted);
  if (numbers.ndim() != 2 || numbers.shape(1) != 3 || numbers.shape(0) != count) refuse_shape(numbers, key, wanted);
  return Eigen::Map<const Points>(numbers.data(), 3, numbers.shape(0));
}

Vector3 vector_of(const py::object& value, const std::string& key) {
  const Numbers numbers = numbers_from(value, key, "shape (3,)");
  if (numbers.ndim() != 1 || numbers.shape(0) != 3) refuse_shape(numbers, key, "(3,)");
  return Eigen::Map<const Vector3>(numbers.data());
}

bool is_matrix(const py::object& value, const std::string& key) {
  return numbers_from(value, key, "shape (3,) or (4, 4)").ndim() == 2;
}

std::vector<double> numbers_of(const py::object& value, const std::string& key, Index count) {
  const std::string wanted = "() or (" + std::to_string(count) + ",)";
  const Numbers numbers = numbers_from(value, key, "shape " + wanted);
  if (numbers.ndim() == 0) return std::vector<double>(static_cast<std::size_t>(count), *numbers.data());
  if (numbers.ndim() != 1 || numbers.shape(0) != count) refuse_shape(numbers, key, wanted);
  return {numbers.data(), numbers.data() + count};
}

std::vector<Index> indices_of(const py::object& value, const std::string& key) {
  const py::module_ numpy = py::module_::import("numpy");
  const char* const rule = "must be the number of a particle, or a list of them";
  const char* const remedy = "count particles from 0";
  py::array array;
  try {
    array = numpy.attr("atleast_1d")(value).cast<py::array>();
  } catch (const py::error_already_set&) {
    refuse(key, type_name(value), rule, remedy);
  }
  const auto kind = array.attr("dtype").attr("kind").cast<std::string>();
  if (array.ndim() != 1 || (kind != "i" && kind != "u" && array.size() > 0)) {
    refuse(key, py::repr(value).cast<std::string>().substr(0, kLongestValue), rule, remedy);
  }
  std::vector<Index> indices;
  const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> numbers(array);
  for (py::ssize_t k = 0; k < numbers.size(); ++k) {
    const std::int64_t number = numbers.at(k);
    if (number < 0 || number > std::numeric_limits<Index>::max()) {
      refuse(key + "[" + std::to_string(k) + "]", std::to_string(number), rule, remedy);
    }
    indices.push_back(static_cast<Index>(number));
  }
  return indices;
}

RigidTransform pose_of(const py::object& value, const std::string& key) {
  const Numbers numbers = numbers_from(value, key, "shape (4, 4)");
  if (numbers.ndim() != 2 || numbers.shape(0) != 4 || numbers.shape(1) != 4) refuse_shape(numbers, key, "(4, 4)");
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(numbers.data());
  if (matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    refuse(key, "", "must be a rotation and a translation: the last row of the matrix is 0, 0, 0, 1", "give such a matrix");
  }
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = matrix.topLeftCorner<3, 3>();
  pose.translation() = matrix.topRightCorner<3, 1>();
  return pose;
}

std::string type_name(const py::handle& value) { return py::type::of(value).attr("__name__").cast<std::string>(); }

py::array table_of(Index rows, const std::vector<Column>& columns) {
  py::list fields;
  for (const Column& column : columns) {
    if (py::isinstance<py::tuple>(column.type)) {
      const auto type = column.type.cast<py::tuple>();
      fields.append(py::make_tuple(column.name, type[0], type[1]));
    } else {
      fields.append(py::make_tuple(column.name, column.type));
    }
  }
  py::array table = py::module_::import("numpy").attr("zeros")(rows, fields).cast<py::array>();
  for (const Column& column : columns) table.attr("__setitem__")(column.name, column.values);
  return table;
}

py::array names_of(const std::vector<std::string>& names, const std::vector<Index>& numbers) {
  py::list all;
  for (const std::string& name : names) all.append(name);
  all.append("");  // of -1
  return py::module_::import("numpy").attr("array")(all).attr("__getitem__")(copy_of(std::span(numbers))).cast<py::array>();
}

}  // namespace sprung::python
