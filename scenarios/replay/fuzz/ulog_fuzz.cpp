// Any bytes as a ULog file, and any flight that it may tell of: it is refused in one line that names the
// file, or it is read; every record is as long as its layout says, every field that a layout has can be found
// and read, and what becomes of it for the autopilot is in order.

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "ci/fuzzing/harness.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/replay/px4_flight.hpp"
#include "scenarios/replay/ulog_file.hpp"

namespace ironbird::fuzzing {

namespace {

using scenarios::UlogFile;
using scenarios::UlogLayout;
using scenarios::UlogSeries;

constexpr std::uint8_t kHeader[] = {'U', 'L', 'o', 'g', 0x01, 0x12, 0x35, 1, 0, 0, 0, 0, 0, 0, 0, 0};

// Topics that make a flight, in fields of several versions.
constexpr const char* kFormats[] = {
    "sensor_combined:uint64_t timestamp;float[3] gyro_rad;uint32_t gyro_integral_dt;int32_t "
    "accelerometer_timestamp_relative;float[3] accelerometer_m_s2;",
    "vehicle_gps_position:uint64_t timestamp;uint64_t time_utc_usec;int32_t lat;int32_t lon;int32_t "
    "alt;float eph;float vel_n_m_s;float vel_e_m_s;float vel_d_m_s;uint8_t fix_type;bool vel_ned_valid;",
    "sensor_gps:uint64_t timestamp;double latitude_deg;double longitude_deg;double altitude_msl_m;uint8_t "
    "fix_type;",
    "vehicle_magnetometer:uint64_t timestamp;float[3] magnetometer_ga;",
    "vehicle_air_data:uint64_t timestamp;float baro_pressure_pa;float baro_temp_celcius;",
    "vehicle_attitude:uint64_t timestamp;float[4] q;uint8_t[4] _padding0;",
    "vehicle_local_position:uint64_t timestamp;double ref_lat;double ref_lon;float x;float y;float z;float "
    "delta_heading;uint8_t heading_reset_counter;uint8_t xy_reset_counter;bool xy_valid;",
    "vehicle_status:uint64_t timestamp;uint8_t arming_state;uint8_t hil_state;uint8_t vehicle_type;",
    "vehicle_land_detected:uint64_t timestamp;bool landed;",
    "outer:uint64_t timestamp;inner[3] part;",
    "inner:float a;outer b;",
    "esc:inner2[8] esc;uint64_t timestamp;",
    "inner2:uint64_t t;int16_t v;uint8_t[6] _padding0;"};
constexpr const char* kTopics[] = {"sensor_combined",
                                   "vehicle_gps_position",
                                   "sensor_gps",
                                   "vehicle_magnetometer",
                                   "vehicle_air_data",
                                   "vehicle_attitude",
                                   "vehicle_local_position",
                                   "vehicle_status",
                                   "vehicle_land_detected",
                                   "outer",
                                   "inner",
                                   "esc",
                                   "inner2"};

class LogWriter {
 public:
  explicit LogWriter(Choices& choices) : choices_(choices), bytes_(std::begin(kHeader), std::end(kHeader)) {}

  std::vector<std::uint8_t> write() {
    while (choices_.any_left() && bytes_.size() < 8192) add_one();
    return std::move(bytes_);
  }

 private:
  void message(char type, const std::vector<std::uint8_t>& content) {
    const auto size = static_cast<std::uint16_t>(content.size());
    bytes_.push_back(static_cast<std::uint8_t>(size & 0xFFU));
    bytes_.push_back(static_cast<std::uint8_t>(size >> 8U));
    bytes_.push_back(static_cast<std::uint8_t>(type));
    bytes_.insert(bytes_.end(), content.begin(), content.end());
  }
  static void append(std::vector<std::uint8_t>& to, const char* text) {
    to.insert(to.end(), text, text + std::strlen(text));
  }
  std::vector<std::uint8_t> some(std::size_t most) {
    const auto bytes = choices_.take(choices_.below(most));
    return {bytes.begin(), bytes.end()};
  }
  void add_one() {
    std::vector<std::uint8_t> content;
    switch (choices_.below(10)) {
      case 0:
        append(content, kFormats[choices_.below(std::size(kFormats))]);
        return message('F', content);
      case 1: {
        const std::size_t topic = choices_.below(std::size(kTopics));
        content = {static_cast<std::uint8_t>(choices_.below(3)), static_cast<std::uint8_t>(topic), 0};
        append(content, kTopics[topic]);
        return message('A', content);
      }
      case 2:
        content = {static_cast<std::uint8_t>(15)};
        append(content, "int32_t SYS_HITL");
        content.insert(content.end(), 4, choices_.byte());
        return message('P', content);
      case 3:
        return message("BFIMPQARDLCSOZ"[choices_.below(14)], some(64));
      case 4:
        bytes_.insert(bytes_.end(), choices_.below(8), choices_.byte());
        return;
      default: {
        content = {static_cast<std::uint8_t>(choices_.below(std::size(kTopics))), 0};
        const std::vector<std::uint8_t> record = some(96);
        content.insert(content.end(), record.begin(), record.end());
        return message('D', content);
      }
    }
  }

  Choices& choices_;
  std::vector<std::uint8_t> bytes_;
};

void expect_readable(const UlogSeries& series, const UlogLayout& layout, const std::string& path, int depth) {
  for (const UlogLayout::Field& field : layout.fields) {
    if (field.count == 0 || layout.find(field.name) != &field) continue;
    const std::string name = path + field.name + "[" + std::to_string(field.count - 1) + "]";
    if (field.nested != nullptr) {
      if (depth < 4) expect_readable(series, *field.nested, name + ".", depth + 1);
      continue;
    }
    // Names with dots and brackets of their own cannot be told from a path.
    if (name.find_first_of(".[") != name.find_last_of(".[") && depth == 0) continue;
    const auto place = series.find(name);
    if (!place) continue;
    for (const std::size_t k : {std::size_t{0}, series.size() - 1}) {
      const volatile double number = series.number(k, *place);
      const volatile std::int64_t integer = series.integer(k, *place);
      (void)number;
      (void)integer;
    }
  }
}

void expect_sound(const UlogFile& file) {
  for (const UlogSeries& series : file.series()) {
    require(series.layout() != nullptr || series.size() == 0, "records have a layout");
    for (std::size_t k = 0; k < series.size(); ++k)
      require(series.layout()->takes(series.record(k).size()), "a record is as long as its layout says");
    if (series.size() > 0) expect_readable(series, *series.layout(), "", 0);
  }
  for (const std::string& complaint : file.complaints())
    require(complaint.find('\n') == std::string::npos, "a complaint is one line: " + complaint);
}

void expect_in_order(const scenarios::Px4Flight& px4) {
  const auto& messages = px4.flight.messages;
  require(std::is_sorted(messages.begin(), messages.end(),
                         [](const auto& one, const auto& other) { return one.when < other.when; }),
          "messages are in the order of time");
  require(messages.empty() || messages.front().when >= hil_bridge::Time::zero(),
          "nothing is before the beginning");
}

}  // namespace

void check(std::span<const std::uint8_t> input) {
  if (input.empty()) return;
  std::vector<std::uint8_t> bytes(std::begin(kHeader), std::end(kHeader));
  if ((input[0] & 1U) != 0) {
    bytes.insert(bytes.end(), input.begin() + 1, input.end());
  } else {
    Choices choices(input.subspan(1));
    bytes = LogWriter(choices).write();
  }
  try {
    const UlogFile file = UlogFile::from(std::move(bytes), "some.ulg");
    expect_sound(file);
    expect_in_order(scenarios::read_px4_flight(file, "some.ulg"));
  } catch (const scenarios::UserError& error) {
    const std::string what = error.what();
    require(what.starts_with("some.ulg: "), "a refusal names the file: " + what);
    require(what.find('\n') == std::string::npos, "a refusal is one line: " + what);
  }
}

}  // namespace ironbird::fuzzing
