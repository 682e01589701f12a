#include "simulator/render/scene_renderer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <string>

namespace ironbird::simulator {
namespace {

const std::string kModels = std::string(IRONBIRD_SOURCE_DIR) + "/models/";

class SceneRendererTest : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    ::setenv("LP_NATIVE_VECTOR_WIDTH", "256", 1);
    ::setenv("LP_NUM_THREADS", "0", 0);
  }

  static RendererParams params(const std::string& vehicle, Quality quality = Quality::kFilm) {
    return {kModels + vehicle + "/scene.xml", kModels + "fields/flat.xml", 640, 360, quality};
  }

  // Away from the compass rose, whose north is red too.
  static constexpr double kNorth = 40.0;

  static RenderSample sample(double roll, double heading) {
    RenderSample s;
    s.pose.p_NB_N = Vector3(kNorth, 0.0, -6.0);
    s.pose.q_NB = Eigen::AngleAxisd(heading, Vector3::UnitZ()) * Eigen::AngleAxisd(roll, Vector3::UnitX());
    return s;
  }

  // Looks at the vehicle from a place one metre and a half away, in line with its height.
  static Camera camera(double north, double east, double up) {
    return {Vector3(kNorth + north, east, -6.0 - up), Vector3(kNorth, 0.0, -6.0), 0.8};
  }
};

struct Center {
  double u = 0.0;
  double v = 0.0;
  int count = 0;
};

// Where the pixels are that `belongs` accepts.
template <class Belongs>
Center center(const Image& image, Belongs&& belongs) {
  Center c;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (belongs(image.at(x, y))) {
        c.u += x;
        c.v += y;
        ++c.count;
      }
    }
  }
  c.u /= std::max(1, c.count);
  c.v /= std::max(1, c.count);
  return c;
}

// The front's signal colour: much red, and at least twice as much as green and blue.
bool front_color(const Pixel& p) {
  return p.r > 130 && p.r > 2 * p.g && p.r > 2 * p.b;
}

TEST_P(SceneRendererTest, MarksTheFront) {
  SceneRenderer renderer(params(GetParam()));
  // From above, north up: a vehicle heading north shows its colours in the upper half, heading east in the
  // right.
  const Camera above = camera(0.0, 0.0, 1.5);
  const Center north = center(renderer.render(sample(0.0, 0.0), above, {}), front_color);
  const Center east = center(renderer.render(sample(0.0, std::numbers::pi / 2), above, {}), front_color);
  ASSERT_GT(north.count, 100);
  EXPECT_LT(north.v, 180.0 - 15.0);
  EXPECT_NEAR(north.u, 320.0, 10.0);
  EXPECT_GT(east.u, 320.0 + 15.0);
  EXPECT_NEAR(east.v, 180.0, 10.0);
}

TEST_P(SceneRendererTest, LowersTheRightSideInAPositiveRoll) {
  SceneRenderer renderer(params(GetParam()));
  // From behind, at a place slightly above; the front arms are the coloured ones and visible on both sides.
  const Image image = renderer.render(sample(0.5, 0.0), camera(-1.5, 0.0, 0.5), {});
  double left = 0.0, right = 0.0;
  int left_count = 0, right_count = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (front_color(image.at(x, y))) {
        (x < 310 ? left : right) += y;
        ++(x < 310 ? left_count : right_count);
      }
    }
  }
  ASSERT_GT(left_count, 20);
  ASSERT_GT(right_count, 20);
  EXPECT_GT(right / right_count, left / left_count + 20.0);
}

INSTANTIATE_TEST_SUITE_P(Vehicles, SceneRendererTest, ::testing::Values("x650", "rosflight_multirotor"));

// The landing pad fills the picture, with its edge in it; the vehicle is elsewhere. At edges 0.5 % of the
// pixels are apart; with every second column left out 5 % are.
TEST_F(SceneRendererTest, PaintsThePadOfAPreviewLikeThatOfAFilm) {
  for (const int width : {640, 641}) {
    RendererParams of_film = params("x650"), of_preview = params("x650", Quality::kPreview);
    of_film.width = of_preview.width = width;
    SceneRenderer film(of_film), preview(of_preview);
    for (const Vector3& eye : {Vector3(-6.0, 0.3, -3.0), Vector3(-2.0, 2.0, -4.0)}) {
      const Camera over_the_pad{eye, Vector3::Zero(), 0.8};
      const Image one = film.render(sample(0.0, 0.0), over_the_pad, {});
      const Image other = preview.render(sample(0.0, 0.0), over_the_pad, {});
      int apart = 0;
      for (int y = 0; y < one.height(); ++y) {
        for (int x = 0; x < one.width(); ++x)
          apart += std::abs(one.at(x, y).g - other.at(x, y).g) > 20 ? 1 : 0;
      }
      EXPECT_LT(apart, width * one.height() / 50) << "edges only, width " << width;
    }
  }
}

TEST_F(SceneRendererTest, DrawsAPointWhereTheProjectionSaysItIs) {
  SceneRenderer renderer(params("x650"));
  RenderSample far_away = sample(0.0, 0.0);
  far_away.pose.p_NB_N = Vector3(-500.0, 0.0, -6.0);
  const Camera view{{-10.0, 2.0, -5.0}, {5.0, 0.0, -3.0}, 0.8};
  Overlays overlays;
  overlays.waypoints.push_back({Vector3(6.0, 3.0, -4.0), "", false});
  const Image with = renderer.render(far_away, view, overlays);
  const auto expected = Projection(view, 640, 360).project(Vector3(6.0, 3.0, -4.0));
  const Center plate = center(with, [](const Pixel& p) { return p.b > 110 && p.r < 60 && p.g < 110; });
  ASSERT_GT(plate.count, 50);
  // The mean of whole pixels of a disc of known middle; its middle pixel has coordinate + 0.5.
  EXPECT_NEAR(plate.u + 0.5, expected->u, 0.5);
  EXPECT_NEAR(plate.v + 0.5, expected->v, 0.5);
}

TEST_F(SceneRendererTest, DrawsTheVehicleWhereTheProjectionSaysItIs) {
  SceneRenderer renderer(params("x650"));
  const Camera view{{0.0, 0.0, -30.0}, {0.0, 0.0, 0.0}, 0.3};
  RenderSample s = sample(0.0, 0.0);
  const Image without = [&] {
    RenderSample away = s;
    away.pose.p_NB_N = Vector3(400.0, 0.0, -6.0);
    return renderer.render(away, view, {});
  }();
  s.pose.p_NB_N = Vector3(1.5, 2.5, -12.0);
  const Image with = renderer.render(s, view, {});
  const auto expected = Projection(view, 640, 360).project(s.pose.p_NB_N);
  double u = 0.0, v = 0.0;
  int count = 0;
  for (int y = 0; y < 360; ++y) {
    for (int x = 0; x < 640; ++x) {
      // Within reach of the vehicle only: its shadow falls elsewhere.
      if (!(with.at(x, y) == without.at(x, y)) && std::hypot(x - expected->u, y - expected->v) < 40.0) {
        u += x + 0.5;
        v += y + 0.5;
        ++count;
      }
    }
  }
  ASSERT_GT(count, 100);
  constexpr double kLopsided = 3.0;  // px, the airframe is not quite symmetric and the antenna leans
  EXPECT_NEAR(u / count, expected->u, kLopsided);
  EXPECT_NEAR(v / count, expected->v, kLopsided);
}

TEST_F(SceneRendererTest, RingsAVehicleThatIsFarAwayAndNoOther) {
  SceneRenderer renderer(params("x650"));
  const auto orange = [](const Pixel& p) { return p.r > 240 && p.g > 110 && p.g < 160 && p.b < 60; };
  Overlays overlays;
  overlays.waypoints.push_back({Vector3(kNorth, 0.0, -6.0), "", false});  // a plate in front of the vehicle
  const RenderSample s = sample(0.0, 0.0);
  const Camera far_view{{kNorth - 40.0, 3.0, -9.0}, {kNorth, 1.0, -6.0}, 0.8};
  const auto expected = Projection(far_view, 640, 360).project(s.pose.p_NB_N);
  const Center ring = center(renderer.render(s, far_view, overlays), orange);
  ASSERT_GT(ring.count, 30);
  EXPECT_NEAR(ring.u + 0.5, expected->u, 0.5);
  EXPECT_NEAR(ring.v + 0.5, expected->v, 0.5);
  EXPECT_EQ(center(renderer.render(s, far_view, {}), orange).count, 0) << "nothing but the scene is wanted";
  const Camera near_view{{kNorth - 6.0, 3.0, -9.0}, {kNorth, 1.0, -6.0}, 0.8};
  EXPECT_LT(center(renderer.render(s, near_view, overlays), orange).count, 30);
}

TEST_F(SceneRendererTest, ShowsASmallVehicleThroughAPlateAndOtherPlatesInFull) {
  RendererParams large = params("x650");
  large.width = 1280;
  large.height = 720;
  SceneRenderer renderer(large);
  const RenderSample s = sample(0.0, 0.0);
  const Camera view{{kNorth - 40.0, 3.0, -9.0}, {kNorth, 1.0, -6.0}, 0.8};
  const auto dark = [](const Pixel& p) { return p.r < 75 && p.g < 85 && p.b < 75; };
  const int alone = center(renderer.render(s, view, {}), dark).count;
  ASSERT_GT(alone, 10);
  const auto blue = [](const Pixel& p) { return p.b > 110 && p.r < 60 && p.g < 110; };
  // In front of the vehicle, as the camera sees it, and well beside it.
  const Vector3 in_front = view.p_N + 0.8 * (s.pose.p_NB_N - view.p_N);
  Overlays overlays;
  overlays.waypoints.push_back({in_front, "", false});
  const Image covered = renderer.render(s, view, overlays);
  EXPECT_GT(center(covered, dark).count, alone / 2);
  EXPECT_EQ(center(covered, blue).count, 0);
  overlays.waypoints.front().p_N += Vector3(0.0, 5.0, 0.0);
  EXPECT_GT(center(renderer.render(s, view, overlays), blue).count, 50);
}

TEST_F(SceneRendererTest, DoesNotRememberWhatItDrewBefore) {
  SceneRenderer renderer(params("x650"));
  Overlays overlays;
  overlays.estimate = Pose{Vector3(kNorth + 0.3, 0.2, -6.1), Quaternion::Identity()};
  overlays.title = "title";
  const Image first = renderer.render(sample(0.2, 1.0), camera(-2.0, 0.5, 0.7), overlays);
  RenderSample spinning = sample(-0.4, 3.0);
  spinning.rotor_speed.fill(500.0);
  renderer.render(spinning, camera(1.0, 2.0, -0.5), {});
  EXPECT_EQ(first, renderer.render(sample(0.2, 1.0), camera(-2.0, 0.5, 0.7), overlays));
}

TEST_F(SceneRendererTest, BlursFastRotorsOnly) {
  SceneRenderer renderer(params("x650"));
  RenderSample slow = sample(0.0, 0.0);
  slow.rotor_speed.fill(39.0);
  RenderSample fast = slow;
  fast.rotor_speed.fill(400.0);
  const Camera view = camera(0.0, 0.0, 1.5);
  EXPECT_EQ(renderer.render(slow, view, {}), renderer.render(sample(0.0, 0.0), view, {}));
  EXPECT_FALSE(renderer.render(fast, view, {}) == renderer.render(slow, view, {}));
}

TEST_F(SceneRendererTest, DrawsEveryField) {
  for (const char* field : {"flat", "gates", "yard"}) {
    RendererParams p = params("x650");
    p.field_scene = kModels + "fields/" + field + ".xml";
    SceneRenderer renderer(p);
    const Image image = renderer.render(sample(0.0, 0.0), Camera{{-20, -10, -9}, {6, 2, -1}, 0.9}, {});
    EXPECT_EQ(image.pixels().size(), 640U * 360U) << field;
    EXPECT_FALSE(image.at(320, 300) == image.at(320, 5)) << field << ": ground and sky must differ";
  }
}

TEST_F(SceneRendererTest, NamesTheSceneThatCannotBeRead) {
  RendererParams p = params("x650");
  p.vehicle_scene = "/no/such/scene.xml";
  try {
    SceneRenderer renderer(p);
    FAIL() << "a missing scene was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("/no/such/scene.xml"), std::string::npos);
  }
  p = params("x650");
  p.width = 5;
  EXPECT_THROW(SceneRenderer{p}, std::invalid_argument);
}

}  // namespace
}  // namespace ironbird::simulator
