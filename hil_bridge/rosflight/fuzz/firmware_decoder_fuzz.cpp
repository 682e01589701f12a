// The firmware's decoder beside the companion's, on the same bytes. Both say the same until the firmware
// drops something; from then on the companion finds whatever the firmware finds, unless another frame
// overlaps it. And the firmware's finds exactly what a plain reading of its rule finds.

#include <algorithm>

#include "ci/fuzzing/harness.hpp"
#include "hil_bridge/rosflight/firmware_decoder.hpp"
#include "hil_bridge/rosflight/fuzz/stream_of.hpp"
#include "hil_bridge/rosflight/stream_decoder.hpp"

namespace ironbird::fuzzing {

namespace {

namespace wire = hil_bridge::rosflight;
using wire::fuzz::Bytes;
using wire::fuzz::Found;

constexpr std::size_t kQuiet = wire::kGreatestFrame;

struct FirmwareFinds {
  std::vector<Found> frames;
  std::size_t before_a_drop = 0;  ///< of them, until the first frame that was dropped
  int corrupted = 0;
  int unknown = 0;
};

/// The rule: a frame is as long as its second byte says; a wrong checksum drops all of it, only its last byte
/// may be a new start; a good one with an unknown number or a false length is passed over.
FirmwareFinds by_the_rule(const Bytes& bytes) {
  FirmwareFinds finds;
  bool dropped = false;
  for (std::size_t k = 0; k < bytes.size();) {
    if (bytes[k] != wire::kFrameStart) {
      ++k;
      continue;
    }
    const std::size_t size = k + 1 < bytes.size() ? wire::kFrameOverhead + bytes[k + 1] : bytes.size();
    if (k + size > bytes.size()) break;
    const wire::MessageInfo* const info = wire::find_message(bytes[k + 5]);
    std::uint16_t crc = wire::kCrcStart;
    for (std::size_t n = k + 1; n < k + size - 2; ++n) crc = wire::crc_of(crc, bytes[n]);
    crc = wire::crc_of(crc, info == nullptr ? std::uint8_t{0} : info->crc_extra);
    const bool sound = bytes[k + size - 2] == (crc & 0xFFU) && bytes[k + size - 1] == crc >> 8U;
    if (sound && info != nullptr && info->length == bytes[k + 1]) {
      finds.frames.push_back({k, size});
      finds.before_a_drop += dropped ? 0 : 1;
    } else {
      ++(sound ? finds.unknown : finds.corrupted);
      dropped = true;
    }
    k += size;
    if (!sound && bytes[k - 1] == wire::kFrameStart) --k;
  }
  return finds;
}

void expect_found(const Bytes& bytes, const FirmwareFinds& expected) {
  wire::FirmwareDecoder decoder;
  std::size_t count = 0;
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    const auto frame = decoder.push(bytes[k]);
    if (!frame) continue;
    require(count < expected.frames.size(), "the firmware finds no frame that is not there");
    const Found& found = expected.frames[count];
    require(found.end() == k + 1, "the firmware finds a frame with its last byte");
    const auto came = std::span(bytes).subspan(found.begin, found.size);
    const Bytes again = wire::fuzz::sent_again(*frame);
    require(std::equal(again.begin(), again.end(), came.begin(), came.end()),
            "a frame encodes to the bytes that it came as");
    ++count;
  }
  require(count == expected.frames.size(), "the firmware finds every frame that its rule finds");
  require(decoder.corrupted() == expected.corrupted && decoder.unknown() == expected.unknown,
          "the firmware counts what it drops");
}

std::vector<Found> companion_finds(const Bytes& bytes) {
  wire::StreamDecoder decoder;
  std::vector<Found> found;
  std::size_t end = 0;
  for (const std::uint8_t& byte : bytes) {
    ++end;
    // One byte can make room for several frames that lay inside the claim of a broken one; the bytes of a
    // frame are known from its own encoding, its place from where those bytes are.
    decoder.push(std::span(&byte, 1), [&](const wire::Frame& frame) {
      const Bytes again = wire::fuzz::sent_again(frame);
      const std::size_t from = found.empty() ? 0 : found.back().end();
      const auto at =
          std::search(bytes.begin() + static_cast<std::ptrdiff_t>(from),
                      bytes.begin() + static_cast<std::ptrdiff_t>(end), again.begin(), again.end());
      found.push_back({static_cast<std::size_t>(at - bytes.begin()), again.size()});
      require(found.back().end() <= end, "a frame of the companion lies in what has arrived");
    });
  }
  return found;
}

}  // namespace

void check(std::span<const std::uint8_t> input) {
  Bytes bytes = wire::fuzz::stream_of(input).bytes;
  bytes.insert(bytes.end(), kQuiet, 0);
  const FirmwareFinds firmware = by_the_rule(bytes);
  expect_found(bytes, firmware);
  const std::vector<Found> companion = companion_finds(bytes);
  require(companion.size() >= firmware.before_a_drop, "until the firmware drops something both find as much");
  require(std::equal(firmware.frames.begin(),
                     firmware.frames.begin() + static_cast<std::ptrdiff_t>(firmware.before_a_drop),
                     companion.begin()),
          "until the firmware drops something both find the same");
  auto at = companion.begin();
  for (const Found& one : firmware.frames) {
    at = std::find_if(at, companion.end(), [&](const Found& other) { return other.end() > one.begin; });
    require(at != companion.end() && at->begin <= one.begin && (*at == one || at->begin < one.begin),
            "the companion finds what the firmware finds, or a frame that overlaps it");
  }
}

}  // namespace ironbird::fuzzing
