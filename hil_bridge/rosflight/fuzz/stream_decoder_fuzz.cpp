// Whatever comes over a line: the companion's decoder finds exactly the frames that a plain search finds,
// however the bytes are cut; each encodes to the bytes that it came as; and after any corruption the next
// intact frame that does not begin inside another one is there.

#include <algorithm>

#include "ci/fuzzing/harness.hpp"
#include "hil_bridge/rosflight/fuzz/stream_of.hpp"
#include "hil_bridge/rosflight/stream_decoder.hpp"

namespace ironbird::fuzzing {

namespace {

namespace wire = hil_bridge::rosflight;
using wire::fuzz::Bytes;
using wire::fuzz::Found;
using wire::fuzz::Stream;

/// The longest frame of the dialect: as many zeros behind a stream end all waiting.
constexpr std::size_t kQuiet = 78;

/// The frames of a stream: at each start byte a whole sound frame, or nothing and on by one byte.
std::vector<Found> search(const Bytes& bytes) {
  std::vector<Found> found;
  for (std::size_t k = 0; k < bytes.size();) {
    const auto at = std::span(bytes).subspan(k);
    if (wire::fuzz::is_frame(at)) {
      found.push_back({k, wire::kFrameOverhead + at[1]});
      k = found.back().end();
    } else {
      ++k;
    }
  }
  return found;
}

/// Gives the bytes in pieces, and looks at every frame that comes out.
void expect_found(const Bytes& bytes, const std::vector<Found>& expected,
                  std::span<const std::uint8_t> pieces) {
  wire::StreamDecoder decoder;
  std::size_t count = 0;
  std::size_t piece = 0;
  for (std::size_t k = 0; k < bytes.size();) {
    const std::size_t wanted = pieces.empty() ? bytes.size() : 1U + pieces[piece++ % pieces.size()];
    const std::size_t size = std::min(wanted, bytes.size() - k);
    decoder.push(std::span(bytes).subspan(k, size), [&](const wire::Frame& frame) {
      require(count < expected.size(), "no frame is found that is not there");
      const auto came = std::span(bytes).subspan(expected[count].begin, expected[count].size);
      const Bytes again = wire::fuzz::sent_again(frame);
      require(std::equal(again.begin(), again.end(), came.begin(), came.end()),
              "a frame encodes to the bytes that it came as");
      require(expected[count].end() <= k + size, "a frame is not found before it has arrived");
      ++count;
    });
    k += size;
  }
  require(count == expected.size(), "every frame that is there is found");
  decoder.clear();
  std::size_t framed = 0;
  for (const Found& found : expected) framed += found.size;
  require(decoder.counts().bytes == bytes.size(), "every byte is counted");
  require(decoder.counts().skipped_bytes == bytes.size() - framed, "what is no part of a frame is counted");
  require(decoder.counts().frames == count, "every frame is counted");
}

}  // namespace

void check(std::span<const std::uint8_t> input) {
  Stream stream = wire::fuzz::stream_of(input);
  stream.bytes.insert(stream.bytes.end(), kQuiet, 0);
  const std::vector<Found> expected = search(stream.bytes);
  for (const Found& intact : stream.intact) {
    const bool there = std::any_of(expected.begin(), expected.end(), [&](const Found& one) {
      return one == intact || (one.begin < intact.begin && one.end() > intact.begin);
    });
    require(there, "an intact frame is found unless it begins inside another one");
  }
  expect_found(stream.bytes, expected, {});
  expect_found(stream.bytes, expected, input.first(std::min<std::size_t>(input.size(), 16)));
}

}  // namespace ironbird::fuzzing
