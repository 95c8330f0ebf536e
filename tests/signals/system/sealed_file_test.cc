#include "signals/system/sealed_file.h"

#include <gmock/gmock.h>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

using testing::HasSubstr;

void expect_closed(const Seal& seal, const std::string& why) {
  try {
    unseal(seal);
    FAIL() << "was opened; expected: " << why;
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr(why));
  }
}

TEST(SealedFile, OpensToTheSameText) {
  for (const std::string& text : {std::string(), std::string("a"), std::string(100000, 'x')})
    EXPECT_EQ(unseal(seal(text)), text);
}

TEST(SealedFile, ShowsNothingOfTheText) {
  const std::string text = "stiffness stiffness stiffness stiffness";
  const Seal one = seal(text), two = seal(text);
  EXPECT_NE(one.cipher, two.cipher);
  EXPECT_NE(one.commitment, two.commitment) << "without salt a guess could be checked";
}

TEST(SealedFile, StaysClosedToWhatIsNotItsKey) {
  const Seal one = seal("delay"), two = seal("delay");
  expect_closed({one.cipher, two.key, one.commitment}, "the key is wrong");
  expect_closed({one.cipher, "", one.commitment}, "its length is wrong");
  expect_closed({one.cipher, "zz" + one.key.substr(2), one.commitment}, "hexadecimal");
  expect_closed({"00", one.key, one.commitment}, "cut off");
}

TEST(SealedFile, NoticesAChangedTextAndAnotherCommitment) {
  Seal one = seal("delay");
  const Seal two = seal("none");
  expect_closed({one.cipher, one.key, two.commitment}, "differs from the text of the commitment");
  one.cipher[30] = one.cipher[30] == '0' ? '1' : '0';
  expect_closed(one, "changed");
}

}  // namespace
}  // namespace vibrissa::signals
