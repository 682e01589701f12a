#include "scenarios/config/digest.hpp"

#include <gtest/gtest.h>

namespace ironbird::scenarios {
namespace {

struct DigestCase {
  const char* name;
  std::string text;
  const char* digest;
};
class DigestTest : public ::testing::TestWithParam<DigestCase> {};

TEST_P(DigestTest, MatchesThePublishedVector) {
  EXPECT_EQ(digest(GetParam().text), GetParam().digest);
}

// Examples of FIPS 180-4's test vectors. The lengths lie on both sides of where padding needs one more block.
INSTANTIATE_TEST_SUITE_P(
    Vectors, DigestTest,
    ::testing::Values(
        DigestCase{"Nothing", "", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"},
        DigestCase{"Abc", "abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"},
        DigestCase{"TwoBlocks", "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq",
                   "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1"},
        DigestCase{
            "LongTwoBlocks",
            "abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmnhijklmnoijklmnopjklmnopqklmnopqrlmnopqrs"
            "mnopqrstnopqrstu",
            "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1"},
        DigestCase{"AMillion", std::string(1000000, 'a'),
                   "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace ironbird::scenarios
