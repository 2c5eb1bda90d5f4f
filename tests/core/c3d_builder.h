// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace articap {

// Fabricates C3D files byte by byte, independently of the writer: in every encoding, and wrong
// where a test wants them wrong.
struct C3dBuilder {
  enum class Processor { kIntel = 84, kDec = 85, kMips = 86 };

  struct Parameter {
    std::string group;
    std::string name;
    int type = 2;  // -1 characters, 1 bytes, 2 integers, 4 floats
    std::vector<int> dims;
    std::vector<double> numbers;
    std::string characters;
  };

  struct Point {
    double x = 0;
    double y = 0;
    double z = 0;
    double word = 0;  // cameras * 256 + residual, -1 for not seen
  };

  Processor processor = Processor::kIntel;
  bool is_float = true;
  int num_points = 3;
  int num_frames = 5;
  int first_frame = 1;
  float scale = 0.125F;  // positions of integer files and residuals are multiples of it
  float rate_hz = 100;
  int num_channels = 0;
  int samples_per_frame = 0;
  int parameter_block = 2;
  int blank_blocks_before_data = 0;
  std::vector<Parameter> parameters;
  // Header words (offset in bytes -> value) that differ from what they should be.
  std::map<int, int> header_words;
  std::map<int, float> header_floats;
  std::map<int, std::string> header_texts;

  std::function<Point(int frame, int point)> point = DefaultPoint;
  // Raw numbers of analog channels, as stored.
  std::function<double(int sample, int channel)> analog = [](int sample, int channel) {
    return 10 * sample + channel;
  };

  // POINT:USED, SCALE, RATE, UNITS "mm", DATA_START, FRAMES and LABELS A, B, C, ...
  C3dBuilder();

  // Replaces a parameter, or adds it.
  C3dBuilder& SetNumbers(const std::string& group, const std::string& name, int type,
                         std::vector<double> numbers, std::vector<int> dims = {});
  C3dBuilder& SetText(const std::string& group, const std::string& name, const std::string& text);
  C3dBuilder& SetTexts(const std::string& group, const std::string& name,
                       const std::vector<std::string>& texts, int length = 0);
  C3dBuilder& Remove(const std::string& group, const std::string& name);

  std::string Build() const;
  // Where the samples of the built file begin.
  std::size_t DataOffset() const;

  // Multiples of 1/8, every third sample of the last point missing.
  static Point DefaultPoint(int frame, int point);

 private:
  Parameter& Find(const std::string& group, const std::string& name);
  std::string ParameterSection() const;
  std::string Word(int value) const;
  std::string Float(float value) const;
};

}  // namespace articap
