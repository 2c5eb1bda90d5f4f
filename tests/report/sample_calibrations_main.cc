// SPDX-License-Identifier: MIT
// Writes the pages of synthetic calibrations and their JSON, for tests in a browser:
//   articap_sample_calibrations FOLDER
#include <filesystem>
#include <functional>
#include <iostream>
#include <string>
#include <utility>

#include "core/file_io.h"
#include "report/calibration_page.h"
#include "tests/report/sample_calibrations.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: articap_sample_calibrations FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  const std::pair<std::string, std::function<std::string()>> samples[] = {
      {"lens", articap::SampleLensJson},
      {"rig", articap::SampleRigJson},
      {"mirror", articap::SampleMirrorJson},
      {"wand", articap::SampleWandJson},
      {"blurred", articap::SampleBlurredJson}};
  for (const auto& [name, make] : samples) {
    const std::string json = make();
    for (const auto& [extension, text] :
         {std::pair{".json", json}, std::pair{".html", articap::CalibrationPage(json)}})
      if (const auto done = articap::WriteFile(folder / (name + extension), text); !done) {
        std::cerr << done.error().message << "\n";
        return 1;
      }
  }
  return 0;
}
