#include "base/files/fingerprint.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

// Values of the reference implementation of FNV-1a.
TEST(Fingerprint, IsThatOfThePaper) {
  EXPECT_EQ(fingerprint_of(""), 0xcbf29ce484222325U);
  EXPECT_EQ(fingerprint_of("a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(fingerprint_of("foobar"), 0x85944171f73967e8U);
}

TEST(Fingerprint, OfPartsIsThatOfTheWhole) {
  Fingerprint parts;
  parts.add("foo");
  parts.add("bar");
  EXPECT_EQ(parts.value(), fingerprint_of("foobar"));
}

}  // namespace
}  // namespace sprung
