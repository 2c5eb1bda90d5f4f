// SPDX-License-Identifier: MIT
#include "report/report_page.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/report/sample_take.h"

namespace articap {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr std::size_t kLargestPage = 15'000'000;

json DataOf(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t at = page.find(begin) + begin.size();
  return json::parse(page.substr(at, page.find("</script>", at) - at));
}

TEST(ReportPageTest, HoldsTheTake) {
  const FaceRig rig = MakeEggRig();
  const SampleTake take = MakeSampleTake(rig, 1200);
  const json data = DataOf(BuildReportPage(take.Input(rig)));
  EXPECT_EQ(data["take"]["title"], "A sample take");
  EXPECT_EQ(data["take"]["num_frames"], 1200);
  EXPECT_EQ(data["tracks"]["frames_per_point"], 1);
  EXPECT_EQ(data["tracks"]["parameters"].size(), 3u);
  EXPECT_EQ(data["tracks"]["parameters"][0]["unit"], "deg");
  EXPECT_NEAR(data["tracks"]["parameters"][0]["max"].get<double>(), 20.0535, 1e-3);
  EXPECT_EQ(data["stages"][0]["warnings"].size(), 1u);
  EXPECT_EQ(data["residuals"]["markers"].size(), take.measured.names().size());
  EXPECT_EQ(data["scene"]["first"], 0);
  EXPECT_EQ(data["scene"]["count"], 600);
}

TEST(ReportPageTest, TheSameTakeGivesTheSamePage) {
  const FaceRig rig = MakeEggRig();
  EXPECT_EQ(BuildReportPage(MakeSampleTake(rig, 300).Input(rig)),
            BuildReportPage(MakeSampleTake(rig, 300).Input(rig)));
}

TEST(ReportPageTest, NeedsNoNetwork) {
  const FaceRig rig = MakeEggRig();
  const std::string page = BuildReportPage(MakeSampleTake(rig, 60).Input(rig));
  for (const char* reference : {"src=\"http", "href=\"http", "@import", "<script src", "url(http"})
    EXPECT_THAT(page, Not(HasSubstr(reference)));
}

TEST(ReportPageTest, NamesCannotBreakOutOfThePage) {
  const FaceRig rig = MakeEggRig();
  const SampleTake take = MakeSampleTake(rig, 60);
  ReportPageInput input = take.Input(rig);
  input.title = "</script><img src=x onerror=alert(1)>\xff";
  const std::string page = BuildReportPage(input);
  EXPECT_THAT(page, Not(HasSubstr("<img src=x")));
  EXPECT_EQ(DataOf(page)["take"]["title"], "</script><img src=x onerror=alert(1)>\uFFFD");
}

TEST(ReportPageTest, PartsThatAreMissingAreLeftOut) {
  ParameterTrack empty;
  const json data = DataOf(BuildReportPage({.title = "nothing", .parameters = &empty}));
  for (const char* part : {"scene", "residuals", "head_pose", "phones"})
    EXPECT_TRUE(data[part].is_null()) << part;
}

TEST(ReportPageTest, TheWindowIsChosenAndClamped) {
  const FaceRig rig = MakeEggRig();
  const SampleTake take = MakeSampleTake(rig, 300);
  ReportPageInput input = take.Input(rig);
  input.window = FrameWindow{250, 1000};
  const json scene = DataOf(BuildReportPage(input))["scene"];
  EXPECT_EQ(scene["first"], 250);
  EXPECT_EQ(scene["count"], 50);
}

// Two hours of speech whose status changes at every frame: nothing in the page may grow with it.
TEST(ReportPageTest, StaysSmallWhateverTheLength) {
  const int num_frames = 400'000;
  SampleTake take = MakeSampleTake(MakeEggRig(), 30);
  ParameterTrack track = take.parameters;
  track.values = Eigen::MatrixXd::Random(num_frames, 3);
  track.sigmas = track.values.cwiseAbs();
  track.residuals_mm.assign(num_frames, 0.5);
  track.statuses.assign(num_frames, FitStatus::kOk);
  track.phones.assign(num_frames, "a");
  for (int frame = 0; frame < num_frames; frame += 2) {
    track.statuses[frame] = FitStatus::kWeak;
    track.phones[frame] = "b";
  }
  take.residuals.names = {"a", "b", "c", "d", "e"};
  take.residuals.distances_mm = Eigen::MatrixXf::Random(num_frames, 5).cwiseAbs();
  const std::string page = BuildReportPage({.title = "long",
                                            .reports = take.reports,
                                            .parameters = &track,
                                            .ranges = take.ranges,
                                            .residuals = &take.residuals});
  EXPECT_LT(page.size(), kLargestPage);
}

}  // namespace
}  // namespace articap
