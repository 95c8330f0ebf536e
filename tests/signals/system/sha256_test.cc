#include "signals/system/sha256.h"

#include <gtest/gtest.h>

namespace vibrissa::signals {
namespace {

// FIPS 180-4, examples of the National Institute of Standards and Technology.
TEST(Sha256, GivesThePublishedDigests) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Sha256, DoesNotCareHowTheBytesArePieced) {
  Sha256 pieces;
  pieces.add("a", 1);
  pieces.add("bc", 2);
  EXPECT_EQ(pieces.hex(), sha256("abc"));
}

}  // namespace
}  // namespace vibrissa::signals
