#include "scenarios/config/toml_depth.hpp"

#include <gtest/gtest.h>

#include "scenarios/config/config_error.hpp"
#include "scenarios/config/include.hpp"

namespace ironbird::scenarios {
namespace {

/// `a.a.a`, of so many parts.
std::string key(std::size_t parts, const std::string& part = "a") {
  std::string text = part;
  for (std::size_t i = 1; i < parts; ++i) text += "." + part;
  return text;
}

std::string error(const std::string& text) {
  try {
    parse_toml(text, "a.toml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

const std::string kRefusal = ": more than 16 tables lie in one another";

TEST(TomlDepthTest, TakesAKeyOfSixteenParts) {
  EXPECT_EQ(error(key(kDeepestToml) + " = 1\n"), "no error");
  EXPECT_EQ(error("[" + key(kDeepestToml) + "]\n"), "no error");
}

// Each of these ended the program, or took gigabytes, when the table was taken down.
TEST(TomlDepthTest, RefusesALongKeyBeforeItIsParsed) {
  for (const std::size_t parts : {kDeepestToml + 1, std::size_t{500'000}}) {
    EXPECT_EQ(error("x = 1\n  " + key(parts) + " = 1\n"), "a.toml:2:4" + kRefusal);
    EXPECT_EQ(error("[" + key(parts) + "]\n"), "a.toml:1:3" + kRefusal);
    EXPECT_EQ(error("[[" + key(parts, " b ") + "]]\n"), "a.toml:1:6" + kRefusal);
    EXPECT_EQ(error(key(parts, "\"\xC3\xA4\"") + " = 1\n"), "a.toml:1:4" + kRefusal);
  }
}

TEST(TomlDepthTest, FindsALongKeyBehindTextsInQuotes) {
  const std::string inner = key(20) + " = 1}\n";
  EXPECT_EQ(error("x = {b = \"a\\\"\", " + inner), "a.toml:1:18" + kRefusal);
  EXPECT_EQ(error("x = {b = '\\', " + inner), "a.toml:1:16" + kRefusal);
  EXPECT_EQ(error("x = {b = \"\"\"a\"\"\"\"\", " + inner), "a.toml:1:22" + kRefusal);
  EXPECT_EQ(error("x = {b = '''a'''', " + inner), "a.toml:1:21" + kRefusal);
  EXPECT_EQ(error("x = '''\n'' # \"'''\n" + key(20) + " = 1\n"), "a.toml:3:2" + kRefusal);
}

TEST(TomlDepthTest, LeavesDotsInTextsAndCommentsAlone) {
  const std::string dots(40, '.');
  EXPECT_EQ(error("# " + dots + "\nx = \"" + dots + "\"\ny = '" + dots + "'\n"), "no error");
  EXPECT_EQ(error("x = \"\"\"\n" + dots + "\n\"\"\"\"\ny = '''" + dots + "''''' # \"\n"), "no error");
}

TEST(TomlDepthTest, RefusesWhatBracketsNest) {
  EXPECT_EQ(error("x = " + std::string(15, '[') + std::string(15, ']') + "\n"), "no error");
  EXPECT_EQ(error("x = " + std::string(17, '[') + std::string(17, ']') + "\n"), "a.toml:1:21" + kRefusal);
  std::string tables = "1";
  for (int i = 0; i < 250; ++i) tables = "{" + key(kDeepestToml) + " = " + tables + "}";
  EXPECT_TRUE(error("x = " + tables + "\n").ends_with(kRefusal));
}

TEST(TomlDepthTest, RefusesAPathOfTheCommandLine) {
  toml::table table;
  const auto refusal = [&](const std::string& path, const std::string& text) -> std::string {
    try {
      set_value(table, path, text);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(refusal(key(17), "1"), "--set " + key(17) + kRefusal);
  EXPECT_EQ(refusal(key(16), "[[1]]"), "--set " + key(16) + "=[[1]]" + kRefusal);
  EXPECT_EQ(refusal(key(16), "1"), "no error");
}

TEST(TomlDepthTest, TakesALongKeyOfTheCommandLineAsAText) {
  toml::table table;
  set_value(table, "x", "{" + key(100'000) + " = 1}");
  EXPECT_TRUE(table["x"].is_string());
  set_value(table, "x", std::string(40, '.'));
  EXPECT_EQ(table["x"].value<std::string>(), std::string(40, '.'));
}

}  // namespace
}  // namespace ironbird::scenarios
