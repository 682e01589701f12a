#include "scenarios/record/ros2_schema.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "autopilot/signals.hpp"
#include "scenarios/record/ros2_message.hpp"
#include "scenarios/record/test/samples.hpp"
#include "simulator/types/readings.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {
namespace {

using ::testing::HasSubstr;

const std::string kSeparator = std::string(80, '=') + "\n";

TEST(Ros2SchemaTest, WritesEveryKindOfMember) {
  const Ros2Schema schema = ros2_schema<samples::Everything>();
  EXPECT_EQ(schema.name, "ironbird_msgs/msg/Everything");
  EXPECT_EQ(schema.text,
            "bool flag  # [1] a bool\n"
            "int8 tiny  # [1] an int8\n"
            "uint16 small  # [1] a uint16\n"
            "int32 whole  # [1] an int, >= 0\n"
            "uint64 huge  # [1] a uint64\n"
            "float32 single  # [V] a float\n"
            "float64 number  # [m/s] a double, >= -2.5, <= 20\n"
            "uint8 COLOUR_RED=1\n"
            "uint8 COLOUR_DEEP_BLUE=7\n"
            "uint8 colour  # [1] an enumeration\n"
            "builtin_interfaces/Time stamp  # [ns] a time\n"
            "geometry_msgs/Vector3 p_nb_n  # p_NB_N: [m] a vector\n"
            "ironbird_msgs/Vector2 plane  # [m] a plane vector\n"
            "geometry_msgs/Quaternion q_nb  # q_NB: [1] a quaternion\n"
            "float64[9] inertia  # [kg*m^2] a matrix\n"
            "float32[3] fixed  # [Pa] an array\n"
            "ironbird_msgs/Inner[2] pair  # an array of structs\n"
            "string label  # a bounded text\n"
            "string note  # a text\n"
            "float64[] list  # [s] a sequence\n"
            "ironbird_msgs/Inner[] inners  # a sequence of structs\n"
            "float64[<=1] maybe  # [K] an optional number\n"
            "ironbird_msgs/Inner[<=1] perhaps  # an optional struct\n"
            "ironbird_msgs/Choice choice  # a variant\n" +
                kSeparator + "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n" + kSeparator +
                "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n" + kSeparator +
                "MSG: ironbird_msgs/Vector2\nfloat64 x\nfloat64 y\n" + kSeparator +
                "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n" + kSeparator +
                "MSG: ironbird_msgs/Inner\n"
                "float64 depth  # [m] how deep, >= 0, <= 11000\n"
                "bool wet  # [1] touched water\n" +
                kSeparator +
                "MSG: ironbird_msgs/Choice\n"
                "uint8 KIND_NOTHING=0\n"
                "uint8 KIND_INNER=1\n"
                "uint8 kind  # which of the alternatives it is\n"
                "ironbird_msgs/Inner[<=1] inner\n");
}

TEST(Ros2SchemaTest, GivesAnEmptyStructAMember) {
  const Ros2Schema schema = ros2_schema<samples::Nothing>();
  EXPECT_EQ(schema.name, "ironbird_msgs/msg/Nothing");
  EXPECT_EQ(schema.text, "uint8 structure_needs_at_least_one_member\n");
}

TEST(Ros2SchemaTest, NamesAVariantAfterItsTopic) {
  EXPECT_EQ(ros2_schema<samples::Choice>("my_choice").name, "ironbird_msgs/msg/MyChoice");
}

namespace other {
struct Inner {
  int number = 0;
  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("number", self.number, "1", "another struct of this name");
  }
};
}  // namespace other

struct Clash {
  samples::Inner one;
  other::Inner two;
  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("one", self.one, "", "");
    visit("two", self.two, "", "");
  }
};

TEST(Ros2SchemaTest, RefusesTwoTypesOfOneName) {
  try {
    ros2_schema<Clash>();
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("ironbird_msgs/Inner would stand for both"));
  }
}

struct Capitals {
  double m_b = 0.0;
  double m_B = 0.0;
  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("m_b", self.m_b, "1", "");
    visit("m_B", self.m_B, "1", "");
  }
};

TEST(Ros2SchemaTest, RefusesFieldsThatDifferInCapitalsOnly) {
  EXPECT_THROW(ros2_schema<Capitals>(), std::invalid_argument);
}

template <class T>
class Ros2SchemaOfTest : public ::testing::Test {};
using Recorded =
    ::testing::Types<autopilot::Signals, simulator::Truth, simulator::Readings, samples::Everything>;
TYPED_TEST_SUITE(Ros2SchemaOfTest, Recorded);

TYPED_TEST(Ros2SchemaOfTest, IsUnderstoodByOurOwnReader) {
  const Ros2Schema schema = ros2_schema<TypeParam>();
  Allowance allowance(schema.text.size());
  const std::vector<Ros2MessageType> types = parse_ros2_schema(schema.name, schema.text, allowance);
  std::vector<std::string> names;
  TypeParam sample{};
  TypeParam::describe(sample, [&](const char* name, auto&&...) { names.emplace_back(name); });
  std::vector<std::string> read;
  for (const Ros2Field& field : types.front().fields) read.push_back(field.name);
  EXPECT_EQ(read, names);
}

struct NameCase {
  const char* type;
  const char* snake;
};
class SnakeCaseTest : public ::testing::TestWithParam<NameCase> {};
TEST_P(SnakeCaseTest, SeparatesWords) {
  EXPECT_EQ(snake_case(GetParam().type), GetParam().snake);
}
INSTANTIATE_TEST_SUITE_P(Names, SnakeCaseTest,
                         ::testing::Values(NameCase{"RateThrottle", "rate_throttle"},
                                           NameCase{"Land", "land"}, NameCase{"FCUCommand", "fcu_command"},
                                           NameCase{"Fix2D", "fix2_d"}, NameCase{"", ""}));

TEST(TypeNameTest, DropsNamespacesAndTemplateArguments) {
  EXPECT_EQ(full_type_name<autopilot::Signals>(), "ironbird::autopilot::Signals");
  EXPECT_EQ(short_type_name<autopilot::Signals>(), "Signals");
  EXPECT_EQ(short_type_name<std::vector<autopilot::Signals>>(), "vector");
  EXPECT_EQ(short_type_name<int>(), "int");
}

}  // namespace
}  // namespace ironbird::scenarios
