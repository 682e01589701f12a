// Runs in which what the scenario says did not happen, seen from outside: they are no pass.

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "scenarios/app/test/program.hpp"

namespace ironbird::scenarios {
namespace {

const std::string kUpright =
    "duration = \"8 s\"\n[[waypoint]]\np_N = [0, 0, -5]\n"
    "[[check]]\nname = \"stays upright\"\nsignal = \"truth.roll\"\nstays_within = { low = \"-30 deg\", high "
    "= "
    "\"30 deg\" }\n";
const std::string kLate = "[[event]]\nname = \"late\"\nafter = \"lost\"\nrequest = \"land\"\n";

class ShownNothingTest : public ::testing::Test {
 protected:
  Said fly(const std::string& scenario, const std::string& options = "") {
    const std::string file = folder_.write("flight.toml", scenario);
    return run_shell(kProgram + " run " + file + options + " --no-log --out " + folder_.text());
  }
  std::string verdict_file() const {
    std::ifstream file(folder_ / "flight/verdict.json");
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  static void expect(const Said& said, int exit_code, const std::string& words) {
    EXPECT_EQ(said.exit_code, exit_code) << said.text;
    EXPECT_NE(said.text.find(words), std::string::npos) << said.text;
  }

  const TemporaryFolder folder_;
};

TEST_F(ShownNothingTest, AVehicleThatNeverLeavesTheGroundDoesNotPass) {
  expect(
      fly(kUpright, " --set pilot.take_off_at=60"), 5,
      "flight: inconclusive: the vehicle never left the ground; if it should not, say so: none_of_events = "
      "[\"lifted_off\"]");
}

TEST_F(ShownNothingTest, AVehicleThatLeavesTheGroundDoes) {
  expect(fly(kUpright), 0, "flight: pass\n");
}

TEST_F(ShownNothingTest, AVehicleThatShouldStayOnTheGroundPassesWhenItDoes) {
  const std::string stays = kUpright + "[[check]]\nname = \"stays\"\nnone_of_events = [\"lifted_off\"]\n";
  expect(fly(stays, " --set pilot.take_off_at=60"), 0,
         "flight: pass: stays: margin -: lifted_off at no time");
  expect(fly(stays), 1, "flight: fail: stays: margin -: lifted_off at 5.4");
}

TEST_F(ShownNothingTest, AWordAboutAPartOfTheRunIsNoneAboutTheFlight) {
  const std::string stays = kUpright +
                            "[[check]]\nname = \"stays\"\nuntil = \"2 s\"\nnone_of_events = "
                            "[\"lifted_off\"]\n";
  expect(fly(stays, " --set pilot.take_off_at=60"), 5, "the vehicle never left the ground");
}

TEST_F(ShownNothingTest, AnEventWhoseOccasionNeverCameLeavesNoPass) {
  const std::string words = "event \"late\" waited for \"lost\", which never happened";
  expect(fly(kUpright + kLate), 5, "flight: inconclusive: " + words);
  EXPECT_NE(verdict_file().find("event \\\"late\\\" waited for"), std::string::npos) << verdict_file();
}

TEST_F(ShownNothingTest, AnEventAtTheEndOrBehindItLeavesNoPass) {
  const auto gust_at = [](const std::string& time) {
    return "[[event]]\nname = \"gust\"\nat = \"" + time + " s\"\nfault = \"wind\"\nvector = [1, 0, 0]\n";
  };
  for (const std::string time : {"9", "8"}) {
    expect(fly(kUpright + gust_at(time)), 5,
           "event \"gust\" was due at " + time +
               " s, when the run was over; if it need not come, say so: optional = true");
    EXPECT_EQ(verdict_file().find("\"text\": \"gust\""), std::string::npos) << verdict_file();
  }
  expect(fly(kUpright + gust_at("7.99")), 0, "flight: pass\n");
  EXPECT_NE(verdict_file().find("\"text\": \"gust\""), std::string::npos) << verdict_file();
}

TEST_F(ShownNothingTest, APictureOfTheEndIsTaken) {
  const Said said = fly(kUpright + "[[snapshot]]\nname = \"end\"\nat = \"8 s\"\ncamera = \"chase\"\n");
  expect(said, 0, "flight: pass\n");
  EXPECT_EQ(said.text.find("warning"), std::string::npos) << said.text;
}

TEST_F(ShownNothingTest, AnEventThatNeedNotComeDoesNotMatter) {
  expect(fly(kUpright + kLate + "optional = true\n"), 0, "flight: pass\n");
}

TEST_F(ShownNothingTest, ARefusedRequestLeavesNoPass) {
  const std::string asks = kUpright + "[[event]]\nat = \"7 s\"\nrequest = \"resume\"\n";
  expect(fly(asks), 5, "flight: inconclusive: request at 7 s was refused: resume: it is neither");
  const std::string named = asks + "[[check]]\nname = \"refuses\"\norder_of_events = [\"refused\"]\n";
  expect(fly(named), 0, "flight: pass\n");
}

TEST_F(ShownNothingTest, ARefusalIsExpectedOfTheRequestThatIsNamed) {
  const std::string asks = kUpright + "[[event]]\nname = \"early\"\nat = \"7 s\"\nrequest = \"resume\"\n";
  const auto named = [](const std::string& key, const std::string& event) {
    return "[[check]]\nname = \"refuses\"\n" + key + " = [\"" + event + "\"]\n";
  };
  expect(fly(asks + named("order_of_events", "refused:early")), 0, "flight: pass\n");
  expect(fly(asks + named("order_of_events", "refused:take_off")), 1, "flight: fail");
  expect(fly(asks + named("none_of_events", "refused:early")), 1, "flight: fail");
  expect(fly(asks + named("order_of_events", "refused:ealry")), 2, "did you mean 'refused:early'?");
}

TEST_F(ShownNothingTest, ACrashThatNoCheckExpectsLeavesNoPass) {
  const std::string falls =
      "duration = \"12 s\"\n[[waypoint]]\np_N = [0, 0, -3]\n[[event]]\nat = \"8 s\"\nfault = "
      "\"rotor_loss\"\nindex = 0\n[[check]]\nname = \"flies\"\norder_of_events = [\"take_off\"]\n";
  const auto about_it = [](const std::string& rest) { return "[[check]]\nname = \"falls\"\n" + rest + "\n"; };
  expect(fly(falls), 5, "flight: inconclusive: the vehicle crashed at ");
  expect(fly(falls), 5, "if it should, let a check name it: order_of_events = [\"crashed\"]");
  expect(fly(falls + about_it("until = \"8 s\"\nnone_of_events = [\"crashed\"]")), 5,
         "the vehicle crashed at ");
  expect(fly(falls + about_it("none_of_events = [\"crashed\"]")), 1, "flight: fail: falls");
  expect(fly(falls + about_it("order_of_events = [\"crashed\"]")), 0, "flight: pass\n");
}

TEST_F(ShownNothingTest, TheKindOfACrashExpectsNone) {
  const std::string falls =
      "duration = \"12 s\"\n[[waypoint]]\np_N = [0, 0, -3]\n[[event]]\nat = \"8 s\"\nfault = "
      "\"rotor_loss\"\nindex = 0\n[[check]]\nname = \"flies\"\norder_of_events = [\"ground\"]\n";
  expect(fly(falls), 5, "flight: inconclusive: the vehicle crashed at ");
}

TEST_F(ShownNothingTest, SeveralRunsSayItToo) {
  const std::string other = folder_.write("other.toml", kUpright + kLate);
  const Said said = fly(kUpright, " " + other + " --jobs 2");
  expect(said, 5, "other: inconclusive\n  event \"late\" waited for \"lost\", which never happened");
}

TEST_F(ShownNothingTest, TheTakeOffOfAVehicleThatNeedsNoneIsNoMatter) {
  expect(fly(kUpright, " --set autopilot.controller.take_off_on_arming=true --set pilot.take_off_at=3"), 0,
         "flight: warning: request at 3 s was refused: take_off: the vehicle is not armed\n");
}

TEST_F(ShownNothingTest, AFailureStaysAFailure) {
  expect(fly(kUpright + kLate, " --set check[0].stays_within.high='\"-20 deg\"'"), 1,
         "flight: fail: event \"late\" waited");
}

TEST_F(ShownNothingTest, APictureNotTakenAndAnEndThatWasWaitedForAreWarnings) {
  const Said said =
      fly("end_after = \"landed\"\n" + kUpright + "[[snapshot]]\nname = \"down\"\nafter = \"landed\"\n");
  expect(said, 0,
         "flight: warning: snapshot \"down\" waited for \"landed\", which never happened: not taken\n");
  expect(said, 0, "flight: warning: the end of the run waited for \"landed\", which never happened\n");
  EXPECT_NE(verdict_file().find("snapshot \\\"down\\\" waited for"), std::string::npos) << verdict_file();
}

}  // namespace
}  // namespace ironbird::scenarios
