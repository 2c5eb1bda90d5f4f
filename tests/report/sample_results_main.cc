// SPDX-License-Identifier: MIT
// Writes results like those of `articap fit`, for tests in a browser and in Python:
//   articap_sample_results FOLDER [FRAMES]
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "core/file_io.h"
#include "rig/default_head/default_head.h"
#include "tests/report/sample_take.h"

namespace articap {
namespace {

Result<void> WriteResults(const std::filesystem::path& folder, int num_frames) {
  const auto rig = MakeDefaultHead();
  if (!rig) return tl::unexpected(rig.error());
  const SampleTake take = MakeSampleTake(*rig, num_frames);
  if (auto done = WriteFile(folder / "report.html", BuildReportPage(take.Input(*rig))); !done)
    return done;
  if (auto done = WriteFile(folder / "parameters.csv", WriteParameterCsv(take.parameters)); !done)
    return done;
  if (auto done = WriteFile(folder / "report.json", ReportsToJson(take.reports)); !done)
    return done;
  return WriteParameterHdf5(take.parameters, folder / "parameters.h5");
}

}  // namespace
}  // namespace articap

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: articap_sample_results FOLDER [FRAMES]\n";
    return 2;
  }
  const int num_frames = argc > 2 ? std::atoi(argv[2]) : 1590;
  if (const auto written = articap::WriteResults(argv[1], num_frames); !written) {
    std::cerr << written.error().message << "\n";
    return 1;
  }
  return 0;
}
