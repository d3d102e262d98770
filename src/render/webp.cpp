#include <webp/encode.h>
#include <webp/mux.h>

#include <cmath>
#include <memory>

#include "base/errors.h"
#include "render/moving.h"
#include "render/render.h"

namespace ukemi {
namespace {

// Method 1 of 6: a frame of 640 x 360 in 4 ms; the slowest takes 20 times as long for a tenth fewer bytes.
constexpr int kQuickMethod = 1;
constexpr int kStillQuickMethod = 0;
constexpr int kThoroughMethod = 4;

Error failed(const std::string& why) {
  return output_error({}, "cannot encode the picture as WebP: " + why, "choose a smaller picture");
}

std::string reason_of(WebPEncodingError error) {
  switch (error) {
    case VP8_ENC_ERROR_OUT_OF_MEMORY:
    case VP8_ENC_ERROR_BITSTREAM_OUT_OF_MEMORY:
      return "out of memory";
    case VP8_ENC_ERROR_BAD_DIMENSION:
      return "more than 16383 pixels wide or high";
    default:
      return "error " + std::to_string(error);
  }
}

WebPConfig config_of(double quality, int method) {
  WebPConfig config;
  WebPConfigInit(&config);
  config.quality = static_cast<float>(quality);
  config.method = method;
  return config;
}

/// A picture as libwebp takes it.
class Import {
 public:
  explicit Import(const Picture& picture) {
    good_ = WebPPictureInit(&picture_) != 0;
    picture_.width = picture.width;
    picture_.height = picture.height;
    good_ = good_ && WebPPictureImportRGBX(&picture_, picture.rgba.data(), 4 * picture.width) != 0;
  }
  ~Import() { WebPPictureFree(&picture_); }
  Import(const Import&) = delete;
  Import& operator=(const Import&) = delete;

  explicit operator bool() const { return good_; }
  WebPPicture* get() { return &picture_; }
  std::string reason() const { return reason_of(picture_.error_code); }

 private:
  WebPPicture picture_;
  bool good_ = false;
};

}  // namespace

Result<std::vector<std::uint8_t>> encode_webp(const Picture& picture, double quality, Effort effort) {
  const WebPConfig config = config_of(quality, effort == Effort::quick ? kStillQuickMethod : kThoroughMethod);
  Import import(picture);
  if (!import) return failed(import.reason());
  WebPMemoryWriter writer;
  WebPMemoryWriterInit(&writer);
  import.get()->writer = WebPMemoryWrite;
  import.get()->custom_ptr = &writer;
  const bool encoded = WebPEncode(&config, import.get()) != 0;
  std::vector<std::uint8_t> bytes;
  if (encoded) bytes.assign(writer.mem, writer.mem + writer.size);
  WebPMemoryWriterClear(&writer);
  if (!encoded) return failed(import.reason());
  return bytes;
}

struct AnimationEncoder::State {
  std::unique_ptr<WebPAnimEncoder, decltype(&WebPAnimEncoderDelete)> encoder{nullptr, WebPAnimEncoderDelete};
  WebPConfig config;
  double fps;
  int frames = 0;

  int time_ms(int frame) const { return static_cast<int>(std::lround(1000.0 * frame / fps)); }
};

AnimationEncoder::AnimationEncoder(int width, int height, double fps, double quality)
    : state_(std::make_unique<State>()) {
  state_->config = config_of(quality, kQuickMethod);
  state_->fps = fps;
  WebPAnimEncoderOptions options;
  WebPAnimEncoderOptionsInit(&options);
  options.anim_params.loop_count = 0;
  state_->encoder.reset(WebPAnimEncoderNew(width, height, &options));
}

AnimationEncoder::~AnimationEncoder() = default;

Status AnimationEncoder::add(const Picture& picture) {
  if (!state_->encoder) return failed("the size is refused");
  Import import(picture);
  if (!import) return failed(import.reason());
  if (!WebPAnimEncoderAdd(state_->encoder.get(), import.get(), state_->time_ms(state_->frames),
                          &state_->config))
    return failed(WebPAnimEncoderGetError(state_->encoder.get()));
  ++state_->frames;
  return Done{};
}

Result<std::vector<std::uint8_t>> AnimationEncoder::finish() {
  if (!state_->encoder || state_->frames == 0) return failed("no frame");
  WebPData data;
  WebPDataInit(&data);
  const bool good =
      WebPAnimEncoderAdd(state_->encoder.get(), nullptr, state_->time_ms(state_->frames), nullptr) &&
      WebPAnimEncoderAssemble(state_->encoder.get(), &data);
  std::vector<std::uint8_t> bytes;
  if (good) bytes.assign(data.bytes, data.bytes + data.size);
  WebPDataClear(&data);
  if (!good) return failed(WebPAnimEncoderGetError(state_->encoder.get()));
  return bytes;
}

}  // namespace ukemi
