#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace ironbird::scenarios {

/// Size and speed of a film.
struct VideoFormat {
  int width = 1280;
  int height = 720;
  int frame_rate = 30;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("width", self.width, "px", "even", 16, 3840);
    visit("height", self.height, "px", "even", 16, 2160);
    visit("frame_rate", self.frame_rate, "1/s", "pictures per second", 1, 120);
  }
};

/// Where the pictures of a film go, one after the other. The file appears under its name when it is finished;
/// a sink that is destroyed before leaves nothing behind.
class VideoSink {
 public:
  virtual ~VideoSink() = default;

  /// @param yuv  one picture, planar YUV 4:2:0, see yuv.hpp. @throws std::runtime_error with the reason
  virtual void write(std::span<const std::uint8_t> yuv) = 0;

  /// Ends the film and gives the file its name. @throws std::runtime_error with the reason
  virtual void finish() = 0;
};

/// Finds out before the work whether make_mp4_sink() would find its program; whether it works is seen then.
/// @throws UserError that says what to install
void check_encoder(const std::string& program = "ffmpeg");

/// Uncompressed YUV4MPEG2.
std::unique_ptr<VideoSink> make_y4m_sink(const std::filesystem::path& file, const VideoFormat& format);

/// H.264 in MP4 through one `ffmpeg` process. One encoder thread: the same pictures give the same bytes.
/// @param preset  of the encoder, for example "veryfast"
/// @throws std::runtime_error when the program cannot be started
std::unique_ptr<VideoSink> make_mp4_sink(const std::filesystem::path& file, const VideoFormat& format,
                                         const std::string& preset, const std::string& program = "ffmpeg");

}  // namespace ironbird::scenarios
