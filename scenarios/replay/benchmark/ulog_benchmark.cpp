// How fast a ULog is read, bytes of the file per second of CPU: the flights beside the checkout, and one made
// by hand.

#include <benchmark/benchmark.h>

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "scenarios/replay/px4_flight.hpp"
#include "scenarios/replay/test/flight_by_hand.hpp"
#include "scenarios/replay/test/flights.hpp"

namespace ironbird::scenarios {
namespace {

/// From the disk, as the program does: the file's pages are in memory after the first time.
void read_file(benchmark::State& state, const std::filesystem::path& file) {
  for (auto _ : state) benchmark::DoNotOptimize(UlogFile::read(file));
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(file));
  state.SetBytesProcessed(state.iterations() * size);
}

/// Sensors and estimates out of a log that has been read.
void take_flight(benchmark::State& state, const std::filesystem::path& file) {
  const UlogFile log = UlogFile::read(file);
  for (auto _ : state) benchmark::DoNotOptimize(read_px4_flight(log, file.string()));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(log.file_size()));
}

void register_for(const std::string& name, const std::filesystem::path& file) {
  benchmark::RegisterBenchmark(("read/" + name).c_str(), read_file, file);
  benchmark::RegisterBenchmark(("take/" + name).c_str(), take_flight, file);
}

}  // namespace
}  // namespace ironbird::scenarios

int main(int argc, char** argv) {
  using namespace ironbird::scenarios;
  const std::filesystem::path by_hand =
      std::filesystem::temp_directory_path() / ("ironbird_by_hand_" + std::to_string(getpid()) + ".ulg");
  register_for("by_hand", test::FlightByHand{.seconds = 120.0}.write(by_hand));
  const std::filesystem::path folder = test::flights_folder();
  for (const test::KnownFlight& flight : test::kKnownFlights) {
    if (!folder.empty()) register_for(flight.file, folder / "px4" / (std::string(flight.file) + ".ulg"));
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  std::filesystem::remove(by_hand);
}
