#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "scenarios/config/user_error.hpp"
#include "scenarios/video/image_diff.hpp"
#include "scenarios/video/png.hpp"
#include "scenarios/video/video_sink.hpp"
#include "scenarios/video/yuv.hpp"

namespace ironbird::scenarios {
namespace {

using simulator::Image;
using simulator::Pixel;
namespace fs = std::filesystem;

class ImageTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  const fs::path folder_ =
      fs::path(::testing::TempDir()) /
      ("ironbird_image_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
};

Image texture(int width, int height, int shift = 0) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at(x, y) =
          Pixel{static_cast<std::uint8_t>(7 * (x + shift) + 3 * y), static_cast<std::uint8_t>(5 * x * y),
                static_cast<std::uint8_t>(x + 11 * y), 255};
    }
  }
  return image;
}

std::string bytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_F(ImageTest, ComesBackFromPngUnchanged) {
  const Image image = texture(37, 21);
  write_png(image, folder_ / "a.png");
  EXPECT_EQ(read_png(folder_ / "a.png"), image);
  EXPECT_FALSE(fs::exists(folder_ / "a.png.part"));
}

TEST_F(ImageTest, SaysWhichPngCannotBeReadOrWritten) {
  for (const auto& act : {+[](const fs::path& file) { read_png(file); },
                          +[](const fs::path& file) { write_png(Image(2, 2), file); }}) {
    try {
      act(folder_ / "nowhere" / "a.png");
      FAIL() << "no error";
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("nowhere/a.png"), std::string::npos) << error.what();
    }
  }
}

TEST_F(ImageTest, EqualsItself) {
  const ImageDistance d = compare(texture(64, 48), texture(64, 48));
  EXPECT_TRUE(d.identical());
  EXPECT_EQ(d.likeness, 1.0);
  EXPECT_EQ(d.changed, 0.0);
}

TEST_F(ImageTest, IsAsFarFromAnotherAsTheOtherFromIt) {
  const ImageDistance ab = compare(texture(64, 48), texture(64, 48, 3));
  const ImageDistance ba = compare(texture(64, 48, 3), texture(64, 48));
  EXPECT_DOUBLE_EQ(ab.likeness, ba.likeness);
  EXPECT_EQ(ab.greatest, ba.greatest);
  EXPECT_LT(ab.likeness, 0.99);
}

TEST_F(ImageTest, CountsOneChangedPixelExactly) {
  const Image a = texture(64, 48);
  Image b = a;
  b.at(10, 10).g = static_cast<std::uint8_t>(b.at(10, 10).g ^ 1);
  const ImageDistance d = compare(a, b);
  EXPECT_FALSE(d.identical());
  EXPECT_DOUBLE_EQ(d.changed, 1.0 / (64 * 48));
  EXPECT_EQ(d.greatest, 1);
  EXPECT_GT(d.likeness, 0.9999);
  const Image difference = difference_picture(a, b);
  EXPECT_GT(difference.at(10, 10).r, difference.at(10, 10).g + 40);
  EXPECT_EQ(difference.at(11, 10).r, difference.at(11, 10).g);
}

TEST_F(ImageTest, MindsStructureMoreThanBrightness) {
  Image bright = texture(64, 64);
  Image flat(64, 64, Pixel{128, 128, 128, 255});
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      Pixel& p = bright.at(x, y);
      p = Pixel{static_cast<std::uint8_t>(p.r * 9 / 10), static_cast<std::uint8_t>(p.g * 9 / 10),
                static_cast<std::uint8_t>(p.b * 9 / 10), 255};
    }
  }
  const Image original = texture(64, 64);
  EXPECT_GT(compare(original, bright).likeness, 0.95);
  EXPECT_LT(compare(original, flat).likeness, 0.3);
}

TEST_F(ImageTest, DoesNotCompareDifferentSizes) {
  EXPECT_FALSE(compare(Image(4, 4), Image(4, 6)).same_size);
  EXPECT_FALSE(compare(Image(4, 4), Image(4, 6)).identical());
}

struct ColorCase {
  Pixel color;
  int y, u, v;
};

// ITU-R BT.709, limited range.
TEST_F(ImageTest, BecomesStandardYuv) {
  for (const ColorCase& c :
       {ColorCase{{255, 255, 255, 255}, 235, 128, 128}, ColorCase{{0, 0, 0, 255}, 16, 128, 128},
        ColorCase{{255, 0, 0, 255}, 63, 102, 240}, ColorCase{{0, 255, 0, 255}, 173, 42, 26},
        ColorCase{{0, 0, 255, 255}, 32, 240, 118}}) {
    std::vector<std::uint8_t> yuv(yuv420_size(4, 2));
    to_yuv420(Image(4, 2, c.color), yuv);
    constexpr int kRounding = 1;  // of coefficients in 256ths
    EXPECT_NEAR(yuv[0], c.y, kRounding);
    EXPECT_NEAR(yuv[8], c.u, kRounding);
    EXPECT_NEAR(yuv[10], c.v, kRounding);
  }
}

TEST_F(ImageTest, MakesY4mByteForByte) {
  const auto sink = make_y4m_sink(folder_ / "a.y4m", {2, 2, 30});
  sink->write(std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6});
  sink->write(std::vector<std::uint8_t>{7, 8, 9, 10, 11, 12});
  sink->finish();
  EXPECT_EQ(bytes(folder_ / "a.y4m"),
            "YUV4MPEG2 W2 H2 F30:1 Ip A1:1 C420jpeg XCOLORRANGE=LIMITED\n"
            "FRAME\n\x01\x02\x03\x04\x05\x06"
            "FRAME\n\x07\x08\x09\x0a\x0b\x0c");
}

TEST_F(ImageTest, LeavesNoUnfinishedFile) {
  make_y4m_sink(folder_ / "a.y4m", {2, 2, 30})->write(std::vector<std::uint8_t>(6));
  make_mp4_sink(folder_ / "a.mp4", {16, 16, 30}, "ultrafast")->write(std::vector<std::uint8_t>(384));
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(ImageTest, SaysThatTheEncoderIsMissing) {
  try {
    make_mp4_sink(folder_ / "a.mp4", {16, 16, 30}, "ultrafast", "no-such-encoder");
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("'no-such-encoder', which was not found; install it"),
              std::string::npos)
        << error.what();
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(ImageTest, FindsTheEncoderOrSaysHowItCannotBeStarted) {
  EXPECT_NO_THROW(check_encoder());
  EXPECT_THROW(check_encoder("no-such-encoder"), UserError);
  const std::string path = std::getenv("PATH");
  std::ofstream(folder_ / "closed-encoder") << "#!/bin/sh\n";
  setenv("PATH", (folder_.string() + ":" + path).c_str(), 1);
  try {
    check_encoder("closed-encoder");
    ADD_FAILURE() << "no error";
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("cannot be started: Permission denied; install it"),
              std::string::npos)
        << error.what();
  }
  fs::permissions(folder_ / "closed-encoder", fs::perms::owner_all);
  EXPECT_NO_THROW(check_encoder("closed-encoder"));
  setenv("PATH", path.c_str(), 1);
}

TEST_F(ImageTest, SaysThatTheEncoderMadeNothingThoughItEndedWell) {
  const fs::path encoder = folder_ / "encoder";
  std::ofstream(encoder) << "#!/bin/sh\ncat >/dev/null\n";
  fs::permissions(encoder, fs::perms::owner_all);
  try {
    make_mp4_sink(folder_ / "a.mp4", {16, 16, 30}, "ultrafast", encoder.string())->finish();
    ADD_FAILURE() << "no error";
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("it gave no reason; see whether"), std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(fs::exists(folder_ / "a.mp4"));
}

TEST_F(ImageTest, RepeatsWhatTheEncoderComplainsAbout) {
  try {
    const auto sink = make_mp4_sink(folder_ / "a.mp4", {16, 16, 30}, "no-such-preset");
    sink->write(std::vector<std::uint8_t>(384));
    sink->finish();
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("a.mp4: 'ffmpeg' failed: "), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(ImageTest, RepeatsItOnADiskThatHasNoRoomForAnotherFile) {
  // GIVEN an encoder that meets a full disk, which nothing beside the film would fit on either
  const fs::path encoder = folder_ / "encoder";
  std::ofstream(encoder) << "#!/bin/sh\necho 'x: No space left on device' >&2\nexit 1\n";
  fs::permissions(encoder, fs::perms::owner_all);
  fs::create_directories(folder_ / "a.mp4.log");
  // WHEN it ends THEN its words and what helps are told
  try {
    make_mp4_sink(folder_ / "a.mp4", {16, 16, 30}, "ultrafast", encoder.string())->finish();
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("failed: x: No space left on device; make room there"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace ironbird::scenarios
