#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "autopilot/types/linear_algebra.hpp"
#include "autopilot/types/time.hpp"

// Described structs that have one member of each kind.

namespace ironbird::scenarios::samples {

using autopilot::Matrix3;
using autopilot::Quaternion;
using autopilot::Time;
using autopilot::Vector2;
using autopilot::Vector3;

enum class Colour : std::uint8_t { kRed = 1, kDeepBlue = 7 };
constexpr std::array<std::pair<Colour, std::string_view>, 2> enumerators(Colour) {
  return {{{Colour::kRed, "red"}, {Colour::kDeepBlue, "deep blue"}}};
}

struct Inner {
  double depth = 0.0;
  bool wet = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("depth", self.depth, "m", "how deep", 0.0, 11000.0);
    visit("wet", self.wet, "1", "touched water");
  }
};

struct Nothing {
  template <class Self, class Visit>
  static void describe(Self&, Visit&&) {}
};

using Choice = std::variant<Nothing, Inner>;

struct Everything {
  bool flag = false;
  std::int8_t tiny = 0;
  std::uint16_t small = 0;
  int whole = 0;
  std::uint64_t huge = 0;
  float single = 0.0f;
  double number = 0.0;
  Colour colour = Colour::kRed;
  Time stamp{};
  Vector3 p_NB_N = Vector3::Zero();
  Vector2 plane = Vector2::Zero();
  Quaternion q_NB = Quaternion::Identity();
  Matrix3 inertia = Matrix3::Zero();
  std::array<float, 3> fixed{};
  std::array<Inner, 2> pair{};
  std::array<char, 8> label{};
  std::string note;
  std::vector<double> list;
  std::vector<Inner> inners;
  std::optional<double> maybe;
  std::optional<Inner> perhaps;
  Choice choice;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("flag", self.flag, "1", "a bool");
    visit("tiny", self.tiny, "1", "an int8");
    visit("small", self.small, "1", "a uint16");
    visit("whole", self.whole, "1", "an int", 0.0);
    visit("huge", self.huge, "1", "a uint64");
    visit("single", self.single, "V", "a float");
    visit("number", self.number, "m/s", "a double", -2.5, 20.0);
    visit("colour", self.colour, "1", "an enumeration");
    visit("stamp", self.stamp, "ns", "a time");
    visit("p_NB_N", self.p_NB_N, "m", "a vector");
    visit("plane", self.plane, "m", "a plane vector");
    visit("q_NB", self.q_NB, "1", "a quaternion");
    visit("inertia", self.inertia, "kg*m^2", "a matrix");
    visit("fixed", self.fixed, "Pa", "an array");
    visit("pair", self.pair, "", "an array of structs");
    visit("label", self.label, "", "a bounded text");
    visit("note", self.note, "", "a text");
    visit("list", self.list, "s", "a sequence");
    visit("inners", self.inners, "", "a sequence of structs");
    visit("maybe", self.maybe, "K", "an optional number");
    visit("perhaps", self.perhaps, "", "an optional struct");
    visit("choice", self.choice, "", "a variant");
  }
};

/// One value of every member, chosen so that no two of them have the same bytes.
inline Everything filled() {
  Everything all;
  all.flag = true;
  all.tiny = -2;
  all.small = 0x1234;
  all.whole = -5;
  all.huge = 0x0102030405060708u;
  all.single = 1.5f;
  all.number = -2.0;
  all.colour = Colour::kDeepBlue;
  all.stamp = Time(-1);
  all.p_NB_N = {1.0, 2.0, 3.0};
  all.plane = {4.0, 5.0};
  all.q_NB = Quaternion(0.5, -0.5, 0.25, 0.125);
  all.inertia << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  all.fixed = {10.0f, 11.0f, 12.0f};
  all.pair = {Inner{1.0, true}, Inner{2.0, false}};
  all.label = {'a', 'b', 'c'};
  all.note = "hi";
  all.list = {6.0, 7.0};
  all.inners = {Inner{8.0, true}};
  all.maybe = 9.0;
  all.choice = Inner{12.0, true};
  return all;
}

}  // namespace ironbird::scenarios::samples
