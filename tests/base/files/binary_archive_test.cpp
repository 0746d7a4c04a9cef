#include "base/files/binary_archive.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace sprung {

struct Pair {
  int number = 0;
  std::vector<double> values{};
  bool operator==(const Pair&) const = default;
};

struct All {
  bool flag = false;
  std::string text{};
  std::vector<Pair> pairs{};
  std::array<Pair, 2> two{};
  std::optional<Pair> some{};
  std::optional<Pair> none{};
  std::map<std::string, Vector3> named{};
  Points points{};
  RigidTransform pose = RigidTransform::Identity();
};

template <Same<Pair> S, class Visit>
void visit_members(S& p, const Visit& visit) {
  visit(p.number, p.values);
}
template <Same<All> S, class Visit>
void visit_members(S& a, const Visit& visit) {
  visit(a.flag, a.text, a.pairs, a.two, a.some, a.none, a.named, a.points, a.pose);
}

namespace {

All sample() {
  All all;
  all.flag = true;
  all.text = "a text";
  all.pairs = {{1, {0.5, -2.0}}, {2, {}}};
  all.two = {Pair{3, {1.0}}, Pair{4, {}}};
  all.some = Pair{5, {7.0}};
  all.named["b"] = Vector3(1.0, 2.0, 3.0);
  all.points = Points::Constant(3, 2, 0.25);
  all.pose.translation() = Vector3(1.0, 0.0, -1.0);
  return all;
}

TEST(BinaryArchive, ReadsWhatItWrote) {
  const All all = sample();
  All read;
  from_bytes(to_bytes(all), read);
  EXPECT_EQ(read.flag, all.flag);
  EXPECT_EQ(read.text, all.text);
  EXPECT_EQ(read.pairs, all.pairs);
  EXPECT_EQ(read.two, all.two);
  EXPECT_EQ(read.some, all.some);
  EXPECT_FALSE(read.none.has_value());
  EXPECT_EQ(read.named, all.named);
  EXPECT_EQ(read.points, all.points);
  EXPECT_TRUE(read.pose.isApprox(all.pose, 0.0));
  EXPECT_EQ(to_bytes(read), to_bytes(all));
}

TEST(BinaryArchive, ReplacesWhatWasThere) {
  All read = sample();
  from_bytes(to_bytes(All()), read);
  EXPECT_EQ(to_bytes(read), to_bytes(All()));
}

TEST(BinaryArchive, RefusesBytesThatEndEarlyOrLate) {
  const std::string bytes = to_bytes(sample());
  All read;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(from_bytes(std::string_view(bytes).substr(0, size), read), BytesError) << size;
  }
  EXPECT_THROW(from_bytes(bytes + '\0', read), BytesError);
}

// Counts beyond the bytes must not reserve memory.
TEST(BinaryArchive, RefusesImpossibleCounts) {
  const std::string huge = to_bytes(std::size_t{1} << 60U);
  std::vector<double> numbers;
  EXPECT_THROW(from_bytes(huge + "12345678", numbers), BytesError);
  std::vector<Pair> pairs;
  EXPECT_THROW(from_bytes(huge + "12345678", pairs), BytesError);
  std::string text;
  EXPECT_THROW(from_bytes(huge + "12345678", text), BytesError);
  Points points;
  EXPECT_THROW(from_bytes(to_bytes(Eigen::Index{3}) + to_bytes(Eigen::Index{1} << 60U), points), BytesError);
  EXPECT_THROW(from_bytes(to_bytes(Eigen::Index{4}) + to_bytes(Eigen::Index{0}), points), BytesError);
  EXPECT_THROW(from_bytes(to_bytes(Eigen::Index{3}) + to_bytes(Eigen::Index{-1}), points), BytesError);
}

TEST(BinaryArchive, RefusesFlagsThatAreNeither) {
  bool flag = false;
  EXPECT_THROW(from_bytes("\2", flag), BytesError);
}

TEST(BinaryArchive, EqualValuesAloneHaveEqualBytes) {
  All other = sample();
  EXPECT_EQ(to_bytes(other), to_bytes(sample()));
  other.points(2, 1) = std::nextafter(0.25, 1.0);
  EXPECT_NE(to_bytes(other), to_bytes(sample()));
  EXPECT_NE(to_bytes(std::vector<std::string>{"ab", "c"}), to_bytes(std::vector<std::string>{"a", "bc"}));
}

}  // namespace
}  // namespace sprung
