// SPDX-License-Identifier: MIT
#include "apps/output_set.h"

#include <gmock/gmock.h>

#include "core/file_io.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class OutputSetTest : public ::testing::Test {
 protected:
  ~OutputSetTest() override { fs::remove_all(folder_); }

  int CountEntries() const {
    int count = 0;
    for ([[maybe_unused]] const auto& entry : fs::recursive_directory_iterator(folder_)) ++count;
    return count;
  }

  const fs::path folder_ = MakeTemporaryFolder("articap_output_set_test");
};

TEST_F(OutputSetTest, WritesAllFilesAndTheirFolders) {
  OutputSet outputs;
  outputs.Add(folder_ / "take" / "a.csv", "one");
  outputs.AddWriter(folder_ / "take" / "b.h5",
                    [](const fs::path& path) { return WriteFile(path, "two"); });
  ASSERT_TRUE(outputs.Commit());
  EXPECT_EQ(ReadFile(folder_ / "take" / "a.csv").value(), "one");
  EXPECT_EQ(ReadFile(folder_ / "take" / "b.h5").value(), "two");
  EXPECT_EQ(CountEntries(), 3);
}

TEST_F(OutputSetTest, LeavesNothingWhereOneFileFails) {
  OutputSet outputs;
  outputs.Add(folder_ / "take" / "a.csv", "one");
  outputs.AddWriter(folder_ / "take" / "b.h5",
                    [](const fs::path&) -> Result<void> { return Fail("disk full"); });
  const Result<void> committed = outputs.Commit();
  ASSERT_FALSE(committed);
  EXPECT_EQ(committed.error().message, "disk full");
  EXPECT_EQ(CountEntries(), 0);
}

TEST_F(OutputSetTest, KeepsTheFormerFileWhereOneFails) {
  ASSERT_TRUE(WriteFile(folder_ / "a.csv", "former"));
  OutputSet outputs;
  outputs.Add(folder_ / "a.csv", "new");
  outputs.AddWriter(folder_ / "b.h5",
                    [](const fs::path&) -> Result<void> { return Fail("disk full"); });
  ASSERT_FALSE(outputs.Commit());
  EXPECT_EQ(ReadFile(folder_ / "a.csv").value(), "former");
  EXPECT_EQ(CountEntries(), 1);
}

TEST_F(OutputSetTest, RefusesToTakeThePlaceOfAnInput) {
  ASSERT_TRUE(WriteFile(folder_ / "raw.c3d", "raw"));
  fs::create_symlink(folder_ / "raw.c3d", folder_ / "link.c3d");
  OutputSet outputs;
  outputs.Add(folder_ / "link.c3d", "new");
  const Result<void> allowed = outputs.RefuseToOverwrite({folder_ / "raw.c3d"});
  ASSERT_FALSE(allowed);
  EXPECT_THAT(allowed.error().message, HasSubstr("never altered"));
}

TEST_F(OutputSetTest, RefusesAnInputBehindAFolderThatIsNotThere) {
  ASSERT_TRUE(WriteFile(folder_ / "raw.c3d", "raw"));
  OutputSet outputs;
  outputs.Add(folder_ / "nowhere" / ".." / "raw.c3d", "new");
  EXPECT_FALSE(outputs.RefuseToOverwrite({folder_ / "raw.c3d"}));
}

TEST_F(OutputSetTest, RefusesAFolderInTheWay) {
  fs::create_directory(folder_ / "a.csv");
  OutputSet outputs;
  outputs.Add(folder_ / "a.csv", "one");
  const Result<void> committed = outputs.Commit();
  ASSERT_FALSE(committed);
  EXPECT_THAT(committed.error().message, HasSubstr("is a folder"));
}

}  // namespace
}  // namespace articap
