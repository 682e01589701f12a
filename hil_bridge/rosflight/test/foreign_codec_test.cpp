#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "hil_bridge/rosflight/dialect.hpp"
#include "hil_bridge/rosflight/test/frame_text.hpp"

// Does a MAVLink library that we did not write read our frames as we meant them, and do we read its?

namespace ironbird::hil_bridge::rosflight {
namespace {

using nlohmann::json;

constexpr int kEach = 300;
/// The messages that the dialect shares with MAVLink's own.
using Shared = std::variant<Heartbeat, ParamRequestRead, ParamRequestList, ParamValue, ParamSet,
                            AttitudeQuaternion, RcChannels, Timesync, Statustext>;

const std::filesystem::path kFolder =
    std::filesystem::path(IRONBIRD_SOURCE_DIR) / "hil_bridge/rosflight/test/foreign";

/// The name that the other library gives to a field: param_id is its paramId.
std::string foreign_name(std::string_view name) {
  std::string result;
  bool upper = false;
  for (const char letter : name) {
    if (letter != '_')
      result += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(letter))) : letter;
    upper = letter == '_';
  }
  return result;
}

/// A described message as the other library would print it.
struct Printed {
  json fields = json::object();

  template <class T>
  void operator()(const char* name, const T& member, const char*, const char*) {
    fields[foreign_name(name)] = value(member);
  }
  static json value(const FloatBits& member) {
    return static_cast<double>(std::bit_cast<float>(member.bits));
  }
  template <std::size_t N>
  static json value(const std::array<char, N>& member) {
    return std::string(text_of(member));
  }
  template <class T, std::size_t N>
  static json value(const std::array<T, N>& member) {
    return json(member);
  }
  template <class T>
  requires std::is_arithmetic_v<T>
  static json value(T member) {
    if constexpr (sizeof(T) == 8) return std::to_string(member);  // more than a number of JSON can hold
    if constexpr (std::is_floating_point_v<T>) return static_cast<double>(member);
    return member;
  }
};

/// Gives every field any value. A float is finite: how others print NaNs is their business.
struct Filled {
  std::mt19937_64& random;

  template <class T>
  void operator()(const char*, T& member, const char*, const char*) {
    fill(member);
  }
  float real() {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    return std::isfinite(value) ? value : 0.0F;
  }
  void fill(float& member) { member = real(); }
  void fill(FloatBits& member) { member.bits = std::bit_cast<std::uint32_t>(real()); }
  template <std::size_t N>
  void fill(std::array<char, N>& member) {
    const std::size_t size = random() % (N + 1);  // a text may fill its field to the last letter
    for (std::size_t k = 0; k < size; ++k) member[k] = static_cast<char>('!' + random() % 94);
  }
  template <class T>
  requires std::is_integral_v<T>
  void fill(T& member) { member = static_cast<T>(random()); }
};

json described(const Frame& frame) {
  return std::visit(
      [&](const auto& content) {
        Printed printed;
        content.describe(content, printed);
        return json{{"id", content.kId},
                    {"sequence", frame.sequence},
                    {"system", frame.sender.system},
                    {"component", frame.sender.component},
                    {"fields", printed.fields}};
      },
      frame.message);
}

template <class... M>
std::vector<Frame> any_frames(std::type_identity<std::variant<M...>>) {
  std::mt19937_64 random(9);
  std::vector<Frame> frames;
  const auto add = [&]<class One>(std::type_identity<One>) {
    for (int k = 0; k < kEach; ++k) {
      One message{};
      One::describe(message, Filled{random});
      const Address sender = {static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random())};
      frames.push_back({message, static_cast<std::uint8_t>(k), sender});
    }
  };
  (add(std::type_identity<M>{}), ...);
  return frames;
}

template <class... M>
std::string numbers(std::type_identity<std::variant<M...>>) {
  return ((" " + std::to_string(M::kId)) + ...);
}

/// What the other library says.
json ask(const std::string& arguments) {
  const std::string command =
      "node '" + (kFolder / "second_opinion.mjs").string() + "' " + arguments + " 2>&1";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start: " + command);
  std::string output;
  std::array<char, 4096> part;
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), pipe))
    output.append(part.data(), count);
  if (::pclose(pipe) != 0) throw std::runtime_error("the other library failed:\n" + output);
  return json::parse(output);
}

class ForeignCodecTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(std::filesystem::exists(kFolder / "node_modules" / "node-mavlink"))
        << "the other library is not installed in " << kFolder << ": run ci/setup --test";
  }
  static void expect_equal(const json& ours, const json& theirs, std::size_t place) {
    ASSERT_EQ(ours, theirs) << "frame " << place;
  }
  const std::filesystem::path file_ =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("ironbird_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() +
       ".frames");
  static constexpr std::size_t kFrames = std::variant_size_v<Shared> * kEach;
};

TEST_F(ForeignCodecTest, ReadsOurFramesAsWeMeantThem) {
  const std::vector<Frame> frames = any_frames(std::type_identity<Shared>{});
  ASSERT_EQ(frames.size(), kFrames);
  std::ofstream stream(file_, std::ios::binary);
  for (const Frame& frame : frames) {
    const auto sent = test::bytes(encode_frame(frame.message, frame.sequence, frame.sender));
    stream.write(reinterpret_cast<const char*>(sent.data()), static_cast<std::streamsize>(sent.size()));
  }
  stream.close();
  const json found = ask("read '" + file_.string() + "'");
  ASSERT_EQ(found.size(), frames.size());
  for (std::size_t k = 0; k < frames.size(); ++k) expect_equal(described(frames[k]), found[k], k);
}

TEST_F(ForeignCodecTest, IsReadByUsAsItWasMeant) {
  const json written =
      ask("write '" + file_.string() + "' " + std::to_string(kEach) + numbers(std::type_identity<Shared>{}));
  std::ifstream stream(file_, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(stream), {}};
  StreamDecoder decoder;
  const std::vector<Frame> found = test::decode(decoder, bytes);
  ASSERT_EQ(written.size(), kFrames);
  ASSERT_EQ(found.size(), written.size());
  EXPECT_EQ(decoder.counts().skipped_bytes, 0U);
  for (std::size_t k = 0; k < found.size(); ++k) expect_equal(described(found[k]), written[k], k);
}

}  // namespace
}  // namespace ironbird::hil_bridge::rosflight
