// VideoFile on libav. A frame is known by its time stamp: to load one, the decoder goes on to it, or back to the key
// picture before it. The pictures on the way are kept, up to kKeptBytes, so that going backwards decodes a picture at
// most twice, if its group fits.
#include "video/libav_video.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "io/image_codecs.hpp"
#include "io/input_error.hpp"

namespace textslam {
namespace {

constexpr std::size_t kKeptBytes = std::size_t(1) << 27;
constexpr int kMaxErrors = 1000;  // in a row: a decoder that goes on failing has ended

struct Free {
  void operator()(AVFormatContext* p) const { avformat_close_input(&p); }
  void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
  void operator()(AVFrame* p) const { av_frame_free(&p); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(SwsContext* p) const { sws_freeContext(p); }
};
template <class T>
using Owned = std::unique_ptr<T, Free>;

std::string reason(int error) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(error, text, sizeof text);
  return text;
}

// `image`, of so many bytes a pixel, rotated clockwise by multiples of 90 degrees.
Image<std::uint8_t> turned(const Image<std::uint8_t>& image, int channels, int quarters) {
  if (quarters == 0) return image;
  const int w = image.width() / channels, h = image.height();
  Image<std::uint8_t> out(channels * (quarters == 2 ? w : h), quarters == 2 ? h : w, 0);
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const int X = quarters == 1 ? h - 1 - y : quarters == 2 ? w - 1 - x : y;
      const int Y = quarters == 1 ? x : quarters == 2 ? h - 1 - y : w - 1 - x;
      std::copy_n(&image(channels * x, y), channels, &out(channels * X, Y));
    }
  }
  return out;
}

class LibavVideo final : public VideoFile {
 public:
  explicit LibavVideo(const std::string& path) : path_(path), packet_(av_packet_alloc()), frame_(av_frame_alloc()) {
    if (!packet_ || !frame_) throw std::bad_alloc();
    av_log_set_level(AV_LOG_QUIET);  // our own message says what matters
    open();
    while (next_picture()) {
      const std::int64_t stamp = frame_->best_effort_timestamp;
      if (stamp != AV_NOPTS_VALUE && (stamps_.empty() || stamp > stamps_.back())) stamps_.push_back(stamp);
    }
    if (stamps_.empty()) throw InputError(path_, 0, "the video has no frame that decodes");
    damaged_of_file_ = damaged_;
    for (const std::int64_t stamp : stamps_)
      times_.push_back(static_cast<double>(stamp - stamps_.front()) * av_q2d(stream_->time_base));
    open();
  }

  const std::vector<double>& times() const override { return times_; }

  std::size_t damaged() const override { return damaged_of_file_; }

  Image<std::uint8_t> load(std::size_t index) override { return picture(index).grey; }

  Image<std::uint8_t> load_colour(std::size_t index) override {
    with_colour_ = true;
    return picture(index).colour;
  }

 private:
  struct Picture {
    std::size_t index;
    Image<std::uint8_t> grey, colour;  // colour since it was first asked for
  };

  const Picture& picture(std::size_t index) {
    for (const Picture& kept : kept_) {
      if (kept.index == index && (!with_colour_ || kept.colour.width() > 0)) return kept;
    }
    const bool ahead = position_ == 0 || stamps_.at(index) > stamps_[position_ - 1];
    if (!ahead) seek(stamps_[index]);
    if (advance_to(index)) return kept_.back();
    // The seek landed after the frame.
    open();
    if (advance_to(index)) return kept_.back();
    throw InputError(path_, 0, "frame " + std::to_string(index) + " does not decode");
  }

  // Opens the file again, with the decoder before its first frame.
  void open() {
    grey_scaler_.reset();
    colour_scaler_.reset();
    decoder_.reset();
    format_.reset();
    AVFormatContext* format = nullptr;
    AVDictionary* options = nullptr;
    av_dict_set(&options, "protocol_whitelist", "file", 0);  // a playlist must not use the network
    const int opened = avformat_open_input(&format, ("file:" + path_).c_str(), nullptr, &options);
    av_dict_free(&options);
    if (opened < 0) throw InputError(path_, 0, "this is not a folder, nor a video: " + reason(opened));
    format_.reset(format);
    // These demuxers accept any text, or a single image, as a video.
    const std::string kind = format->iformat->name;
    if (kind == "tty" || kind == "image2" || kind.find("_pipe") != std::string::npos)
      throw InputError(path_, 0, "this is not a folder, nor a video");
    const AVCodec* codec = nullptr;
    if (avformat_find_stream_info(format, nullptr) < 0) throw InputError(path_, 0, "the video has no known format");
    const int number = av_find_best_stream(format, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
    if (number < 0) throw InputError(path_, 0, "there is no video in it that this build decodes");
    stream_ = format->streams[number];
    decoder_.reset(avcodec_alloc_context3(codec));
    if (!decoder_ || avcodec_parameters_to_context(decoder_.get(), stream_->codecpar) < 0) throw std::bad_alloc();
    decoder_->pkt_timebase = stream_->time_base;
    decoder_->thread_count = 0;
    const int ready = avcodec_open2(decoder_.get(), codec, nullptr);
    if (ready < 0) throw InputError(path_, 0, "the video's decoder does not start: " + reason(ready));
    quarters_ = rotation();
    restart();
  }

  void restart() {
    position_ = 0;
    drained_ = false;
  }

  // Phones store the raw picture of the sensor and, beside it, its rotation.
  int rotation() const {
    const std::uint8_t* matrix = av_stream_get_side_data(stream_, AV_PKT_DATA_DISPLAYMATRIX, nullptr);
    if (!matrix) return 0;
    const double degrees = av_display_rotation_get(reinterpret_cast<const std::int32_t*>(matrix));
    if (!std::isfinite(degrees)) return 0;
    const int quarters = static_cast<int>(std::lround(-degrees / 90));
    return ((quarters % 4) + 4) % 4;
  }

  void seek(std::int64_t stamp) {
    if (av_seek_frame(format_.get(), stream_->index, stamp, AVSEEK_FLAG_BACKWARD) < 0) return open();
    avcodec_flush_buffers(decoder_.get());
    restart();
  }

  // Decodes the next picture into frame_; false at the end. Damaged pictures are skipped.
  bool next_picture() {
    for (int errors = 0; errors < kMaxErrors;) {
      const int got = avcodec_receive_frame(decoder_.get(), frame_.get());
      if (got == 0 && frame_->decode_error_flags == 0 && (frame_->flags & AV_FRAME_FLAG_CORRUPT) == 0) return true;
      if (got == AVERROR_EOF || (got == AVERROR(EAGAIN) && drained_)) return false;
      if (got == AVERROR(EAGAIN)) {
        send_packet();
        continue;
      }
      ++damaged_;
      errors = got == 0 ? 0 : errors + 1;
    }
    return false;
  }

  // Sends the next packet of the video to the decoder; at the end of the file, the request to flush.
  void send_packet() {
    while (av_read_frame(format_.get(), packet_.get()) >= 0) {
      const bool ours = packet_->stream_index == stream_->index;
      // A broken packet gives no picture: some decoders say so here, others when the picture is asked for.
      if (ours && avcodec_send_packet(decoder_.get(), packet_.get()) < 0) ++damaged_;
      av_packet_unref(packet_.get());
      if (ours) return;
    }
    drained_ = true;
    avcodec_send_packet(decoder_.get(), nullptr);
  }

  // Decodes up to frame `index`, then the last one kept. False if the decoder is already past it, or it does not come.
  bool advance_to(std::size_t index) {
    while (next_picture()) {
      const std::int64_t stamp = frame_->best_effort_timestamp;
      const auto found = std::lower_bound(stamps_.begin(), stamps_.end(), stamp);
      if (found == stamps_.end() || *found != stamp) continue;
      const auto at = static_cast<std::size_t>(found - stamps_.begin());
      position_ = at + 1;
      if (at > index) return false;
      keep({at, pixels(AV_PIX_FMT_GRAY8, 1, grey_scaler_),
            with_colour_ ? pixels(AV_PIX_FMT_BGR24, 3, colour_scaler_) : Image<std::uint8_t>()});
      if (at == index) return true;
    }
    return false;
  }

  void keep(Picture picture) {
    const auto wide = static_cast<std::size_t>(picture.grey.width() + picture.colour.width());
    const std::size_t most = std::max<std::size_t>(kKeptBytes / (wide * std::size_t(picture.grey.height())), 2);
    kept_.push_back(std::move(picture));
    while (kept_.size() > most) kept_.pop_front();
  }

  // The picture in frame_, upright.
  Image<std::uint8_t> pixels(AVPixelFormat format, int channels, Owned<SwsContext>& scaler) {
    const int w = frame_->width, h = frame_->height;
    check_image_size(static_cast<std::size_t>(w), static_cast<std::size_t>(h), path_);
    scaler.reset(sws_getCachedContext(scaler.release(), w, h, static_cast<AVPixelFormat>(frame_->format), w, h, format,
                                      SWS_BILINEAR | SWS_ACCURATE_RND, nullptr, nullptr, nullptr));
    if (!scaler) throw InputError(path_, 0, "the video's pixels are of a kind that cannot be made grey or coloured");
    // libswscale may write past the end of a row, up to its alignment.
    const int stride = (channels * w + 63) / 64 * 64;
    std::vector<std::uint8_t> rows(static_cast<std::size_t>(stride) * static_cast<std::size_t>(h) + 64);
    std::uint8_t* const planes[1] = {rows.data()};
    const int strides[1] = {stride};
    sws_scale(scaler.get(), frame_->data, frame_->linesize, 0, h, planes, strides);
    Image<std::uint8_t> image(channels * w, h, 0);
    for (int y = 0; y < h; ++y)
      std::copy_n(rows.data() + static_cast<std::ptrdiff_t>(y) * stride, channels * w, &image(0, y));
    return turned(image, channels, quarters_);
  }

  std::string path_;
  Owned<AVPacket> packet_;
  Owned<AVFrame> frame_;
  Owned<AVFormatContext> format_;
  Owned<AVCodecContext> decoder_;
  Owned<SwsContext> grey_scaler_, colour_scaler_;
  AVStream* stream_ = nullptr;
  int quarters_ = 0;          // clockwise turns of 90 degrees that make the picture upright
  std::size_t position_ = 0;  // one past the last frame that came from the decoder; 0 after a restart
  bool drained_ = false;      // the decoder has received the last packet
  std::vector<std::int64_t> stamps_;
  std::vector<double> times_;
  std::size_t damaged_ = 0, damaged_of_file_ = 0;  // pictures, also those decoded again; once through the file
  bool with_colour_ = false;
  std::deque<Picture> kept_;
};

}  // namespace

std::unique_ptr<VideoFile> open_libav_video(const std::string& path) { return std::make_unique<LibavVideo>(path); }

}  // namespace textslam
