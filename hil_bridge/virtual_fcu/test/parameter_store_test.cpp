#include "hil_bridge/virtual_fcu/parameter_store.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace ironbird::hil_bridge::virtual_fcu {
namespace {

struct GoldenRow {
  int index = 0;
  std::string name;
  char type = '?';
  std::string value;
};

/// The list of a real unit: index, name, type letter, default.
std::vector<GoldenRow> golden() {
  std::ifstream file(IRONBIRD_SOURCE_DIR "/hil_bridge/virtual_fcu/test/golden/parameters.csv");
  std::vector<GoldenRow> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::string index;
    std::string type;
    GoldenRow row;
    std::getline(cells, index, ',');
    std::getline(cells, row.name, ',');
    std::getline(cells, type, ',');
    std::getline(cells, row.value, ',');
    row.index = std::stoi(index);
    row.type = type[0];
    rows.push_back(row);
  }
  return rows;
}

TEST(ParameterTableTest, HasTheListOfARealUnitInItsOrder) {
  const std::vector<GoldenRow> rows = golden();
  ASSERT_EQ(rows.size(), 333U);
  const ParameterStore store;
  for (const GoldenRow& row : rows) {
    const ParameterId id = find_parameter(row.name);
    ASSERT_EQ(id.index, row.index) << row.name;
    if (row.type == 'I') {
      EXPECT_EQ(kParameterTable[id.index].type, ParameterType::kInteger) << row.name;
      EXPECT_EQ(store.integer(id), std::stoi(row.value)) << row.name;
    } else {
      EXPECT_EQ(kParameterTable[id.index].type, ParameterType::kReal) << row.name;
      EXPECT_EQ(store.real(id), std::stof(row.value)) << row.name;
    }
  }
}

TEST(ParameterTableTest, HasExactlySevenNamesWithoutATerminator) {
  std::set<std::string> full;
  for (const ParameterInfo& info : kParameterTable) {
    if (rosflight::text_of(info.name).size() == kNameLength) full.emplace(rosflight::text_of(info.name));
  }
  EXPECT_EQ(full, (std::set<std::string>{"MOTOR_RESISTANCE", "PID_PITCH_RATE_P", "PID_PITCH_RATE_I",
                                         "PID_PITCH_RATE_D", "RC_MAX_PITCHRATE", "RC_ARM_THRESHOLD",
                                         "OFFBOARD_TIMEOUT"}));
}

TEST(ParameterTableTest, CountsMixerElementsDownTheColumns) {
  EXPECT_EQ(primary_element(2, 3).index, 31 + 10 * 3 + 2);
  EXPECT_EQ(rosflight::text_of(kParameterTable[primary_element(2, 3).index].name), "PRI_MIXER_2_3");
  EXPECT_EQ(secondary_element(9, 0).index, 131 + 9);
  EXPECT_EQ(rosflight::text_of(kParameterTable[secondary_element(9, 0).index].name), "SEC_MIXER_9_0");
}

TEST(ParameterTableTest, GivesEveryParameterAMeaning) {
  for (const ParameterInfo& info : kParameterTable)
    EXPECT_NE(std::string(info.meaning), "") << rosflight::text_of(info.name);
}

TEST(ParameterTableTest, DoesNotFindANameThatIsOnlyABeginning) {
  EXPECT_EQ(find_parameter("PID_TA").index, kParameterCount);
  EXPECT_EQ(find_parameter("").index, kParameterCount);
}

class Counter : public ParameterStore::Listener {
 public:
  void parameter_changed(ParameterId id) override { seen.push_back(id.index); }
  std::vector<int> seen;
};

TEST(ParameterStoreTest, TellsTheListenerOnlyOfDifferentValues) {
  ParameterStore store;
  Counter counter;
  store.listen(&counter);
  EXPECT_FALSE(store.set(parameter("NUM_MOTORS"), 4));
  EXPECT_TRUE(store.set(parameter("NUM_MOTORS"), 6));
  EXPECT_FALSE(store.set(parameter("NUM_MOTORS"), 6));
  EXPECT_EQ(counter.seen, std::vector<int>{2});
  EXPECT_EQ(store.integer(parameter("NUM_MOTORS")), 6);
}

TEST(ParameterStoreTest, StoresANanEveryTime) {
  ParameterStore store;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(store.set(parameter("PID_TAU"), nan));
  EXPECT_TRUE(store.set(parameter("PID_TAU"), nan));
  EXPECT_TRUE(std::isnan(store.real(parameter("PID_TAU"))));
}

TEST(ParameterStoreTest, KeepsAnIntegerWhoseBitsAreANan) {
  ParameterStore store;
  EXPECT_TRUE(store.set(parameter("NUM_MOTORS"), -1));
  EXPECT_FALSE(store.set(parameter("NUM_MOTORS"), -1));
  EXPECT_EQ(store.bits(parameter("NUM_MOTORS")), 0xFFFFFFFFU);
}

TEST(ParameterStoreTest, LoadsWhatWasSavedWithoutTellingAnybody) {
  ParameterStore store;
  Counter counter;
  store.set(parameter("PID_TAU"), 0.1F);
  store.save();
  store.set(parameter("PID_TAU"), 0.2F);
  store.listen(&counter);
  store.load();
  EXPECT_EQ(store.real(parameter("PID_TAU")), 0.1F);
  store.set_defaults();
  EXPECT_EQ(store.real(parameter("PID_TAU")), 0.05F);
  EXPECT_TRUE(counter.seen.empty());
}

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
