#include "hil_bridge/transport/awake_cores.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>

namespace ironbird::hil_bridge::transport {
namespace {

constexpr const char* kDevice = "/dev/cpu_dma_latency";

TEST(AwakeCores, HaveTheKernelsWordOrSayHowToGetIt) {
  const AwakeCores awake;
  if (!FileDescriptor(open(kDevice, O_WRONLY | O_CLOEXEC))) {
    EXPECT_THAT(awake.missing(), testing::HasSubstr(kDevice));
    return;
  }
  EXPECT_EQ(awake.missing(), "");
  // What all programs' wishes come to, us.
  const FileDescriptor device(open(kDevice, O_RDONLY | O_CLOEXEC));
  std::int32_t granted = -1;
  ASSERT_EQ(read(device.number(), &granted, sizeof granted), static_cast<ssize_t>(sizeof granted));
  EXPECT_EQ(granted, 0);
}

}  // namespace
}  // namespace ironbird::hil_bridge::transport
