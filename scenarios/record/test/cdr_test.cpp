#include "scenarios/record/cdr.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "scenarios/config/user_error.hpp"
#include "scenarios/record/cdr_decoder.hpp"
#include "scenarios/record/test/by_hand.hpp"
#include "scenarios/record/test/samples.hpp"

namespace ironbird::scenarios {
namespace {

using by_hand::f64;
using by_hand::pad;
using by_hand::u16;
using by_hand::u32;
using by_hand::u64;
using by_hand::u8;

std::string f32(float value) {
  return u32(std::bit_cast<std::uint32_t>(value));
}

const std::string kHeader("\0\1\0\0", 4);

template <class T>
std::string encoded(const T& value, std::size_t capacity = 0) {
  ByteBuffer out(capacity);
  encode_cdr(value, out);
  return {reinterpret_cast<const char*>(out.data()), out.size()};
}

/// The bytes of samples::filled(), with the offset behind the header that each line ends at.
std::string filled_by_hand() {
  return kHeader + u8(1) + u8(0xFE) + u16(0x1234) + u32(0xFFFFFFFB) +  // 8: flag, tiny, small, whole
         u64(0x0102030405060708) + f32(1.5f) + pad(4) + f64(-2.0) +    // 32: huge, single, number
         u8(7) + pad(3) + u32(0xFFFFFFFF) + u32(999999999) + pad(4) +  // 48: colour, stamp = -1 ns
         f64(1) + f64(2) + f64(3) + f64(4) + f64(5) +                  // 88: p_NB_N, plane
         f64(-0.5) + f64(0.25) + f64(0.125) + f64(0.5) +               // 120: q_NB as x, y, z, w
         f64(1) + f64(2) + f64(3) + f64(4) + f64(5) + f64(6) + f64(7) + f64(8) + f64(9) +  // 192: row by row
         f32(10) + f32(11) + f32(12) + pad(4) +                                            // 208: fixed
         f64(1) + u8(1) + pad(7) + f64(2) + u8(0) + pad(3) +                               // 236: pair
         u32(4) + "abc" + u8(0) + u32(3) + "hi" + u8(0) + pad(1) +                         // 252: label, note
         u32(2) + f64(6) + f64(7) +                                                        // 272: list
         u32(1) + pad(4) + f64(8) + u8(1) + pad(3) +                                       // 292: inners
         u32(1) + f64(9) +                                                                 // 304: maybe
         u32(0) +                                                                          // 308: perhaps
         u8(1) + pad(3) + u32(1) + pad(4) + f64(12) + u8(1);                               // 329: choice
}

TEST(CdrTest, EncodesEveryKindOfMemberByteForByte) {
  EXPECT_EQ(encoded(samples::filled()), filled_by_hand());
}

TEST(CdrTest, GivesTheSameBytesWhenTheBufferGrowsAnywhere) {
  for (std::size_t capacity = 0; capacity < 400; ++capacity) {
    ASSERT_EQ(encoded(samples::filled(), capacity), filled_by_hand()) << capacity;
  }
}

TEST(CdrTest, CountsAlignmentFromBehindItsOwnHeader) {
  ByteBuffer out;
  out.append("12345", 5);
  encode_cdr(samples::filled(), out);
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(out.data()) + 5, out.size() - 5), filled_by_hand());
}

TEST(CdrTest, LeavesNoTraceOfEarlierContentInItsPadding) {
  ByteBuffer out(1024);
  std::memset(out.data(), 0xAA, out.capacity());
  encode_cdr(samples::filled(), out);
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(out.data()), out.size()), filled_by_hand());
}

TEST(CdrTest, WritesOneByteForAnEmptyStruct) {
  EXPECT_EQ(encoded(samples::Nothing{}), kHeader + u8(0));
}

TEST(CdrTest, WritesOnlyTheKindOfAnEmptyAlternative) {
  EXPECT_EQ(encoded(samples::Choice{samples::Nothing{}}), kHeader + u8(0) + pad(3) + u32(0));
}

struct Text {
  std::array<char, 4> full{'a', 'b', 'c', 'd'};
  std::array<char, 4> empty{};
  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("full", self.full, "", "without a NUL");
    visit("empty", self.empty, "", "nothing but NUL");
  }
};

TEST(CdrTest, EndsATextAtItsFirstNul) {
  EXPECT_EQ(encoded(Text{}), kHeader + u32(5) + "abcd" + u8(0) + pad(3) + u32(1) + u8(0));
}

TEST(CdrTest, KeepsItsMemoryOnceItHasSeenTheLargestMessage) {
  ByteBuffer out;
  encode_cdr(samples::filled(), out);
  const std::uint8_t* memory = out.data();
  for (int i = 0; i < 10; ++i) {
    out.clear();
    encode_cdr(samples::filled(), out);
    EXPECT_EQ(out.data(), memory);
  }
}

std::span<const std::uint8_t> message_in(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(CdrDecoderTest, ReadsEveryKindOfMemberBack) {
  EXPECT_EQ(encoded(decode_cdr<samples::Everything>(message_in(filled_by_hand()))), filled_by_hand());
}

TEST(CdrDecoderTest, ReadsWhatIsAbsentAndEmptyBack) {
  const std::string nothing = encoded(samples::Everything{});
  EXPECT_EQ(encoded(decode_cdr<samples::Everything>(message_in(nothing))), nothing);
}

TEST(CdrDecoderTest, RefusesEveryTruncationAndWhatIsTooLong) {
  const std::string whole = filled_by_hand();
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(decode_cdr<samples::Everything>(message_in(whole.substr(0, size))), UserError) << size;
  EXPECT_THROW(decode_cdr<samples::Everything>(message_in(whole + u8(0))), UserError);
}

TEST(CdrDecoderTest, NeverEndsOtherwiseThanWithAValueOrARefusal) {
  for (std::size_t at = 0; at < filled_by_hand().size(); ++at) {
    for (const int damage : {0, 1, 0x7F, 0xFF}) {
      std::string bytes = filled_by_hand();
      bytes[at] = static_cast<char>(damage);
      try {
        // What is taken says the same when it is written again.
        const auto value = decode_cdr<samples::Everything>(message_in(bytes));
        EXPECT_EQ(encoded(decode_cdr<samples::Everything>(message_in(encoded(value)))), encoded(value)) << at;
      } catch (const UserError&) {
      }
    }
  }
}

struct Chosen {
  samples::Colour colour = samples::Colour::kRed;
  samples::Choice choice;
  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("colour", self.colour, "1", "an enumeration");
    visit("choice", self.choice, "", "a variant");
  }
};

TEST(CdrDecoderTest, RefusesNamesAndKindsThatThereAreNot) {
  const auto refusal = [](const std::string& bytes) {
    try {
      decode_cdr<Chosen>(message_in(kHeader + bytes));
    } catch (const UserError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  EXPECT_EQ(refusal(u8(7) + u8(0) + pad(2) + u32(0)), "taken");
  EXPECT_EQ(refusal(u8(2) + u8(0) + pad(2) + u32(0)), "holds 2 where no name is known for it");
  EXPECT_EQ(refusal(u8(7) + u8(2) + pad(2) + u32(0)), "holds a kind that is not known");
  EXPECT_EQ(refusal(u8(7) + u8(1) + pad(2) + u32(0)), "holds another kind than it says");
  EXPECT_EQ(refusal(u8(7) + u8(0) + pad(2) + u32(2)), "holds 2 of what there is one of at most");
}

}  // namespace
}  // namespace ironbird::scenarios
