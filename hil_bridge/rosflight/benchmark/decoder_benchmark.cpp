#include <benchmark/benchmark.h>

#include <vector>

#include "hil_bridge/rosflight/stream_decoder.hpp"

// Bytes a second of the decoder, on the traffic of a flight and on the worst that can be sent. The time of
// one byte is the reciprocal: 200 ns a byte are 5 MB/s.

namespace ironbird::hil_bridge::rosflight {
namespace {

using Bytes = std::vector<std::uint8_t>;

void append(Bytes& stream, const Message& message, std::uint8_t sequence) {
  const FrameBytes frame = encode_frame(message, sequence, {1, 250});
  stream.insert(stream.end(), frame.bytes.begin(),
                frame.bytes.begin() + static_cast<std::ptrdiff_t>(frame.size));
}

/// The downlink of a flight: 400 Hz IMU and attitude, every fourth a compass, every eighth the outputs.
Bytes flight() {
  Bytes stream;
  for (std::uint32_t k = 0; k < 4000; ++k) {
    const float real = 0.001F * static_cast<float>(k);
    const auto sequence = static_cast<std::uint8_t>(k);
    append(stream, SmallImu{2500U * k, real, -real, -9.8F + real, real, real, real, 300.0F}, sequence);
    append(stream, AttitudeQuaternion{.time_boot_ms = k, .q1 = 1.0F - real, .q2 = real}, sequence);
    if (k % 4U == 0U) append(stream, SmallMag{real, real, real}, sequence);
    if (k % 8U == 0U) append(stream, RosflightOutputRaw{.stamp = k, .values = {real, real}}, sequence);
  }
  return stream;
}

Bytes repeated(const Bytes& pattern) {
  Bytes stream(200'000);
  for (std::size_t k = 0; k < stream.size(); ++k) stream[k] = pattern[k % pattern.size()];
  return stream;
}

void decode(benchmark::State& state, const Bytes& stream) {
  StreamDecoder decoder;
  for (auto _ : state) {
    decoder.push(stream, [](const Frame& frame) { benchmark::DoNotOptimize(frame); });
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(decoder.counts().bytes));
  state.counters["frames"] = static_cast<double>(decoder.counts().frames);
}

BENCHMARK_CAPTURE(decode, flight, flight());
BENCHMARK_CAPTURE(decode, start_bytes_only, repeated({kFrameStart}));
BENCHMARK_CAPTURE(decode, headers_of_the_longest_message, repeated({kFrameStart, 70, 193}));
BENCHMARK_CAPTURE(decode, headers_of_an_unknown_message, repeated({kFrameStart, 255, 200}));

}  // namespace
}  // namespace ironbird::hil_bridge::rosflight
