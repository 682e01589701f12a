#include "scenarios/video/film.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>

#include "autopilot/signals.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/record/recorder.hpp"
#include "scenarios/requirements/timeline.hpp"
#include "scenarios/video/camera_work.hpp"
#include "scenarios/video/film_script.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {
namespace {

using simulator::Pose;
using simulator::Quaternion;
using simulator::Vector3;
namespace fs = std::filesystem;

class FilmTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override {
    ::unsetenv("LP_NUM_THREADS");
    fs::remove_all(folder_);
  }

  const fs::path folder_ =
      fs::path(::testing::TempDir()) /
      ("ironbird_film_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
};

std::string bytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

FilmScript circle(int frames, int width, int height) {
  const std::string models = std::string(IRONBIRD_SOURCE_DIR) + "/models/";
  FilmScript script;
  script.renderer = {models + "x650/scene.xml", models + "fields/gates.xml", width, height,
                     simulator::Quality::kFilm};
  script.title = "circle";
  script.planned_path_N = {Vector3(0, 0, -3), Vector3(8, 0, -3)};
  script.waypoints = {{Vector3(8, 0, -3), "1", false}};
  std::vector<Pose> poses;
  for (int i = 0; i < frames; ++i) {
    const double angle = 0.05 * i;
    FilmFrame frame;
    frame.time = i / 30.0;
    frame.truth.pose = {Vector3(3 * std::cos(angle), 3 * std::sin(angle), -3),
                        Quaternion(Eigen::AngleAxisd(angle, Vector3::UnitZ()))};
    frame.truth.rotor_speed.fill(450.0);
    frame.truth.rotor_angle.fill(angle);
    frame.estimate = Pose{frame.truth.pose.p_NB_N + Vector3(0.3, 0, 0), frame.truth.pose.q_NB};
    frame.captions = {"caption"};
    poses.push_back(frame.truth.pose);
    script.frames.push_back(frame);
  }
  const auto cameras = chase_cameras(poses, 1.0 / 30.0);
  for (std::size_t i = 0; i < script.frames.size(); ++i) {
    script.frames[i].camera = cameras[i];
  }
  return script;
}

std::map<std::string, std::string> probe(const fs::path& file) {
  const std::string command =
      "ffprobe -v error -count_frames -show_entries "
      "stream=codec_name,width,height,r_frame_rate,nb_read_frames,pix_fmt -of default=nw=1 '" +
      file.string() + "'";
  std::map<std::string, std::string> found;
  FILE* pipe = ::popen(command.c_str(), "r");
  std::array<char, 200> line{};
  while (std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr) {
    const std::string text(line.data());
    const std::size_t equals = text.find('=');
    found[text.substr(0, equals)] = text.substr(equals + 1, text.find('\n') - equals - 1);
  }
  ::pclose(pipe);
  return found;
}

TEST_F(FilmTest, OfASecondHasThirtyFramesThatDecode) {
  ASSERT_TRUE(film_to_file(circle(30, 1280, 720), folder_ / "a.mp4"));
  const auto found = probe(folder_ / "a.mp4");
  EXPECT_EQ(found.at("codec_name"), "h264");
  EXPECT_EQ(found.at("width"), "1280");
  EXPECT_EQ(found.at("height"), "720");
  EXPECT_EQ(found.at("r_frame_rate"), "30/1");
  EXPECT_EQ(found.at("nb_read_frames"), "30");
  EXPECT_EQ(found.at("pix_fmt"), "yuv420p");
}

TEST_F(FilmTest, IsTheSameForAnyNumberOfWorkersAndThreads) {
  const FilmScript script = circle(7, 320, 180);
  ASSERT_TRUE(film_to_file(script, folder_ / "one.y4m", 1));
  const std::string expected = bytes(folder_ / "one.y4m");
  const std::string header = "YUV4MPEG2 W320 H180 F30:1 Ip A1:1 C420jpeg XCOLORRANGE=LIMITED\n";
  EXPECT_EQ(expected.size(), header.size() + 7U * (6U + 320U * 180U * 3U / 2U))
      << "header, then seven frames";
  for (const char* threads : {"0", "1", "2"}) {
    ::setenv("LP_NUM_THREADS", threads, 1);
    for (const int workers : {1, 2, 3}) {
      ASSERT_TRUE(film_to_file(script, folder_ / "other.y4m", workers));
      EXPECT_TRUE(bytes(folder_ / "other.y4m") == expected)
          << workers << " workers, " << threads << " threads";
    }
  }
}

TEST_F(FilmTest, StopsWhenAskedAndLeavesNothing) {
  EXPECT_FALSE(film_to_file(circle(20, 320, 180), folder_ / "a.mp4", 2,
                            [](std::size_t done, std::size_t all) { return all == 20 && done < 3; }));
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(FilmTest, SaysWhatAWorkerSaid) {
  FilmScript script = circle(3, 320, 180);
  script.renderer.field_scene = "/no/such/field.xml";
  try {
    film_to_file(script, folder_ / "a.mp4");
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/no/such/field.xml"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(FilmTest, RefusesOddSizesAndUnknownKinds) {
  EXPECT_THROW(film_to_file(circle(1, 321, 180), folder_ / "a.mp4"), std::invalid_argument);
  EXPECT_THROW(film_to_file(circle(1, 320, 180), folder_ / "a.gif"), std::invalid_argument);
  EXPECT_THROW(film_to_file(circle(0, 320, 180), folder_ / "a.mp4"), std::invalid_argument);
}

TEST_F(FilmTest, TrailEndsAtTheVehicleAndKeepsItsCorners) {
  const FilmScript script = circle(60, 320, 180);
  const auto now = overlays_at(script, 50);
  const auto next = overlays_at(script, 51);
  EXPECT_EQ(now.trail_N.back(), script.frames[50].truth.pose.p_NB_N);
  EXPECT_EQ(now.trail_N[5], next.trail_N[5]);
}

TEST_F(FilmTest, IsMadeFromALog) {
  simulator::Truth truth;
  autopilot::Signals signals;
  {
    Recorder recorder(folder_ / "flight.mcap");
    recorder.metadata(
        "run", {{"title", "from a log"}, {"vehicle", "models/x650"}, {"field", "models/fields/yard.xml"}});
    recorder.add("/truth/state", truth, std::chrono::milliseconds(10));
    recorder.add("/autopilot/estimate", signals.estimate, std::chrono::milliseconds(10));
    signals.route.waypoints.resize(2);
    signals.route.waypoints[0].p_N = Vector3(1, 2, -3);
    signals.route.waypoints[1].p_N = Vector3(4, 5, -6);
    recorder.write_once("/autopilot/route", signals.route, autopilot::Time{0});
    for (int i = 0; i <= 200; ++i) {
      const autopilot::Time now = std::chrono::milliseconds(10 * i);
      if (i == 20) recorder.write_once("/bench/event", RunEvent{0.2, "position_reset", "4.053 m"}, now);
      if (i == 10) signals.estimate.health = autopilot::Health::kGood;
      if (i == 50) recorder.write_once("/bench/event", RunEvent{0.5, "request", "go_on"}, now);
      if (i == 60) recorder.write_once("/bench/event", RunEvent{0.6, "snapshot", "picture here"}, now);
      if (i == 190) {  // what comes last, however long, is not what the flight was about
        signals.route.waypoints.resize(3);
        signals.route.waypoints[0].p_N = Vector3(7, 8, -9);
        recorder.write_once("/autopilot/route", signals.route, now);
      }
      truth.p_NB_N = Vector3(0.02 * i, 0, -2);
      truth.rotor_speed[0] = 300.0;
      signals.estimate.p_NB_N = truth.p_NB_N + Vector3(0, 0.25, 0);
      recorder.observe(now);
    }
    recorder.close();
  }
  FilmOptions options;
  options.vehicle_scene = IRONBIRD_SOURCE_DIR "/models/x650/scene.xml";
  options.field = IRONBIRD_SOURCE_DIR "/models/fields/yard.xml";
  options.cameras = {{"tower", {{9, 9, -9}, {0, 0, 0}, 0.7}}};
  options.cuts = {{1.0, "tower"}};
  const Log log = Log::read(folder_ / "flight.mcap");
  const FilmScript script = film_script(log, options);
  EXPECT_EQ(script.title, "from a log");
  EXPECT_TRUE(script.renderer.field_scene.ends_with("models/fields/yard.xml"));
  ASSERT_EQ(script.frames.size(), 61U) << "two seconds, both ends";
  ASSERT_EQ(script.waypoints.size(), 2U);
  EXPECT_EQ(script.waypoints[1].p_N, Vector3(4, 5, -6));
  constexpr double kRoundOff = 1e-9;
  const FilmFrame& middle = script.frames[31];
  EXPECT_NEAR(middle.truth.pose.p_NB_N.x(), 2.0 * middle.time, kRoundOff) << "interpolated between samples";
  EXPECT_EQ(middle.captions.back(), "> go_on") << "that a picture is taken is not shown in it";
  EXPECT_EQ(script.frames[9].captions.back(), "> position_reset 4.053 m");
  EXPECT_FALSE(script.frames[1].estimate) << "there is none before the estimator has begun";
  ASSERT_TRUE(middle.estimate);
  EXPECT_NEAR(middle.estimate->p_NB_N.y(), 0.25, kRoundOff);
  EXPECT_EQ(middle.camera.p_N, Vector3(9, 9, -9));
  EXPECT_NE(script.frames[29].camera.p_N, Vector3(9, 9, -9));
  EXPECT_EQ(frame_at(script, 1.01), 30U);
  options.cuts = {{1.0, "cellar"}};
  EXPECT_THROW(film_script(log, options), std::invalid_argument);
}

TEST_F(FilmTest, SaysHowFarTheVehicleIsOffOnlyWhileItFollows) {
  {
    simulator::Truth truth;
    autopilot::Signals signals;
    signals.flight.phase = autopilot::FlightPhase::kOffboard;
    signals.trajectory.valid = true;
    Recorder recorder(folder_ / "flight.mcap");
    recorder.add("/truth/state", truth, std::chrono::milliseconds(10));
    recorder.add("/autopilot/flight", signals.flight, std::chrono::milliseconds(10));
    recorder.add("/autopilot/trajectory", signals.trajectory, std::chrono::milliseconds(10));
    for (int i = 0; i <= 100; ++i) {
      signals.flight.operator_setpoint = i >= 50;
      recorder.observe(std::chrono::milliseconds(10 * i));
    }
    recorder.close();
  }
  FilmOptions options;
  options.vehicle_scene = IRONBIRD_SOURCE_DIR "/models/x650/scene.xml";
  options.field = IRONBIRD_SOURCE_DIR "/models/fields/yard.xml";
  const FilmScript script = film_script(Log::read(folder_ / "flight.mcap"), options);
  EXPECT_EQ(script.frames[12].captions.back(), "tracking off 0.00 m");
  EXPECT_THAT(script.frames[18].captions.back(), ::testing::StartsWith("height"))
      << "an operator's setpoint flies";
}

TEST_F(FilmTest, IsNotMadeOfPosesThatLastForCenturies) {
  const auto log_until = [&](std::chrono::nanoseconds last) {
    simulator::Truth truth;
    Recorder recorder(folder_ / "flight.mcap");
    recorder.add("/truth/state", truth, std::chrono::milliseconds(10));
    recorder.observe(autopilot::Time{0});
    recorder.observe(last);
    recorder.close();
    return Log::read(folder_ / "flight.mcap");
  };
  FilmOptions options;
  options.vehicle_scene = IRONBIRD_SOURCE_DIR "/models/x650/scene.xml";
  options.field = IRONBIRD_SOURCE_DIR "/models/fields/yard.xml";
  options.frame_rate = 1;
  EXPECT_EQ(film_script(log_until(std::chrono::hours(24)), options).frames.size(), 86401U);
  try {
    film_script(log_until(std::chrono::hours(24 * 365 * 200)), options);
    FAIL() << "a film of two hundred years";
  } catch (const UserError& error) {
    EXPECT_STREQ(
        error.what(),
        "film: /truth/state lasts from 0.0 s to 6307200000.0 s, a film at most 86400 s: cut the log, or "
        "take out the time stamp that is wrong");
  }
  options.end = 2.0;
  EXPECT_EQ(film_script(log_until(std::chrono::hours(24 * 365 * 200)), options).frames.size(), 3U);
}

}  // namespace
}  // namespace ironbird::scenarios
