// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace articap {

// The folder of real recordings that are not part of the project: the environment variable
// ARTICAP_TEST_DATA, by default ../shared/data from the project's root.
std::filesystem::path TestDataFolder();

// Tests that need one of its files begin with ARTICAP_NEEDS_TEST_DATA("animface/jaw.trc").
std::filesystem::path TestDataPath(const std::string& relative);
bool HasTestData(const std::string& relative);

// The project's own root, and a fresh empty folder for a test's files.
std::filesystem::path SourceFolder();
std::filesystem::path MakeTemporaryFolder(const std::string& name);

}  // namespace articap

#define ARTICAP_NEEDS_TEST_DATA(relative)                                                      \
  if (!::articap::HasTestData(relative))                                                       \
  GTEST_SKIP() << ::articap::TestDataPath(relative) << " is not there; set ARTICAP_TEST_DATA " \
               << "to the folder of real recordings to run this test"
