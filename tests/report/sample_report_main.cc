// SPDX-License-Identifier: MIT
// Writes a page for tests in a browser: articap_sample_report OUT.html [FRAMES]
#include <cstdlib>
#include <fstream>
#include <iostream>

#include "tests/report/sample_take.h"

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: articap_sample_report OUT.html [FRAMES]\n";
    return 2;
  }
  const int num_frames = argc > 2 ? std::atoi(argv[2]) : 1590;
  const articap::FaceRig rig = articap::MakeEggRig();
  const articap::SampleTake take = articap::MakeSampleTake(rig, num_frames);
  std::ofstream stream(argv[1], std::ios::binary);
  stream << articap::BuildReportPage(take.Input(rig));
  return stream.good() ? 0 : 1;
}
