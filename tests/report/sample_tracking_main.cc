// SPDX-License-Identifier: MIT
// Writes the pages of labelled markers and their JSON, for tests in a browser:
//   articap_sample_tracking FOLDER
#include <filesystem>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "core/file_io.h"
#include "render/picture.h"
#include "report/tracking_page.h"
#include "tests/report/sample_tracking.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: articap_sample_tracking FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  const auto picture =
      articap::EncodePng(articap::FilledPicture(480, 240, Eigen::Vector3f::Constant(0.3F)));
  const std::string views = articap::SampleTrackingJson(), file = articap::SampleLabelledFileJson();
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"tracked.json", views},
           {"tracked.html", articap::TrackingPage("tracked", views, {*picture, *picture})},
           {"labelled.json", file},
           {"labelled.html", articap::TrackingPage("labelled", file, {})}})
    if (const auto done = articap::WriteFile(folder / name, text); !done) {
      std::cerr << done.error().message << "\n";
      return 1;
    }
  return 0;
}
