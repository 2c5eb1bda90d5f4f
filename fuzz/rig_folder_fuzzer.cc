// SPDX-License-Identifier: MIT
#include "fuzz/fuzz_input.h"
#include "rig/io/import_recipe.h"
#include "rig/io/rig_folder.h"

// The input is the files of a rig folder one after the other, each after a line "=== NAME".
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = articap::TextOf(data, size);
  articap::RigFiles files;
  for (std::size_t begin = text.find("=== "); begin != std::string::npos;) {
    const std::size_t name_end = std::min(text.find('\n', begin), text.size());
    const std::size_t end = text.find("=== ", name_end);
    const std::string name = text.substr(begin + 4, name_end - begin - 4);
    files[name] = text.substr(std::min(name_end + 1, text.size()),
                              end == std::string::npos ? end : end - name_end - 1);
    begin = end;
  }
  const auto rig = articap::ParseRig(files, "fuzz");
  if (rig) {
    const articap::RigFiles written = articap::SerializeRig(*rig);
    const auto again = articap::ParseRig(written, "fuzz");
    articap::Require(again.has_value() && articap::SerializeRig(*again) == written);
  }
  const auto recipe = articap::ParseImportRecipe(text, "fuzz");
  articap::Require(recipe.has_value() || !recipe.error().message.empty());
  return 0;
}
