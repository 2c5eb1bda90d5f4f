// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/io/calibration_keys.h"
#include "core/io/camera_formats.h"
#include "core/io/camera_parts.h"
#include "core/toml_reader.h"

// calibration.toml of articap, the same layout as others write it, and Caliscope's files.
namespace articap {
namespace {

struct CameraTable {
  std::string key;
  const toml::table* table = nullptr;
};

// One table of a camera, whatever wrote it; the first fault stays.
class CameraTableReader {
 public:
  CameraTableReader(const TomlReader& table, const CameraReadOptions& options, std::string where)
      : table_(table), options_(options), where_(std::move(where)) {}

  Result<Camera> Read(const std::string& name) const {
    Camera camera;
    camera.name = name;
    if (auto read = ReadFisheye(); !read) return tl::unexpected(read.error());
    if (auto read = ReadSize(camera); !read) return tl::unexpected(read.error());
    if (auto read = ReadLens(camera); !read) return tl::unexpected(read.error());
    if (auto read = ReadPose(camera); !read) return tl::unexpected(read.error());
    camera.time_offset_s = table_.Number("time_offset_s", 0.0);
    return camera;
  }

 private:
  Result<void> ReadFisheye() const {
    const toml::node* node = table_.table().get("fisheye");
    if (!node || node->value<bool>() == false) return {};
    if (node->value<bool>() == true)
      return Fail(where_ +
                  ": is a fisheye camera, which articap does not support; calibrate it as "
                  "a pinhole with a rational model (8 coefficients)");
    return Fail(where_ + ": 'fisheye' is neither true nor false");
  }

  Result<void> ReadSize(Camera& camera) const {
    const std::vector<double> size = table_.Numbers("size");
    if (!size.empty() && size.size() != 2)
      return Fail(where_ + ": 'size' is not a width and a height");
    // Read as it stands: a size of [0, 0] is none.
    if (size.size() == 2) return SetSize(size[0], size[1], options_, where_, camera);
    return SetSize(0, 0, options_, where_, camera);
  }

  Result<void> ReadLens(Camera& camera) const {
    const auto matrix = ReadMatrix("matrix");
    if (!matrix) return tl::unexpected(matrix.error());
    const auto lens = LensFromMatrix(*matrix, where_);
    if (!lens) return tl::unexpected(lens.error());
    camera.lens = *lens;
    if (!table_.Has("distortions")) return Fail(where_ + ": 'distortions' is missing");
    return SetDistortion(table_.Numbers("distortions"), where_, camera.lens);
  }

  Result<void> ReadPose(Camera& camera) const {
    if (!table_.Has("rotation") && !table_.Has("translation")) return {};
    const toml::node* rotation = table_.table().get("rotation");
    const toml::array* rows = rotation ? rotation->as_array() : nullptr;
    const bool is_matrix = rows && !rows->empty() && rows->get(0)->is_array();
    const auto read =
        is_matrix ? ReadRotationMatrix() : RotationFromVector(table_.Vector("rotation"), where_);
    if (!read) return tl::unexpected(read.error());
    camera.cam_from_stage = {*read, table_.Vector("translation")};
    return {};
  }

  Result<Eigen::Quaterniond> ReadRotationMatrix() const {
    const auto matrix = ReadMatrix("rotation");
    if (!matrix) return tl::unexpected(matrix.error());
    return RotationFromMatrix(*matrix, where_);
  }

  Result<Eigen::Matrix3d> ReadMatrix(std::string_view key) const {
    const toml::node* node = table_.table().get(key);
    const toml::array* rows = node ? node->as_array() : nullptr;
    Eigen::Matrix3d matrix;
    bool is_matrix = rows && rows->size() == 3;
    for (int row = 0; is_matrix && row < 3; ++row) {
      const toml::array* numbers = rows->get(static_cast<std::size_t>(row))->as_array();
      is_matrix = numbers && numbers->size() == 3;
      for (int column = 0; is_matrix && column < 3; ++column) {
        const auto number = numbers->get(static_cast<std::size_t>(column))->value<double>();
        is_matrix = number.has_value();
        matrix(row, column) = number.value_or(0.0);
      }
    }
    if (!is_matrix)
      return Fail(fmt::format("{}: '{}' is not three rows of three numbers", where_, key));
    return matrix;
  }

  const TomlReader& table_;
  const CameraReadOptions& options_;
  std::string where_;
};

// A whole file.
class CalibrationReader {
 public:
  CalibrationReader(const toml::table& document, std::string source_name,
                    const CameraReadOptions& options)
      : document_(document), source_name_(std::move(source_name)), options_(options) {}

  Result<CameraReading> Read() {
    reading_.format = FindFormat();
    for (const CameraTable& table : FindCameras())
      if (auto read = ReadCamera(table); !read) return tl::unexpected(read.error());
    if (auto read = ReadMetadata(); !read) return tl::unexpected(read.error());
    if (fault_) return tl::unexpected(*fault_);
    NameUnknownKeys();
    if (auto checked = CheckPoses(); !checked) return tl::unexpected(checked.error());
    if (auto converted = ConvertToMm(unit_, options_, source_name_, reading_); !converted)
      return tl::unexpected(converted.error());
    if (auto checked = CheckCameras(reading_.array, source_name_); !checked)
      return tl::unexpected(checked.error());
    return std::move(reading_);
  }

 private:
  CameraFormat FindFormat() {
    if (document_["metadata"]["layout"].value<std::string>()) return CameraFormat::kArticap;
    const bool is_caliscope = document_["cameras"].is_table() ||
                              std::any_of(document_.begin(), document_.end(), [](const auto& item) {
                                const toml::table* table = item.second.as_table();
                                return table && table->contains("rotation_count");
                              });
    return is_caliscope ? CameraFormat::kCaliscope : CameraFormat::kAniposelib;
  }

  // In the order of the file. Every table with a matrix or a size is a camera; Caliscope's newer
  // files have them in [cameras], and its older ones have tables of other things between them.
  std::vector<CameraTable> FindCameras() {
    const toml::table* parent = document_["cameras"].as_table();
    if (reading_.format != CameraFormat::kCaliscope || !parent) parent = &document_;
    std::vector<CameraTable> cameras;
    for (const auto& [key, node] : *parent) {
      const toml::table* table = node.as_table();
      if (table && key.str() != "metadata" &&
          (table->contains("matrix") || table->contains("size")))
        cameras.push_back({std::string(key.str()), table});
      else if (key.str() != "metadata" && reading_.format == CameraFormat::kArticap)
        fault_ = Error{fmt::format("{}: '{}' is no table of a camera", source_name_, key.str())};
      else if (key.str() != "metadata")
        unknown_keys_.insert(std::string(key.str()));
    }
    std::sort(cameras.begin(), cameras.end(), [](const CameraTable& a, const CameraTable& b) {
      return a.table->source().begin < b.table->source().begin;
    });
    return cameras;
  }

  Result<void> ReadCamera(const CameraTable& found) {
    const TomlReader table(*found.table, fmt::format("{}, {}", source_name_, found.key), fault_);
    const std::string name = table.Text("name", NameFor(found.key));
    if (reading_.format == CameraFormat::kCaliscope && IsLeftOut(table, name)) return {};
    const std::string where = fmt::format("{}, {} ('{}')", source_name_, found.key, name);
    auto camera = CameraTableReader(table, options_, where).Read(name);
    if (fault_) return tl::unexpected(*fault_);
    if (!camera) return tl::unexpected(camera.error());
    ReadRegion(table, camera->region);
    ReadSigmas(table, *camera);
    if (!table.Has("rotation")) without_pose_.push_back(name);
    CheckKeys(table);
    reading_.array.cameras.push_back(std::move(*camera));
    return {};
  }

  // Caliscope numbers its cameras; its own aniposelib files call them cam_0, cam_1, ...
  std::string NameFor(const std::string& key) const {
    return key.starts_with("cam") ? key : "cam_" + key;
  }

  bool IsLeftOut(const TomlReader& table, const std::string& name) {
    const bool is_ignored = table.table()["ignore"].value_or(false);
    if (!is_ignored && table.Has("matrix") && table.Has("rotation")) {
      if (table.table()["rotation_count"].value_or(0) != 0)
        reading_.warnings.push_back(fmt::format(
            "camera '{}' is shown turned by Caliscope (rotation_count); its calibration is taken "
            "to be of the pictures as they were recorded",
            name));
      return false;
    }
    reading_.warnings.push_back(
        fmt::format("camera '{}' is left out: it {}", name,
                    is_ignored ? "is marked as ignored" : "has not been calibrated or placed"));
    return true;
  }

  void ReadRegion(const TomlReader& table, std::optional<PictureRegion>& region) {
    if (!table.Has("region")) return;
    const Result<PictureRegion> read = ParsePictureRegion(table.Text("region"));
    if (read)
      region = *read;
    else
      table.Fault("region", read.error().message);
  }

  void ReadSigmas(const TomlReader& table, Camera& camera) {
    const auto sigmas = table.Table("sigmas");
    if (!sigmas) return;
    std::set<std::string> known;
    for (const auto& [key, sigma] : KeyedSigmas(camera.sigmas)) {
      *sigma = sigmas->Number(key, CameraSigmas::kUnknown);
      known.insert(key);
    }
    for (const auto& [key, node] : sigmas->table())
      if (!known.contains(std::string(key.str()))) sigmas->Fault(key.str(), "is no known sigma");
  }

  void CheckKeys(const TomlReader& table) {
    const std::initializer_list<std::string_view> known = {
        "name",        "size",    "matrix",        "distortions", "rotation",
        "translation", "fisheye", "time_offset_s", "sigmas",      "region"};
    if (reading_.format == CameraFormat::kArticap) return table.AllowOnly(known);
    // Caliscope's numbers of cameras, and what IsLeftOut() has seen to.
    const std::set<std::string_view> used = {"cam_id", "port", "rotation_count", "ignore"};
    for (const auto& [key, node] : table.table())
      if (std::find(known.begin(), known.end(), key.str()) == known.end() &&
          !(reading_.format == CameraFormat::kCaliscope && used.contains(key.str())))
        unknown_keys_.insert(std::string(key.str()));
  }

  Result<void> ReadMetadata() {
    if (reading_.format == CameraFormat::kCaliscope) unit_ = "m";
    const auto metadata = TomlReader(document_, source_name_, fault_).Table("metadata");
    if (!metadata) return {};
    if (reading_.format != CameraFormat::kArticap) {
      for (const auto& [key, node] : metadata->table())
        unknown_keys_.insert(fmt::format("metadata.{}", key.str()));
      return {};
    }
    if (const std::string layout = metadata->Text("layout"); layout != kCalibrationLayout)
      return Fail(
          fmt::format("{}: its layout is '{}', and this articap knows '{}' alone; is it of "
                      "a newer one?",
                      source_name_, layout, kCalibrationLayout));
    unit_ = metadata->Text("unit");
    reading_.array.source = metadata->Text("source", "");
    return ReadMirrors(*metadata);
  }

  Result<void> ReadMirrors(const TomlReader& metadata) {
    std::vector<CameraTable> mirrors;
    for (const auto& [key, node] : metadata.table())
      if (key.str().starts_with("mirror_") && node.is_table())
        mirrors.push_back({std::string(key.str()), node.as_table()});
      else if (key.str() != "layout" && key.str() != "unit" && key.str() != "source" &&
               key.str() != "adjusted" && key.str() != "error")
        metadata.Fault(key.str(),
                       "is no key that belongs here; there are layout, unit, source "
                       "and the tables mirror_0, mirror_1, ...");
    std::sort(mirrors.begin(), mirrors.end(), [](const CameraTable& a, const CameraTable& b) {
      return a.table->source().begin < b.table->source().begin;
    });
    for (const CameraTable& mirror : mirrors)
      if (auto read = ReadMirror(mirror); !read) return read;
    return {};
  }

  Result<void> ReadMirror(const CameraTable& found) {
    const std::string where = fmt::format("{}, metadata.{}", source_name_, found.key);
    const TomlReader table(*found.table, where, fault_);
    table.AllowOnly({"name", "camera", "normal", "distance_mm", "glass_mm", "glass_index", "region",
                     "normal_sigma_rad", "distance_sigma_mm"});
    Mirror mirror;
    mirror.name = table.Text("name");
    const std::string camera = table.Text("camera");
    mirror.normal_in_stage = table.Vector("normal");
    mirror.distance_mm = table.Number("distance_mm");
    mirror.glass_mm = table.Number("glass_mm", mirror.glass_mm);
    mirror.glass_index = table.Number("glass_index", mirror.glass_index);
    ReadRegion(table, mirror.region);
    mirror.normal_sigma_rad = table.Number("normal_sigma_rad", mirror.normal_sigma_rad);
    mirror.distance_sigma_mm = table.Number("distance_sigma_mm", mirror.distance_sigma_mm);
    if (fault_) return tl::unexpected(*fault_);
    const auto& cameras = reading_.array.cameras;
    const auto owner = std::find_if(cameras.begin(), cameras.end(), [&](const Camera& candidate) {
      return candidate.name == camera;
    });
    if (owner == cameras.end())
      return Fail(fmt::format("{}: there is no camera '{}'", where, camera));
    mirror.camera = static_cast<int>(owner - cameras.begin());
    if (auto checked = Normalize(mirror.normal_in_stage, where); !checked) return checked;
    reading_.array.mirrors.push_back(std::move(mirror));
    return {};
  }

  // A normal that is as good as one long keeps its digits, so that it is written as it was read.
  static Result<void> Normalize(Eigen::Vector3d& normal, const std::string& where) {
    constexpr double kSame = 1e-13, kTyped = 1e-3;
    const double error = std::abs(normal.norm() - 1);
    if (!(error <= kTyped))
      return Fail(fmt::format("{}: the normal ({}, {}, {}) is not one long", where, normal.x(),
                              normal.y(), normal.z()));
    if (error > kSame) normal.normalize();
    return {};
  }

  void NameUnknownKeys() {
    if (!unknown_keys_.empty())
      reading_.warnings.push_back(
          fmt::format("not taken over: {}", fmt::join(unknown_keys_, ", ")));
  }

  Result<void> CheckPoses() {
    if (without_pose_.empty()) return {};
    if (reading_.array.cameras.size() > 1)
      return Fail(
          fmt::format("{}: camera '{}' has no rotation and translation, so that nobody "
                      "knows where it stands beside the others",
                      source_name_, without_pose_.front()));
    reading_.warnings.push_back("the camera has no pose: its own frame is taken as the stage");
    return {};
  }

  const toml::table& document_;
  std::string source_name_;
  const CameraReadOptions& options_;
  std::optional<Error> fault_;
  std::string unit_;
  std::vector<std::string> without_pose_;
  std::set<std::string> unknown_keys_;
  CameraReading reading_;
};

}  // namespace

Result<CameraReading> ReadCameraToml(const std::string& text, const std::string& source_name,
                                     const CameraReadOptions& options) {
  const auto document = ParseToml(text, source_name);
  if (!document) return tl::unexpected(document.error());
  return CalibrationReader(*document, source_name, options).Read();
}

}  // namespace articap
