// The film of a replay, by the program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "scenarios/app/test/program.hpp"
#include "scenarios/replay/test/flight_by_hand.hpp"
#include "scenarios/video/replay_film.hpp"

namespace ironbird::scenarios {
namespace {

using test::FlightByHand;
using testing::HasSubstr;

std::string bytes_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

Said replay(const std::filesystem::path& log, const std::filesystem::path& out, const std::string& more) {
  return run_shell(kProgram + " replay '" + log.string() + "' --no-report --out '" + out.string() + "' " +
                   more);
}

TEST(ReplayFilmTest, LastsAsLongAsThereIsAnEstimateAndLeavesTheLogAsItIs) {
  const TemporaryFolder folder;
  const auto log = FlightByHand{.seconds = 3.0}.write(folder / "flown.ulg");
  const Said said = replay(log, folder / "filmed", "--video");
  EXPECT_EQ(said.exit_code, 5) << "a third of it is over before there is an estimate: " << said.text;
  const std::filesystem::path film = folder / "filmed/flown/video.mp4";
  ASSERT_TRUE(std::filesystem::exists(film)) << said.text;
  const Said probed = run_shell(
      "ffprobe -v error -count_frames -select_streams v -show_entries "
      "stream=codec_name,width,height,r_frame_rate,nb_read_frames -of csv=p=0 '" +
      film.string() + "'");
  EXPECT_THAT(probed.text, HasSubstr("h264,1280,720,30/1,"));
  const int frames = std::stoi(probed.text.substr(probed.text.rfind(',') + 1));
  EXPECT_NEAR(frames / 30.0, 2.0, 0.2) << "the estimator begins after a second";
  replay(log, folder / "unfilmed", "");
  EXPECT_EQ(bytes_of(folder / "filmed/flown/flight.mcap"), bytes_of(folder / "unfilmed/flown/flight.mcap"));
}

FilmScript script_of(const std::filesystem::path& log) {
  FilmOptions options;
  options.vehicle_scene = IRONBIRD_SOURCE_DIR "/models/x650/scene.xml";
  options.field = IRONBIRD_SOURCE_DIR "/models/fields/flat.xml";
  const Log read = Log::read(log);
  EXPECT_TRUE(is_replayed(read));
  return replay_film_script(read, options);
}

TEST(ReplayFilmTest, ShowsBothEstimatesFixesAndThePhaseOfTheRecorder) {
  const TemporaryFolder folder;
  replay(FlightByHand{}.write(folder / "flown.ulg"), folder / "out", "");
  const FilmScript script = script_of(folder / "out/flown/flight.mcap");
  EXPECT_THAT(script.title, HasSubstr("PX4_FMU_V6C"));
  const FilmFrame& standing = script.frames.at(frame_at(script, 2.0));
  const FilmFrame& flying = script.frames.at(frame_at(script, 4.5));
  EXPECT_THAT(standing.captions.front(), HasSubstr("on the ground"));
  EXPECT_THAT(flying.captions.front(), HasSubstr("mission"));
  EXPECT_THAT(script.frames.at(frame_at(script, 6.0)).captions.front(), HasSubstr("return"));
  ASSERT_TRUE(flying.estimate);
  EXPECT_NEAR((flying.estimate->p_NB_N - flying.truth.pose.p_NB_N).norm(), 0.0, 0.1)
      << "the recorded one counts half a metre higher: a constant";
  EXPECT_THAT(flying.captions.at(2), HasSubstr("PX4 (ghost) off 0.0"));
  EXPECT_NEAR(standing.truth.pose.p_NB_N.z(), 0.0, 0.1) << "it stands on the ground";
  const simulator::Overlays overlays = overlays_at(script, frame_at(script, 4.5));
  EXPECT_NEAR(static_cast<double>(overlays.marks_N.size()), 17.0, 2.0) << "five a second";
  EXPECT_EQ(overlays.ghost_trail_N.size(), overlays.trail_N.size());
  EXPECT_EQ(overlays.ghost_trail_N.back(), flying.estimate->p_NB_N);
}

TEST(ReplayFilmTest, IsMadeOfEachOfTwoThatAreCompared) {
  const TemporaryFolder folder;
  const auto log = FlightByHand{.seconds = 1.5}.write(folder / "flown.ulg");
  const Said said = replay(log, folder / "out", "--compare ekf error_state --video");
  for (const char* kind : {"ekf", "error_state"})
    EXPECT_TRUE(std::filesystem::exists(folder / "out/flown" / kind / "video.mp4")) << said.text;
}

TEST(ReplayFilmTest, IsNotMadeWithoutAnEstimate) {
  const TemporaryFolder folder;
  const Said said =
      replay(FlightByHand{.gnss = false}.write(folder / "flown.ulg"), folder / "out", "--video");
  EXPECT_EQ(said.exit_code, 1);
  EXPECT_THAT(said.text, HasSubstr("no film: there was no estimate to show"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out/flown/video.mp4"));
}

}  // namespace
}  // namespace ironbird::scenarios
