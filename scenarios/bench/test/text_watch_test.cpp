#include "scenarios/bench/text_watch.hpp"

#include <gtest/gtest.h>

#include <string>

namespace ironbird::scenarios {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(TextWatchTest, TellsATextThatIsRepeatedInEveryStepOnce) {
  TextWatch watch;
  int news = 0;
  for (int i = 0; i < 40000; ++i) {
    news += static_cast<int>(watch.is_news("motor demand before scaling: " + std::to_string(2.0 + 0.001 * i),
                                           milliseconds(5 * i)));
  }
  EXPECT_EQ(news, 1) << "in 200 s, with another number each time";
}

TEST(TextWatchTest, TellsItAgainWhenItWasQuietForAWhile) {
  TextWatch watch;
  EXPECT_TRUE(watch.is_news("RC is lost", seconds(1)));
  EXPECT_FALSE(watch.is_news("RC is lost", seconds(10)));
  EXPECT_TRUE(watch.is_news("IMU is silent", seconds(10)));
  EXPECT_FALSE(watch.is_news("RC is lost", seconds(20))) << "counted from when it was heard last";
  EXPECT_TRUE(watch.is_news("RC is lost", seconds(31)));
}

TEST(TextWatchTest, KeepsItsSizeWhenTheTextsNeverEnd) {
  TextWatch watch;
  for (int i = 0; i < 1000; ++i) {
    EXPECT_TRUE(watch.is_news(std::string(1, static_cast<char>('a' + i % 26)) + std::string(i / 26 + 1, 'x'),
                              milliseconds(i)));
  }
}

}  // namespace
}  // namespace ironbird::scenarios
