// SPDX-License-Identifier: MIT
// The HDF5 form of a ParameterTrack: full precision, for numpy, MATLAB and R.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "core/check.h"
#include "core/file_io.h"
#include "core/hdf5_file.h"
#include "core/parameter_track.h"
#include "core/parameter_units.h"
#include "core/version.h"

namespace articap {
namespace {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Degrees lose the last eight bits of their mantissa (a relative 1e-14), so that they come out the
// same after a way to radians and back, and files with them.
double RoundedDegrees(double value) {
  constexpr int kBitsKept = 44;
  if (!std::isfinite(value)) return value;
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::round(std::ldexp(mantissa, kBitsKept)), exponent - kBitsKept);
}

RowMajorMatrix InFileUnits(const Eigen::MatrixXd& table, const std::vector<std::string>& units) {
  RowMajorMatrix in_file = table;
  for (int i = 0; i < table.cols(); ++i) {
    const double factor = FileUnitOf(units[i]).in_file_per_value;
    if (factor == 1) continue;
    for (int frame = 0; frame < table.rows(); ++frame)
      in_file(frame, i) = RoundedDegrees(factor * table(frame, i));
  }
  return in_file;
}

void WriteTable(hid_t file, const char* name, const Eigen::MatrixXd& table,
                const ParameterTrack& track) {
  const RowMajorMatrix in_file = InFileUnits(table, track.units);
  std::vector<std::string> units;
  for (const std::string& unit : track.units) units.push_back(FileUnitOf(unit).name);
  const hdf5::Handle dataset = hdf5::WriteDataset(
      file, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
      {static_cast<hsize_t>(table.rows()), static_cast<hsize_t>(table.cols())}, in_file.data());
  hdf5::WriteStringAttribute(dataset.get(), "names", track.names);
  hdf5::WriteStringAttribute(dataset.get(), "units", units);
}

void WriteFrames(hid_t file, const ParameterTrack& track) {
  const std::vector<hsize_t> shape = {static_cast<hsize_t>(track.num_frames())};
  std::vector<double> times_s;
  std::vector<std::int64_t> frames;
  std::vector<std::uint8_t> codes;
  for (int frame = 0; frame < track.num_frames(); ++frame) {
    times_s.push_back(SecondsOf(TimeOfFrame(frame, track.rate_hz, track.start)));
    frames.push_back(track.first_frame + frame);
    codes.push_back(static_cast<std::uint8_t>(track.statuses[frame]));
  }
  hdf5::WriteDataset(file, "time_s", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, shape, times_s.data());
  hdf5::WriteDataset(file, "frame", H5T_STD_I64LE, H5T_NATIVE_INT64, shape, frames.data());
  hdf5::WriteDataset(file, "residual_mm", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, shape,
                     track.residuals_mm.data());
  const hdf5::Handle status =
      hdf5::WriteDataset(file, "status", H5T_STD_U8LE, H5T_NATIVE_UINT8, shape, codes.data());
  std::vector<std::string> names;
  for (const FitStatus code : kAllFitStatuses) names.emplace_back(NameOf(code));
  hdf5::WriteStringAttribute(status.get(), "names", names);
}

std::string Hdf5BytesOf(const ParameterTrack& track) {
  const hdf5::QuietLibrary quiet;
  const hdf5::Handle file = hdf5::CreateFileInMemory();
  hdf5::WriteNumberAttribute(file.get(), "rate_hz", track.rate_hz);
  hdf5::WriteStringAttribute(file.get(), "articap_version", kVersion);
  WriteTable(file.get(), "parameters", track.values, track);
  WriteTable(file.get(), "sigmas", track.sigmas, track);
  WriteFrames(file.get(), track);
  if (!track.phones.empty()) hdf5::WriteStrings(file.get(), "phone", track.phones);
  return hdf5::SealedBytesOf(file);
}

// Reading. Every step fails with what it missed; the caller adds the path.

Result<void> ReadNamesAndUnits(hid_t file, ParameterTrack& track, std::vector<double>& factors) {
  const auto names = hdf5::ReadStringAttribute(file, "parameters", "names");
  const auto units = hdf5::ReadStringAttribute(file, "parameters", "units");
  if (!names || !units) return Fail("/parameters has no attributes names and units");
  if (names->size() != units->size())
    return Fail(
        fmt::format("/parameters has {} names, but {} units", names->size(), units->size()));
  for (const std::string& unit : *units) {
    const auto track_unit = TrackUnitOf(unit);
    if (!track_unit) return Fail(fmt::format("the unit '{}' is not known; use deg, mm or 1", unit));
    track.units.push_back(track_unit->name);
    factors.push_back(track_unit->value_per_in_file);
  }
  track.names = *names;
  return {};
}

Result<Eigen::MatrixXd> ReadTable(hid_t file, const char* name, std::size_t num_frames,
                                  const std::vector<double>& factors) {
  const auto shape = hdf5::ShapeOf(file, name);
  if (!shape) return Fail(fmt::format("there is no dataset /{}", name));
  if (shape->size() != 2 || (*shape)[0] != num_frames || (*shape)[1] != factors.size())
    return Fail(
        fmt::format("/{} should be {} frames x {} parameters", name, num_frames, factors.size()));
  const auto numbers = hdf5::ReadNumbers<double>(file, name);
  if (!numbers) return Fail(fmt::format("/{} cannot be read as numbers", name));
  Eigen::MatrixXd table =
      Eigen::Map<const RowMajorMatrix>(numbers->data(), static_cast<Eigen::Index>(num_frames),
                                       static_cast<Eigen::Index>(factors.size()));
  for (std::size_t i = 0; i < factors.size(); ++i)
    table.col(static_cast<Eigen::Index>(i)) *= factors[i];
  return table;
}

template <class Number>
Result<std::vector<Number>> ReadColumn(hid_t file, const char* name, std::size_t num_frames) {
  auto numbers = hdf5::ReadNumbers<Number>(file, name);
  if (!numbers) return Fail(fmt::format("/{} is missing or cannot be read as numbers", name));
  if (numbers->size() != num_frames)
    return Fail(
        fmt::format("/{} holds {} values for {} frames", name, numbers->size(), num_frames));
  return std::move(*numbers);
}

Result<void> ReadTimes(hid_t file, std::size_t num_frames, ParameterTrack& track) {
  const auto rate_hz = hdf5::ReadNumberAttribute(file, "rate_hz");
  if (!rate_hz || !std::isfinite(*rate_hz) || *rate_hz <= 0)
    return Fail("the attribute rate_hz is missing or no rate");
  track.rate_hz = *rate_hz;
  const auto frames = ReadColumn<std::int64_t>(file, "frame", num_frames);
  if (!frames) return tl::unexpected(frames.error());
  const auto times_s = ReadColumn<double>(file, "time_s", num_frames);
  if (!times_s) return tl::unexpected(times_s.error());
  if (num_frames == 0) return {};

  constexpr double kLongestSeconds = 4e9;  // int64 nanoseconds, with room to add
  const double start_s = times_s->front();
  if (!(std::abs(start_s) < kLongestSeconds) ||
      !(static_cast<double>(num_frames) / *rate_hz < kLongestSeconds))
    return Fail("/time_s begins at no possible time");
  track.start = SessionTimeFromSeconds(start_s);
  const std::int64_t first = frames->front();
  if (first < std::numeric_limits<int>::min() ||
      first > std::numeric_limits<int>::max() - static_cast<std::int64_t>(num_frames))
    return Fail(fmt::format("/frame begins at {}", first));
  track.first_frame = static_cast<int>(first);
  for (std::size_t i = 0; i < num_frames; ++i) {
    if ((*frames)[i] != first + static_cast<std::int64_t>(i))
      return Fail(fmt::format("/frame[{}] is {}; frames must follow one another", i, (*frames)[i]));
    const double expected_s =
        SecondsOf(TimeOfFrame(static_cast<std::int64_t>(i), track.rate_hz, track.start));
    if (!(std::abs((*times_s)[i] - expected_s) <= 0.1 / track.rate_hz))
      return Fail(fmt::format("/time_s[{}] is {} s, at odds with the rate of {} Hz", i,
                              (*times_s)[i], track.rate_hz));
  }
  return {};
}

Result<void> ReadStatuses(hid_t file, std::size_t num_frames, ParameterTrack& track) {
  const auto codes = ReadColumn<std::int64_t>(file, "status", num_frames);
  if (!codes) return tl::unexpected(codes.error());
  const auto names = hdf5::ReadStringAttribute(file, "status", "names");
  if (!names) return Fail("/status has no attribute names");
  for (const std::int64_t code : *codes) {
    const bool is_named = code >= 0 && code < static_cast<std::int64_t>(names->size());
    const auto status =
        is_named ? FitStatusNamed((*names)[static_cast<std::size_t>(code)]) : std::nullopt;
    if (!status) return Fail(fmt::format("/status holds the code {}, which has no meaning", code));
    track.statuses.push_back(*status);
  }
  return {};
}

Result<ParameterTrack> ReadTrack(hid_t file) {
  const auto shape = hdf5::ShapeOf(file, "parameters");
  if (!shape || shape->size() != 2)
    return Fail("there is no dataset /parameters; is it a file that articap fit wrote?");
  const std::size_t num_frames = static_cast<std::size_t>((*shape)[0]);
  ParameterTrack track;
  std::vector<double> factors;
  if (const auto read = ReadNamesAndUnits(file, track, factors); !read)
    return tl::unexpected(read.error());
  auto values = ReadTable(file, "parameters", num_frames, factors);
  if (!values) return tl::unexpected(values.error());
  auto sigmas = ReadTable(file, "sigmas", num_frames, factors);
  if (!sigmas) return tl::unexpected(sigmas.error());
  if (const auto read = ReadTimes(file, num_frames, track); !read)
    return tl::unexpected(read.error());
  if (const auto read = ReadStatuses(file, num_frames, track); !read)
    return tl::unexpected(read.error());
  auto residuals_mm = ReadColumn<double>(file, "residual_mm", num_frames);
  if (!residuals_mm) return tl::unexpected(residuals_mm.error());
  if (hdf5::ShapeOf(file, "phone")) {
    auto phones = hdf5::ReadStrings(file, "phone");
    if (!phones || phones->size() != num_frames)
      return Fail("/phone is not a text for every frame");
    track.phones = std::move(*phones);
  }
  track.values = std::move(*values);
  track.sigmas = std::move(*sigmas);
  track.residuals_mm = std::move(*residuals_mm);
  return track;
}

}  // namespace

Result<void> WriteParameterHdf5(const ParameterTrack& track, const std::filesystem::path& path) {
  CheckSizes(track);
  return WriteFile(path, Hdf5BytesOf(track));
}

Result<ParameterTrack> ReadParameterHdf5(const std::filesystem::path& path) {
  const auto bytes = ReadFile(path);
  if (!bytes) return tl::unexpected(bytes.error());
  if (!hdf5::IsSealed(*bytes))
    return Fail(fmt::format(
        "{}: is not an HDF5 file of articap ({} bytes); name the parameters.h5 that articap fit "
        "wrote, or a parameters.csv",
        path.string(), bytes->size()));
  if (!hdf5::SealHolds(*bytes))
    return Fail(fmt::format(
        "{}: is cut short, damaged, or was changed by another program: its checksum is not that of "
        "its {} bytes; fit again, or write the changes as CSV",
        path.string(), bytes->size()));
  const hdf5::QuietLibrary quiet;
  const hdf5::Handle file = hdf5::OpenFileInMemory(*bytes);
  if (!file.is_valid()) return Fail(fmt::format("{}: is not an HDF5 file", path.string()));
  auto track = ReadTrack(file.get());
  if (!track) return Fail(fmt::format("{}: {}", path.string(), track.error().message));
  return track;
}

}  // namespace articap
