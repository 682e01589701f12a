#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "scenarios/config/user_error.hpp"
#include "scenarios/config/write_file.hpp"

#include "scenarios/video/video_sink.hpp"

namespace ironbird::scenarios {
namespace {

class Y4mSink final : public VideoSink {
 public:
  Y4mSink(const std::filesystem::path& file, const VideoFormat& format)
      : file_(file), part_(file.string() + ".part"), stream_(part_, std::ios::binary) {
    stream_ << "YUV4MPEG2 W" << format.width << " H" << format.height << " F" << format.frame_rate
            << ":1 Ip A1:1 C420jpeg XCOLORRANGE=LIMITED\n";
    check();
  }

  ~Y4mSink() override {
    stream_.close();
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
  }

  void write(std::span<const std::uint8_t> yuv) override {
    stream_ << "FRAME\n";
    stream_.write(reinterpret_cast<const char*>(yuv.data()), static_cast<std::streamsize>(yuv.size()));
    check();
  }

  void finish() override {
    stream_.close();
    check();
    std::filesystem::rename(part_, file_);
  }

 private:
  void check() {
    if (!stream_) {
      throw UserError(with_remedy(file_.string() + ": cannot be written: " + std::strerror(errno)));
    }
  }

  std::filesystem::path file_;
  std::filesystem::path part_;
  std::ofstream stream_;
};

}  // namespace

std::unique_ptr<VideoSink> make_y4m_sink(const std::filesystem::path& file, const VideoFormat& format) {
  return std::make_unique<Y4mSink>(file, format);
}

}  // namespace ironbird::scenarios
