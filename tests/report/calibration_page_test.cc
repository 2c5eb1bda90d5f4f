// SPDX-License-Identifier: MIT
#include "report/calibration_page.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "core/check.h"
#include "tests/report/sample_calibrations.h"

namespace articap {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

json DataOf(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t at = page.find(begin) + begin.size();
  return json::parse(page.substr(at, page.find("</script>", at) - at));
}

TEST(CalibrationPageTest, HoldsTheWholeCalibration) {
  const std::string calibration = SampleLensJson();
  EXPECT_EQ(DataOf(CalibrationPage(calibration)), json::parse(calibration));
}

TEST(CalibrationPageTest, TheSameCalibrationGivesTheSamePage) {
  const std::string calibration = SampleMirrorJson();
  EXPECT_EQ(CalibrationPage(calibration), CalibrationPage(std::string(calibration)));
}

TEST(CalibrationPageTest, NeedsNoNetwork) {
  const std::string page = CalibrationPage(SampleLensJson());
  for (const char* reference : {"src=\"http", "href=\"http", "@import", "<script src", "url(http"})
    EXPECT_THAT(page, Not(HasSubstr(reference)));
  EXPECT_THAT(page, HasSubstr("Content-Security-Policy\" content=\"default-src 'none'"));
}

TEST(CalibrationPageTest, NamesCannotBreakOutOfThePage) {
  const std::string page = CalibrationPage(SampleLensJson());
  EXPECT_THAT(page, Not(HasSubstr("<img src=x")));
  EXPECT_THAT(page, Not(HasSubstr("<b>lower")));
}

TEST(CalibrationPageTest, TakesNothingButACalibration) {
  EXPECT_THROW(CalibrationPage("{\"stage\": \"fit\"}"), CheckError);
  EXPECT_THROW(CalibrationPage("{"), CheckError);
}

}  // namespace
}  // namespace articap
