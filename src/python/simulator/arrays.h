// NumPy arrays of points, and tables: structured arrays.
#pragma once

#include "base/types.h"

#include <pybind11/numpy.h>

#include <span>
#include <string>
#include <vector>

namespace sprung::python {

/// An (n, 3) view on columns of points, which keeps `owner` alive.
[[nodiscard]] pybind11::array view_of(double* data, Index count, const pybind11::object& owner);

/// A read-only (n, 3) copy.
[[nodiscard]] pybind11::array copy_of(const Eigen::Ref<const Points>& points);

/// A read-only copy, (n,).
[[nodiscard]] pybind11::array copy_of(std::span<const double> numbers);
[[nodiscard]] pybind11::array copy_of(std::span<const Index> numbers);

/// A read-only (n, rows) copy of a matrix of indices.
[[nodiscard]] pybind11::array copy_of(const Eigen::Ref<const Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic>>& indices);

/// A read-only (4, 4) copy.
[[nodiscard]] pybind11::array matrix_of(const RigidTransform& pose);

/// Numbers from Python, 3 x n. Throws InputError under this key unless they are an (n, 3) array of numbers.
[[nodiscard]] Points points_of(const pybind11::object& value, const std::string& key);
/// The same, of `count` rows.
[[nodiscard]] Points points_of(const pybind11::object& value, const std::string& key, Index count);
[[nodiscard]] Vector3 vector_of(const pybind11::object& value, const std::string& key);
/// Whether this is a pose rather than a position.
[[nodiscard]] bool is_matrix(const pybind11::object& value, const std::string& key);
/// A number for each of `count` things, from a number or an array (count,).
[[nodiscard]] std::vector<double> numbers_of(const pybind11::object& value, const std::string& key, Index count);
/// Numbers of particles: from a number, or a sequence or an array (n,) of whole numbers.
[[nodiscard]] std::vector<Index> indices_of(const pybind11::object& value, const std::string& key);
/// A (4, 4) matrix; rotation and translation are for the simulator to check.
[[nodiscard]] RigidTransform pose_of(const pybind11::object& value, const std::string& key);

/// The name of the type of a value, for messages: `list`.
[[nodiscard]] std::string type_name(const pybind11::handle& value);

/// A column of a table.
struct Column {
  std::string name;
  pybind11::object type;  ///< as numpy.dtype takes it: "f8", or ("f8", (3,))
  pybind11::object values;
};

/// A structured array of `rows` rows.
[[nodiscard]] pybind11::array table_of(Index rows, const std::vector<Column>& columns);

/// The names of things by their numbers, as an array of texts; kNone: "".
[[nodiscard]] pybind11::array names_of(const std::vector<std::string>& names, const std::vector<Index>& numbers);

}  // namespace sprung::python
