// SPDX-License-Identifier: MIT
#include "core/parameter_track.h"

#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include "core/file_io.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A track with everything in it that files must carry: angles, lengths, weights, frames without a
// fit, undetermined parameters, odd phone labels.
ParameterTrack MakeTrack(int num_frames, double rate_hz, unsigned seed, bool with_phones = true) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  ParameterTrack track;
  track.names = {"jaw_rotation", "lip_rounding", "smile"};
  track.units = {"rad", "mm", "1"};
  track.rate_hz = rate_hz;
  track.first_frame = 41;
  track.start = TimeOfFrame(40, rate_hz);
  track.values.resize(num_frames, 3);
  track.sigmas.resize(num_frames, 3);
  const FitStatus statuses[] = {FitStatus::kOk, FitStatus::kNoHeadPose, FitStatus::kTooFewMarkers,
                                FitStatus::kNotConverged, FitStatus::kWeak};
  const char* phones[] = {"", "AY1", "\"e:", "a,b", "NA", "\u0283"};
  for (int frame = 0; frame < num_frames; ++frame) {
    const FitStatus status = statuses[frame % 5];
    const bool is_fitted = status != FitStatus::kNoHeadPose && status != FitStatus::kTooFewMarkers;
    for (int i = 0; i < 3; ++i) {
      track.values(frame, i) = is_fitted ? normal(random) : kNaN;
      track.sigmas(frame, i) = is_fitted ? std::abs(0.01 * normal(random)) : kNaN;
    }
    if (status == FitStatus::kWeak) track.sigmas(frame, 2) = kInfinity;
    track.residuals_mm.push_back(is_fitted ? std::abs(normal(random)) : kNaN);
    track.statuses.push_back(status);
    if (with_phones) track.phones.emplace_back(phones[frame % 6]);
  }
  return track;
}

MATCHER_P2(TableNear, expected, tolerance, "is the table within the tolerance, gaps included") {
  if (arg.rows() != expected.rows() || arg.cols() != expected.cols()) {
    *result_listener << "which is " << arg.rows() << " x " << arg.cols();
    return false;
  }
  for (int row = 0; row < arg.rows(); ++row)
    for (int column = 0; column < arg.cols(); ++column) {
      const double found = arg(row, column);
      const double wanted = expected(row, column);
      const bool same = std::isnan(wanted)   ? std::isnan(found)
                        : std::isinf(wanted) ? found == wanted
                                             : std::abs(found - wanted) <= tolerance;
      if (!same) {
        *result_listener << "whose (" << row << ", " << column << ") is " << found << ", not "
                         << wanted;
        return false;
      }
    }
  return true;
}

Eigen::VectorXd AsVector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

MATCHER_P2(TrackNear, expected, tolerance, "is the track within the tolerance") {
  const auto explain = [&](const char* what) {
    *result_listener << "which differs in " << what;
    return false;
  };
  if (arg.names != expected.names || arg.units != expected.units) return explain("its columns");
  if (std::abs(arg.rate_hz / expected.rate_hz - 1) > 1e-9) return explain("its rate");
  if (arg.first_frame != expected.first_frame || arg.start != expected.start)
    return explain("its start");
  if (arg.statuses != expected.statuses) return explain("its statuses");
  if (arg.phones != expected.phones) return explain("its phones");
  return testing::ExplainMatchResult(TableNear(expected.values, tolerance), arg.values,
                                     result_listener) &&
         testing::ExplainMatchResult(TableNear(expected.sigmas, tolerance), arg.sigmas,
                                     result_listener) &&
         testing::ExplainMatchResult(TableNear(AsVector(expected.residuals_mm), tolerance),
                                     AsVector(arg.residuals_mm), result_listener);
}

TEST(ParameterCsvTest, IsThisText) {
  ParameterTrack track = MakeTrack(3, 60, 1);
  track.values.row(0) << std::acos(0.0), -1.25, 0.5;
  track.sigmas.row(0) << std::acos(-1.0) / 180, 0.1, kInfinity;
  track.residuals_mm[0] = 0.75;
  track.phones = {"\"e:", "a,b", "p"};
  const std::string text = WriteParameterCsv(track);
  EXPECT_THAT(
      text, testing::StartsWith(
                "frame,time_s,jaw_rotation[deg],lip_rounding[mm],smile[1],sigma_jaw_rotation[deg],"
                "sigma_lip_rounding[mm],sigma_smile[1],residual_mm,status,phone\n"
                "41,0.666666667,90.000000,-1.250000,0.500000,1.000000,0.100000,inf,0.750000,ok,"
                "\"\"\"e:\"\n"
                "42,0.683333334,,,,,,,,no_head_pose,\"a,b\"\n"));
}

class ParameterRates : public testing::TestWithParam<double> {};

TEST_P(ParameterRates, SurviveTheCsv) {
  const ParameterTrack track = MakeTrack(500, GetParam(), 2);
  const auto read = ParseParameterCsv(WriteParameterCsv(track), "x.csv");
  ASSERT_TRUE(read) << read.error().message;
  // Half of the last decimal; a degree's is smaller in rad.
  EXPECT_THAT(*read, TrackNear(track, 0.51e-6));
  if (GetParam() == std::round(GetParam())) {
    EXPECT_EQ(read->rate_hz, GetParam());
  }
}

TEST_P(ParameterRates, WrittenAgainTheCsvIsTheSame) {
  for (const int num_frames : {0, 1, 2, 7, 3000}) {
    const std::string once = WriteParameterCsv(MakeTrack(num_frames, GetParam(), 3));
    const auto read = ParseParameterCsv(once, "x.csv");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(WriteParameterCsv(*read), once) << num_frames << " frames";
  }
}

INSTANTIATE_TEST_SUITE_P(Usual, ParameterRates,
                         testing::Values(25, 29.97, 30000.0 / 1001, 59.94, 60, 100, 119.88, 250,
                                         1000, 7.123456789));

TEST(ParameterCsvTest, ReadsWhatSpreadsheetsWrite) {
  const auto track = ParseParameterCsv(
      "\xEF\xBB\xBF"
      "frame,time_s,jaw_rotation[deg],residual_mm,status\r\n"
      "1,0.000,1.5,0.2,ok\r\n2,0.017,,,too_few_markers\r\n\r\n3,0.033,-1e-1,0.25,weak",
      "sheet.csv");
  ASSERT_TRUE(track) << track.error().message;
  EXPECT_EQ(track->num_frames(), 3);
  EXPECT_NEAR(track->rate_hz, 60, 2);  // times to milliseconds tell no more
  EXPECT_NEAR(track->values(2, 0), -0.1 * std::acos(-1.0) / 180, 1e-15);
  EXPECT_TRUE(std::isnan(track->values(1, 0)) && std::isnan(track->sigmas(0, 0)));
}

struct BadCsv {
  const char* text;
  const char* message;
};

class BadParameterCsv : public testing::TestWithParam<BadCsv> {};

TEST_P(BadParameterCsv, IsRefusedWithLineAndReason) {
  const auto track = ParseParameterCsv(GetParam().text, "bad.csv");
  ASSERT_FALSE(track);
  EXPECT_THAT(track.error().message, AllOf(HasSubstr("bad.csv"), HasSubstr(GetParam().message)));
}

#define HEADER "frame,time_s,jaw_rotation[deg],residual_mm,status\n"
INSTANTIATE_TEST_SUITE_P(
    Kinds, BadParameterCsv,
    testing::Values(BadCsv{"", "is empty"}, BadCsv{"\n\n", "is empty"},
                    BadCsv{"a,b\n", ":1: is not a table of parameters"},
                    BadCsv{"frame,time_s,jaw[deg]\n", "residual_mm,status are missing"},
                    BadCsv{"frame,time_s,jaw,residual_mm,status\n", "'jaw' names no unit"},
                    BadCsv{"frame,time_s,jaw[cm],residual_mm,status\n", "unit 'cm'"},
                    BadCsv{"frame,time_s,a[mm],a[mm],residual_mm,status\n", "'a' is there twice"},
                    BadCsv{"frame,time_s,a[mm],residual_mm,status,word\n", "'word' is not known"},
                    BadCsv{HEADER "1,0,1,1\n", ":2: 4 cells, but the header names 5 columns"},
                    BadCsv{HEADER "1,0,1,1,ok\n3,1,1,1,ok\n", ":3: frame 3 follows frame 1"},
                    BadCsv{HEADER "one,0,1,1,ok\n", "'one' is not a whole number"},
                    BadCsv{HEADER "99999999999,0,1,1,ok\n", "not a whole number"},
                    BadCsv{HEADER "1,nan,1,1,ok\n", "'nan' is not a time"},
                    BadCsv{HEADER "1,1e300,1,1,ok\n", "is not a time"},
                    BadCsv{HEADER "1,0,x,1,ok\n", ":2: 'x' is not a number"},
                    BadCsv{HEADER "1,0,inf,1,ok\n", "'inf' is not a number"},
                    BadCsv{HEADER "1,0,1,1,fine\n", "status 'fine' is not known"},
                    BadCsv{HEADER "1,0,1,1,\"ok\n", ":2: a quoted cell does not end"},
                    BadCsv{HEADER "1,0,1,1,\"ok\"x\n", "follows a closing quote"},
                    BadCsv{HEADER "1,0.0,1,1,ok\n2,0.1,1,1,ok\n3,0.2,1,1,ok\n4,0.9,1,1,ok\n",
                           ":5: the times are not at a constant rate"},
                    BadCsv{HEADER "1,0,1,1,ok\n2,0,1,1,ok\n", "not at a constant rate"},
                    BadCsv{HEADER "1,0.7,1,1,ok\n2,27528232.146,1,1,ok\n",
                           ":3: the times give 3.63e-08 frames a second"},
                    BadCsv{HEADER "1,-3.9e9,1,1,ok\n2,3.9e9,1,1,ok\n3,0,1,1,ok\n",
                           "not at a constant rate"}));
#undef HEADER

TEST(ParameterCsvTest, RefusesZeroBytes) {
  const auto track = ParseParameterCsv(std::string("frame\0,", 7), "bad.csv");
  ASSERT_FALSE(track);
  EXPECT_THAT(track.error().message, HasSubstr("byte 5 is zero"));
}

class ParameterHdf5Test : public testing::Test {
 protected:
  std::filesystem::path folder_ = MakeTemporaryFolder(
      std::string("articap_hdf5_") + testing::UnitTest::GetInstance()->current_test_info()->name());
  std::filesystem::path path_ = folder_ / "parameters.h5";

  ~ParameterHdf5Test() override { std::filesystem::remove_all(folder_); }

  std::string Write(const ParameterTrack& track) {
    const auto written = WriteParameterHdf5(track, path_);
    EXPECT_TRUE(written) << written.error().message;
    return ReadFile(path_).value_or("");
  }
};

TEST_F(ParameterHdf5Test, KeepsEverything) {
  const ParameterTrack track = MakeTrack(500, 59.94, 4);
  Write(track);
  const auto read = ReadParameterHdf5(path_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->rate_hz, track.rate_hz);
  EXPECT_THAT(*read, TrackNear(track, 1e-12));
}

TEST_F(ParameterHdf5Test, TheSameTrackGivesTheSameBytes) {
  for (const int num_frames : {0, 1, 500})
    for (const bool with_phones : {false, true}) {
      const ParameterTrack track = MakeTrack(num_frames, 59.94, 5, with_phones);
      const std::string once = Write(track);
      EXPECT_EQ(Write(track), once);
      const auto read = ReadParameterHdf5(path_);
      ASSERT_TRUE(read) << read.error().message;
      EXPECT_EQ(Write(*read), once) << num_frames << " frames";
    }
}

TEST_F(ParameterHdf5Test, EveryTruncationIsAClearError) {
  const std::string whole = Write(MakeTrack(50, 60, 6));
  testing::internal::CaptureStderr();
  for (std::size_t size = 0; size < whole.size(); size += 97) {
    ASSERT_TRUE(WriteFile(path_, whole.substr(0, size)));
    const auto track = ReadParameterHdf5(path_);
    ASSERT_FALSE(track) << size;
    ASSERT_THAT(track.error().message, HasSubstr("parameters.h5"));
  }
  EXPECT_THAT(testing::internal::GetCapturedStderr(), IsEmpty());
}

TEST_F(ParameterHdf5Test, ForeignFilesAreRefused) {
  ASSERT_TRUE(WriteFile(path_, "frame,time_s\n1,2\n"));
  const auto text = ReadParameterHdf5(path_);
  ASSERT_FALSE(text);
  EXPECT_THAT(text.error().message, HasSubstr("is not an HDF5 file of articap"));
  EXPECT_THAT(ReadParameterHdf5(folder_ / "none.h5").error().message,
              HasSubstr("cannot be opened"));
}

// No damaged byte goes unseen, wherever it lies.
TEST_F(ParameterHdf5Test, DamageIsAlwaysFound) {
  const std::string whole = Write(MakeTrack(5, 60, 7));
  std::mt19937 random(8);
  for (int trial = 0; trial < 500; ++trial) {
    std::string damaged = whole;
    damaged[random() % damaged.size()] ^= static_cast<char>(1 + random() % 255);
    ASSERT_TRUE(WriteFile(path_, damaged));
    ASSERT_FALSE(ReadParameterHdf5(path_)) << "trial " << trial;
  }
}

}  // namespace
}  // namespace articap
