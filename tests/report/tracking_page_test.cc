// SPDX-License-Identifier: MIT
#include "report/tracking_page.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "core/check.h"
#include "tests/report/sample_tracking.h"

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

TEST(TrackingPageTest, HoldsTheReviewAndThePictures) {
  const std::string review = SampleTrackingJson();
  json data = DataOf(TrackingPage("take01", review, {"abc"}));
  EXPECT_EQ(data["title"], "take01");
  EXPECT_EQ(data["pictures"], json::parse(R"(["data:image/png;base64,YWJj"])"));
  data.erase("title");
  data.erase("pictures");
  EXPECT_EQ(data, json::parse(review));
}

TEST(TrackingPageTest, NeedsNoNetwork) {
  const std::string page = TrackingPage("take01", SampleTrackingJson(), {});
  for (const char* reference : {"src=\"http", "href=\"http", "@import", "<script src", "url(http"})
    EXPECT_THAT(page, Not(HasSubstr(reference)));
  EXPECT_THAT(page, HasSubstr("Content-Security-Policy\" content=\"default-src 'none'"));
}

TEST(TrackingPageTest, NamesCannotBreakOutOfThePage) {
  const std::string page = TrackingPage("</title><b>", SampleTrackingJson(), {});
  EXPECT_THAT(page, Not(HasSubstr("<b>")));
}

TEST(TrackingPageTest, TakesNothingButAReview) {
  EXPECT_THROW(TrackingPage("", "{\"stage\": \"fit\"}", {}), CheckError);
  EXPECT_THROW(TrackingPage("", "{", {}), CheckError);
}

}  // namespace
}  // namespace articap
