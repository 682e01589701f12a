#include "hil_bridge/transport/byte_stream.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numeric>
#include <thread>
#include <vector>

#include "hil_bridge/transport/pseudo_terminal.hpp"
#include "hil_bridge/transport/serial_port.hpp"
#include "hil_bridge/transport/stream_pair.hpp"
#include "hil_bridge/transport/udp_socket.hpp"

namespace ironbird::hil_bridge::transport {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;
using testing::HasSubstr;

/// Waits until `holds`, at most as long as a loaded machine may take.
template <class Holds>
bool soon(Holds&& holds) {
  for (int k = 0; k < 5000; ++k) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

/// Everything that arrives until `count` bytes are there.
Bytes received(ByteStream& stream, std::size_t count) {
  Bytes all;
  soon([&] {
    Bytes some(65536);
    some.resize(stream.read(some));
    all.insert(all.end(), some.begin(), some.end());
    return all.size() >= count;
  });
  return all;
}

Bytes every_byte() {
  Bytes bytes(256);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  return bytes;
}

/// What a pseudo-terminal says that cannot have this link.
std::string refusal_of_link(const fs::path& link) {
  try {
    const PseudoTerminal terminal(link.string());
    return "made";
  } catch (const LinkError& error) {
    return error.what();
  }
}

/// A folder of this test's own.
fs::path folder() {
  const testing::TestInfo* const info = testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string("ironbird_") + info->test_suite_name() + "_" + info->name();
  std::replace(name.begin(), name.end(), '/', '_');
  const fs::path path = fs::path(testing::TempDir()) / name;
  fs::remove_all(path);
  fs::create_directories(path);
  return path;
}

/// Two ends of one line, of each kind that there is.
struct Ends {
  virtual ~Ends() = default;
  virtual ByteStream& one() = 0;
  virtual ByteStream& other() = 0;
};

struct PairEnds final : Ends {
  ByteStream& one() override { return pair.near(); }
  ByteStream& other() override { return pair.far(); }
  StreamPair pair;
};

struct TerminalEnds final : Ends {
  TerminalEnds() : port({terminal.device(), 921600}) { port.open(); }
  ByteStream& one() override { return terminal; }
  ByteStream& other() override { return port; }
  PseudoTerminal terminal;
  SerialPort port;
};

/// A port that no other test process uses now.
int own_port(int number) {
  constexpr int kFirst = 20000;
  constexpr int kProcesses = 1200;
  constexpr int kPortsEach = 10;
  return kFirst + kPortsEach * (getpid() % kProcesses) + number;
}

struct DatagramEnds final : Ends {
  DatagramEnds()
      : unit({own_port(0), "localhost", own_port(1)}), companion({own_port(1), "127.0.0.1", own_port(0)}) {
    unit.open();
    companion.open();
  }
  ByteStream& one() override { return unit; }
  ByteStream& other() override { return companion; }
  UdpSocket unit;
  UdpSocket companion;
};

using MakeEnds = std::unique_ptr<Ends> (*)();
template <class T>
std::unique_ptr<Ends> make() {
  return std::make_unique<T>();
}

class ByteStreamTest : public testing::TestWithParam<std::pair<const char*, MakeEnds>> {
 protected:
  void SetUp() override { ends_ = GetParam().second(); }
  std::unique_ptr<Ends> ends_;
};

TEST_P(ByteStreamTest, CarriesEveryByteAsItIsInBothDirections) {
  const Bytes sent = every_byte();
  EXPECT_EQ(ends_->one().write(sent), sent.size());
  EXPECT_EQ(received(ends_->other(), sent.size()), sent);
  EXPECT_EQ(ends_->other().write(sent), sent.size());
  EXPECT_EQ(received(ends_->one(), sent.size()), sent);
}

TEST_P(ByteStreamTest, ReadsNothingAtOnceWhenNothingIsThere) {
  Bytes some(10);
  EXPECT_EQ(ends_->one().read(some), 0U);
  EXPECT_EQ(ends_->other().read(some), 0U);
  EXPECT_TRUE(ends_->one().is_up());
  EXPECT_TRUE(ends_->other().is_up());
}

TEST_P(ByteStreamTest, TellsPollThatBytesAreThere) {
  const int descriptor = ends_->other().descriptor();
  if (descriptor < 0) {
    EXPECT_STREQ(GetParam().first, "pair");
    return;
  }
  pollfd state{descriptor, POLLIN, 0};
  EXPECT_EQ(poll(&state, 1, 0), 0);
  ends_->one().write(Bytes{1});
  EXPECT_EQ(poll(&state, 1, 5000), 1);
}

INSTANTIATE_TEST_SUITE_P(Lines, ByteStreamTest,
                         testing::Values(std::pair{"pair", &make<PairEnds>},
                                         std::pair{"serial", &make<TerminalEnds>},
                                         std::pair{"udp", &make<DatagramEnds>}),
                         [](const auto& line) { return std::string(line.param.first); });

// ---- serial ports ----

std::string refusal_of_port(SerialPort port) {
  try {
    port.open();
  } catch (const LinkError& error) {
    return error.what();
  }
  return "it opened";
}

TEST(SerialPortTest, SaysWhichPortsThereAreWhenTheOneNamedIsMissing) {
  EXPECT_THAT(refusal_of_port(SerialPort({"/dev/ttyACM_none", 921600})),
              testing::AllOf(HasSubstr("/dev/ttyACM_none: there is no such port; "),
                             testing::AnyOf(HasSubstr("there are: /dev/"), HasSubstr("is the cable in?"))));
}

TEST(SerialPortTest, RefusesWhatIsNoSerialPort) {
  const fs::path file = folder() / "file";
  std::ofstream(file) << "text";
  EXPECT_THAT(refusal_of_port(SerialPort({file.string(), 921600})), HasSubstr("it is not a serial port; "));
  EXPECT_THAT(refusal_of_port(SerialPort({file.parent_path().string(), 921600})),
              HasSubstr("it is not a serial port; "));
  std::ifstream in(file);
  std::string text;
  in >> text;
  EXPECT_EQ(text, "text");
}

TEST(SerialPortTest, RefusesAPortThatAnotherHas) {
  const PseudoTerminal terminal;
  SerialPort first({terminal.device(), 115200});
  first.open();
  EXPECT_THAT(refusal_of_port(SerialPort({terminal.device(), 115200})), HasSubstr("another program uses it"));
}

// Most programs ask for no lock.
TEST(SerialPortTest, RefusesAPortThatAnotherHasWithoutALock) {
  const PseudoTerminal terminal;
  FILE* const other = popen(("exec 3<>" + terminal.device() + "; echo $$; exec sleep 60").c_str(), "r");
  ASSERT_NE(other, nullptr);
  int process = 0;
  ASSERT_EQ(fscanf(other, "%d", &process), 1);
  EXPECT_THAT(
      refusal_of_port(SerialPort({terminal.device(), 115200})),
      HasSubstr(terminal.device() + ": process " + std::to_string(process) + " (s"));  // sh, soon sleep
  kill(process, SIGKILL);
  pclose(other);
}

TEST(SerialPortTest, TakesAnyRateAndRefusesOnesThatCannotBe) {
  const PseudoTerminal terminal;
  for (const int baud : {300, 57600, 921600, 1'234'567, 4'000'000}) {
    SerialPort port({terminal.device(), baud});
    EXPECT_NO_THROW(port.open()) << baud;
  }
  EXPECT_THROW(SerialPort({terminal.device(), 0}), std::invalid_argument);
}

TEST(SerialPortTest, StartsWithoutACableAndFindsItLater) {
  const fs::path link = folder() / "unit";
  SerialPort port({link.string(), 921600});
  EXPECT_FALSE(port.reopen());
  EXPECT_FALSE(port.is_up());
  PseudoTerminal terminal(link.string());
  EXPECT_TRUE(port.reopen());
  terminal.write(Bytes{42});
  EXPECT_EQ(received(port, 1), Bytes{42});
}

TEST(SerialPortTest, GoesDownWhenThePlugIsPulledAndComesBackWithTheNextDevice) {
  const fs::path link = folder() / "unit";
  PseudoTerminal terminal(link.string());
  SerialPort port({link.string(), 921600});
  port.open();
  for (int k = 0; k < 50; ++k) {
    terminal.hang_up();
    EXPECT_TRUE(soon([&] {
      Bytes some(10);
      port.read(some);
      return !port.is_up();
    }));
    EXPECT_EQ(port.write(Bytes{1}), 0U);
    ASSERT_TRUE(terminal.reopen());
    ASSERT_TRUE(port.reopen());
    port.write(every_byte());
    EXPECT_EQ(received(terminal, 256), every_byte());
  }
}

TEST(SerialPortTest, ThrowsAwayWhatWasSentBeforeItOpened) {
  PseudoTerminal terminal;
  // GIVEN a sender with a queue of its own behind a line that is full
  while (terminal.write(Bytes(1000, 1)) > 0) {
  }
  std::jthread sender([&terminal, queue = 20'000](const std::stop_token& stop) mutable {
    while (!stop.stop_requested() && queue > 0) queue -= static_cast<int>(terminal.write(Bytes(100, 1)));
  });
  SerialPort port({terminal.device(), 921600});
  port.open();
  sender.join();
  terminal.write(Bytes{7});
  EXPECT_EQ(received(port, 1), Bytes{7});
}

// ---- pseudo-terminals, datagrams ----

TEST(PseudoTerminalTest, DoesNotReplaceWhatIsNoLink) {
  const fs::path file = folder() / "precious";
  std::ofstream(file) << "data";
  EXPECT_THROW(PseudoTerminal{file.string()}, LinkError);
  EXPECT_TRUE(fs::is_regular_file(file));
}

TEST(PseudoTerminalTest, DoesNotReplaceALinkToSomethingElse) {
  const fs::path link = folder() / "unit";
  for (const char* const target : {"/dev/null", "nowhere", "/dev/serial/by-id/somebodys"}) {
    fs::remove(link);
    fs::create_symlink(target, link);
    EXPECT_THAT(refusal_of_link(link), HasSubstr(std::string("is a link to ") + target + ", which is no "));
    EXPECT_EQ(fs::read_symlink(link), target);
  }
}

TEST(PseudoTerminalTest, DoesNotReplaceTheLinkOfOneThatIsInUse) {
  const fs::path link = folder() / "unit";
  const PseudoTerminal first(link.string());
  EXPECT_THAT(refusal_of_link(link), HasSubstr("is a link to " + first.device() + ", which process " +
                                               std::to_string(getpid()) + " (transport_test) has; end that"));
  EXPECT_EQ(fs::read_symlink(link), first.device());
}

TEST(PseudoTerminalTest, ReplacesTheLinkOfOneThatIsNoMore) {
  const fs::path link = folder() / "unit";
  // A number that was given back is the next one's, or nobody's, unless another program is quicker.
  const auto replaces_a_link_given_back = [&] {
    fs::remove(link);
    fs::create_symlink(PseudoTerminal().device(), link);
    return refusal_of_link(link) == "made";
  };
  EXPECT_TRUE(replaces_a_link_given_back() || replaces_a_link_given_back() || replaces_a_link_given_back());
  fs::remove(link);
  fs::create_symlink("/dev/pts/999999", link);
  const PseudoTerminal terminal(link.string());
  EXPECT_EQ(fs::read_symlink(link), terminal.device());
}

TEST(PseudoTerminalTest, TakesItsLinkAwayAtTheEnd) {
  const fs::path link = folder() / "unit";
  {
    const PseudoTerminal terminal(link.string());
    EXPECT_EQ(fs::read_symlink(link), terminal.device());
  }
  EXPECT_FALSE(fs::exists(fs::symlink_status(link)));
}

TEST(PseudoTerminalTest, TakesNoMoreThanTheLineHoldsWhileNobodyReads) {
  PseudoTerminal terminal;
  std::size_t taken = 0;
  for (int k = 0; k < 1000; ++k) taken += terminal.write(Bytes(1000, 1));
  EXPECT_GT(taken, 1000U);
  EXPECT_LT(taken, 1'000'000U);
}

TEST(UdpSocketTest, SaysWhoseThePortIs) {
  UdpSocket one({own_port(0), "localhost", own_port(1)});
  one.open();
  UdpSocket two({own_port(0), "localhost", own_port(2)});
  try {
    two.open();
    FAIL();
  } catch (const LinkError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("UDP port " + std::to_string(own_port(0)) + ": another program uses it"));
  }
}

TEST(UdpSocketTest, StaysUpWhileNobodyListens) {
  UdpSocket socket({own_port(0), "localhost", own_port(1)});
  socket.open();
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(socket.write(Bytes{1, 2}), 2U);
    Bytes some(10);
    EXPECT_EQ(socket.read(some), 0U);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(socket.is_up());
}

TEST(UdpSocketTest, ReadsTheOtherSideAsAUserWritesIt) {
  const auto usual = udp_peer("unit.local");
  ASSERT_TRUE(usual);
  EXPECT_EQ(usual->host, "unit.local");
  EXPECT_EQ(usual->port, UdpConfig{}.port);
  EXPECT_EQ(usual->local_port, UdpConfig{}.local_port);
  const auto own = udp_peer("10.0.0.7:65535");
  ASSERT_TRUE(own);
  EXPECT_EQ(own->host, "10.0.0.7");
  EXPECT_EQ(own->port, 65535);
  const auto both = udp_peer("host:14530:14531");
  ASSERT_TRUE(both);
  EXPECT_EQ(both->port, 14530);
  EXPECT_EQ(both->local_port, 14531);
  for (const char* text : {"", ":14525", "host:", "host:0", "host:65536", "host:12x", "host: 12", "host:-1",
                           "host:1:", "host:1:0", "host:1:2:3", "host::2", "::1"}) {
    EXPECT_FALSE(udp_peer(text)) << text;
  }
}

TEST(UdpSocketTest, RefusesAHostThatDoesNotExist) {
  UdpSocket socket({own_port(0), "no.such.host.invalid", own_port(1)});
  EXPECT_THROW(socket.open(), LinkError);
}

}  // namespace
}  // namespace ironbird::hil_bridge::transport
