// SPDX-License-Identifier: MIT
#include "capture/frame_pixels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string_view>

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/imgutils.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace articap::libav {
namespace {

// A frame that shares the pixels of another: all rows, or every second.
struct FrameView {
  FrameView(const AVFrame& frame, Rows rows) {
    view.format = frame.format;
    view.width = frame.width;
    view.height = frame.height;
    view.color_range = frame.color_range;
    view.colorspace = frame.colorspace;
    const int step = rows == Rows::kAll ? 1 : 2;
    const int first = rows == Rows::kBottom ? 1 : 0;
    view.height = (frame.height - first + step - 1) / step;
    const AVPixFmtDescriptor* const format =
        av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
    for (int plane = 0; plane < AV_NUM_DATA_POINTERS; ++plane) {
      if (frame.data[plane] == nullptr) continue;
      const bool is_palette = plane == 1 && (format->flags & AV_PIX_FMT_FLAG_PAL) != 0;
      view.data[plane] =
          frame.data[plane] + (is_palette ? 0 : std::ptrdiff_t{first} * frame.linesize[plane]);
      view.linesize[plane] = step * frame.linesize[plane];
    }
  }
  AVFrame view{};
};

// Whose first component is the luma, in whole bytes.
bool HasLuma(const AVPixFmtDescriptor& format) {
  constexpr std::uint64_t kOther = AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL |
                                   AV_PIX_FMT_FLAG_BITSTREAM | AV_PIX_FMT_FLAG_FLOAT |
                                   AV_PIX_FMT_FLAG_BAYER | AV_PIX_FMT_FLAG_HWACCEL;
  return (format.flags & kOther) == 0;
}

// The plane may be shown as it is.
bool IsPlain(const AVComponentDescriptor& luma, std::uint64_t flags) {
  if (luma.offset != 0 || luma.shift != 0) return false;
  const bool is_big_endian = (flags & AV_PIX_FMT_FLAG_BE) != 0;
  return (luma.depth == 8 && luma.step == 1) ||
         (luma.depth == 16 && luma.step == 2 &&
          is_big_endian == (std::endian::native == std::endian::big));
}

// To the full range of 16 bits: the bits are repeated, so that the largest value becomes 65535.
std::uint16_t Widen(unsigned value, int depth) {
  const unsigned high = value << (16 - depth);
  return static_cast<std::uint16_t>(high | high >> depth);
}

template <class Pixel>
void CopyTurned(const ImageView& from, int turns, std::uint8_t* out) {
  const int w = from.width, h = from.height;
  for (int y = 0; y < (turns % 2 == 0 ? h : w); ++y)
    for (int x = 0; x < (turns % 2 == 0 ? w : h); ++x, out += sizeof(Pixel)) {
      const int from_x = turns == 1 ? y : turns == 2 ? w - 1 - x : w - 1 - y;
      const int from_y = turns == 1 ? h - 1 - x : turns == 2 ? h - 1 - y : x;
      std::memcpy(out, from.row(from_y) + from_x * std::ptrdiff_t{sizeof(Pixel)}, sizeof(Pixel));
    }
}

// Whether black is 0: grey pictures and JPEG always are so, without saying it.
bool HasFullRange(const AVFrame& frame) {
  const AVPixFmtDescriptor& format = *av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
  const bool is_gray = format.nb_components < 3;
  return frame.color_range == AVCOL_RANGE_JPEG || is_gray ||
         std::string_view(format.name).starts_with("yuvj");
}

// By the standard that the frame names, or, where it names none, the one that its size had: high
// definition is BT.709, all else BT.601.
const int* ColorCoefficients(const AVFrame& frame) {
  constexpr int kLeastHighDefinition = 720;
  if (frame.colorspace != AVCOL_SPC_UNSPECIFIED && frame.colorspace != AVCOL_SPC_RGB)
    return sws_getCoefficients(frame.colorspace);
  return sws_getCoefficients(frame.height >= kLeastHighDefinition ? SWS_CS_ITU709 : SWS_CS_ITU601);
}

}  // namespace

ImageView FramePixels::Buffer::Make(PixelFormat format, int width, int height) {
  constexpr std::ptrdiff_t kAlignment = 64;
  const std::ptrdiff_t row = std::ptrdiff_t{width} * BytesPerPixel(format);
  const std::ptrdiff_t stride = (row / kAlignment + 2) * kAlignment;
  bytes.resize(static_cast<std::size_t>(stride * height + kAlignment));
  return {format, width, height, stride, bytes.data()};
}

Result<ImageView> FramePixels::Convert(const AVFrame& frame, Rows rows) {
  const AVPixFmtDescriptor* const format =
      av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
  if (format == nullptr) return Fail("its pixels have no known format");
  const FrameView view(frame, rows);
  if (color_ == PixelColor::kLuma && HasLuma(*format)) return Turn(Luma(view.view));
  const PixelFormat wanted = color_ == PixelColor::kRgb  ? PixelFormat::kRgb8
                             : format->comp[0].depth > 8 ? PixelFormat::kGray16
                                                         : PixelFormat::kGray8;
  const Result<ImageView> scaled = Scale(view.view, wanted);
  if (!scaled) return scaled;
  return Turn(*scaled);
}

ImageView FramePixels::Luma(const AVFrame& frame) {
  const AVPixFmtDescriptor& format = *av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
  const AVComponentDescriptor& luma = format.comp[0];
  const PixelFormat wanted = luma.depth > 8 ? PixelFormat::kGray16 : PixelFormat::kGray8;
  if (IsPlain(luma, format.flags))
    return {wanted, frame.width, frame.height, frame.linesize[luma.plane], frame.data[luma.plane]};
  const ImageView image = converted_.Make(wanted, frame.width, frame.height);
  std::vector<std::uint16_t> row(static_cast<std::size_t>(frame.width));
  const std::array<const std::uint8_t*, 4> data = {frame.data[0], frame.data[1], frame.data[2],
                                                   frame.data[3]};
  for (int y = 0; y < frame.height; ++y) {
    std::uint8_t* const out = converted_.bytes.data() + y * image.stride_bytes;
    std::array<const std::uint8_t*, 4> pointers = data;
    av_read_image_line2(row.data(), pointers.data(), frame.linesize, &format, 0, y, 0, frame.width,
                        0, sizeof(std::uint16_t));
    if (wanted == PixelFormat::kGray16) {
      for (std::uint16_t& value : row) value = Widen(value, luma.depth);
      std::memcpy(out, row.data(), row.size() * sizeof(std::uint16_t));
    } else {
      for (std::size_t x = 0; x < row.size(); ++x)
        out[x] = static_cast<std::uint8_t>(Widen(row[x], luma.depth) >> 8);
    }
  }
  return image;
}

Result<ImageView> FramePixels::Scale(const AVFrame& frame, PixelFormat format) {
  const AVPixelFormat target = format == PixelFormat::kRgb8     ? AV_PIX_FMT_RGB24
                               : format == PixelFormat::kGray16 ? AV_PIX_FMT_GRAY16
                                                                : AV_PIX_FMT_GRAY8;
  const auto source = static_cast<AVPixelFormat>(frame.format);
  scaler_.reset(sws_getCachedContext(
      scaler_.release(), frame.width, frame.height, source, frame.width, frame.height, target,
      SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT, nullptr, nullptr, nullptr));
  if (!scaler_)
    return Fail(
        fmt::format("pixels of the format {} cannot be converted", av_get_pix_fmt_name(source)));
  const int* const coefficients = ColorCoefficients(frame);
  const int full_range = HasFullRange(frame) ? 1 : 0;
  constexpr int kUnit = 1 << 16;  // brightness, contrast and saturation stay
  sws_setColorspaceDetails(scaler_.get(), coefficients, full_range, coefficients, 1, 0, kUnit,
                           kUnit);
  const ImageView image = converted_.Make(format, frame.width, frame.height);
  const std::array<std::uint8_t*, 4> out = {converted_.bytes.data()};
  const std::array<int, 4> strides = {static_cast<int>(image.stride_bytes)};
  const int rows = sws_scale(scaler_.get(), frame.data, frame.linesize, 0, frame.height, out.data(),
                             strides.data());
  if (rows != frame.height) return Fail("its pixels cannot be converted");
  return image;
}

ImageView FramePixels::Turn(const ImageView& image) {
  if (turns_ == 0) return image;
  const bool upright = turns_ == 2;
  // Without gaps between the rows, which CopyTurned() writes one after the other.
  const int width = upright ? image.width : image.height;
  const int height = upright ? image.height : image.width;
  const int bytes = BytesPerPixel(image.format);
  turned_.bytes.resize(static_cast<std::size_t>(width) * height * bytes);
  switch (bytes) {
    case 1:
      CopyTurned<std::uint8_t>(image, turns_, turned_.bytes.data());
      break;
    case 2:
      CopyTurned<std::uint16_t>(image, turns_, turned_.bytes.data());
      break;
    default:
      CopyTurned<std::array<std::uint8_t, 3>>(image, turns_, turned_.bytes.data());
  }
  return {image.format, width, height, std::ptrdiff_t{width} * bytes, turned_.bytes.data()};
}

}  // namespace articap::libav
