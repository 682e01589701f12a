#include "scenarios/fcu/parameter_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "scenarios/config/config_error.hpp"

namespace ironbird::scenarios {
namespace {

using hil_bridge::kIntegerParameter;
using hil_bridge::kRealParameter;
using hil_bridge::ParameterRecord;
using testing::ElementsAre;
using testing::HasSubstr;

class ParameterFileTest : public testing::Test {
 protected:
  std::filesystem::path written(const std::string& text) const {
    std::ofstream(file_) << text;
    return file_;
  }
  std::vector<std::string> findings(const std::string& text) const {
    try {
      read_parameter_file(written(text));
    } catch (const ConfigError& error) {
      return error.findings();
    }
    return {};
  }
  const std::filesystem::path file_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string("ironbird_parameters_") + testing::UnitTest::GetInstance()->current_test_info()->name() +
       ".yaml");
};

TEST_F(ParameterFileTest, GivesEveryValueBackBitForBit) {
  std::mt19937 random(1);
  std::vector<ParameterRecord> records;
  for (int k = 0; k < 2000; ++k) {
    records.push_back({"P" + std::to_string(k), k % 2 == 0 ? kIntegerParameter : kRealParameter,
                       static_cast<std::uint32_t>(random())});
  }
  write_parameter_file(file_, records);
  EXPECT_EQ(read_parameter_file(file_), records);
}

TEST_F(ParameterFileTest, ReadsWhatTheUsualCompanionWrites) {
  const auto records =
      read_parameter_file(written("- {name: MOTOR_RESISTANCE, type: 9, value: 0.0419999994}\n"
                                  "- {type: 6, name: RC_ARM_CHN, value: -1}\n"
                                  "-\n  name: FAILSAFE_THR\n  type: 9\n  value: -1\n"));
  ASSERT_EQ(records.size(), 3U);
  EXPECT_EQ(hil_bridge::value_text(records[0]), "0.042");
  EXPECT_EQ(records[1].bits, 0xFFFFFFFFU);
  EXPECT_EQ(records[2].name, "FAILSAFE_THR");
  EXPECT_EQ(hil_bridge::value_text(records[2]), "-1");
}

TEST_F(ParameterFileTest, GivesNoParametersBackAsNone) {
  write_parameter_file(file_, {});
  EXPECT_THAT(read_parameter_file(file_), ElementsAre());
}

TEST_F(ParameterFileTest, KeepsANameThatYamlWouldTakeForNothing) {
  const std::vector<ParameterRecord> records = {{"NULL", kIntegerParameter, 1}, {"_9", kIntegerParameter, 2}};
  write_parameter_file(file_, records);
  EXPECT_EQ(read_parameter_file(file_), records);
}

TEST_F(ParameterFileTest, RefusesNamesThatNoUnitHas) {
  const std::string at = file_.string() + ":1:10: name = ";
  constexpr const char* kWanted = ", must have 1 to 16 letters, digits and underscores";
  EXPECT_THAT(findings("- {name: A B, type: 6, value: 1}\n"), ElementsAre(at + "\"A B\"" + kWanted));
  EXPECT_THAT(findings("- {name: \"\", type: 6, value: 1}\n"), ElementsAre(at + "\"\"" + kWanted));
  // GIVEN a unit, or something that is none, whose names are anything
  write_parameter_file(file_, {{"a\": {x}\n\x80", kIntegerParameter, 1}});
  // THEN the file stays one that can be read, and it is the name that is refused
  try {
    read_parameter_file(file_);
    ADD_FAILURE();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.findings(), ElementsAre(HasSubstr(kWanted)));
  }
}

TEST_F(ParameterFileTest, NamesTheBeginningOfAFileThatHoldsNothing) {
  EXPECT_THAT(findings(""), ElementsAre(HasSubstr(file_.string() + ":1:1: is no list of parameters")));
}

TEST_F(ParameterFileTest, TellsEveryMistakeWithItsLine) {
  const std::string at = file_.string() + ":";
  EXPECT_THAT(
      findings("- {name: A, type: 6, value: 1.5}\n"
               "- {name: B, type: 7, value: 1}\n"
               "- {name: C, type: 9}\n"
               "- 5\n"
               "- {name: ABCDEFGHIJKLMNOPQ, type: 6, value: 1}\n"
               "- {name: D, type: 9, value: fast}\n"
               "- {name: E, type: 6, value: 1}\n"
               "- {name: E, type: 6, value: 2}\n"),
      ElementsAre(
          at + "1:29: A = 1.5, must be a whole number of 32 bits",
          at + "2:19: B: type = 7, must be 6 (whole number) or 9 (real number)",
          at + "3:3: there is no `value`; an entry is {name: NAME, type: 6 or 9, value: VALUE}",
          at + "4:3: is no entry; an entry is {name: NAME, type: 6 or 9, value: VALUE}",
          at + "5:10: name = \"ABCDEFGHIJKLMNOPQ\", must have 1 to 16 letters, digits and underscores",
          at + "6:29: D = fast, must be a real number", at + "8:10: E: comes twice"));
}

TEST_F(ParameterFileTest, RefusesKeysThatItWouldGoPastInSilence) {
  const std::string at = file_.string() + ":";
  EXPECT_THAT(
      findings("- {name: A, type: 6, value: 1, value: 2}\n"
               "- {name: B, type: 6, valu: 1}\n"
               "- name: C\n  type: 6\n  value: 1\n  minimum_of_it: 0\n"
               "- {name: D, type: 6, value: 1, [value]: 2}\n"),
      ElementsAre(
          at + "1:32: `value` comes twice in this entry",
          at + "2:22: `valu` is no key of an entry; did you mean `value`?",
          at + "6:3: `minimum_of_it` is no key of an entry; an entry is {name: NAME, type: 6 or 9, value: "
               "VALUE}",
          at + "7:32: `` is no key of an entry; an entry is {name: NAME, type: 6 or 9, value: VALUE}"));
}

TEST_F(ParameterFileTest, RefusesASecondDocument) {
  const std::string entry = "- {name: A, type: 6, value: 1}\n";
  EXPECT_THAT(findings(entry + "---\n- {name: B, type: 6, value: 1}\n"),
              ElementsAre(file_.string() + ":2:1: a second document begins; a parameter file is one list"));
  EXPECT_THAT(findings(entry + "---\n"), ElementsAre(HasSubstr(":2:1: a second document begins")));
  EXPECT_THAT(findings(entry + "...\n" + entry), ElementsAre(HasSubstr(": a second document begins")));
  // The marks of the beginning and the end of one document are no second one.
  EXPECT_EQ(read_parameter_file(written("%YAML 1.2\n---\n" + entry + "...\n")).size(), 1U);
}

TEST_F(ParameterFileTest, AsksAJudgeAboutEveryValue) {
  const auto judge = [](const ParameterRecord& record) {
    return record.name == "A" ? std::string("must be better") : std::string();
  };
  written("- {name: B, type: 6, value: 1}\n- {name: A, type: 9, value: .inf}\n");
  try {
    read_parameter_file(file_, judge);
    ADD_FAILURE();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.findings(), ElementsAre(file_.string() + ":2:29: A = .inf, must be better"));
  }
}

TEST_F(ParameterFileTest, RefusesWhatIsNoYamlAndWhatIsNoList) {
  EXPECT_THAT(findings("- {name: A, type: 6\n- b"), ElementsAre(HasSubstr(": is not YAML: ")));
  EXPECT_THAT(findings("name: A\n"), ElementsAre(HasSubstr(":1:1: is no list of parameters")));
  EXPECT_THAT(findings(""), ElementsAre(HasSubstr("is no list of parameters")));
}

// Fifty thousand findings with a megabyte in each would not fit into the memory.
TEST_F(ParameterFileTest, RefusesAliases) {
  std::string text = "- &a {name: A, type: 6, value: &b " + std::string(1'000'000, 'x') + "}\n";
  for (int i = 0; i < 50'000; ++i) text += "- {name: *b, type: 6, value: 1}\n";
  EXPECT_THAT(findings(text),
              ElementsAre(HasSubstr(":2:10: is an alias, `*name`; write what it stands for")));
  EXPECT_THAT(findings("- &a {name: A, type: 6, value: 1}\n- {name: B, type: 6, value: 1}\n- *a\n"),
              ElementsAre(HasSubstr(":3:3: is an alias")));
  EXPECT_THAT(findings("- {name: A, type: 6, value: *c}\n"), ElementsAre(HasSubstr(":1:29: ")));
}

}  // namespace
}  // namespace ironbird::scenarios
