// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <optional>

#include "apps/progress.h"
#include "apps/verbs.h"
#include "core/file_io.h"
#include "rig/io/import.h"
#include "rig/io/rig_folder.h"

namespace articap {

// In the namespace of the struct, where VerbLine looks for it.
static void VisitOptions(ImportOptions& options, OptionVisitor& visit) {
  visit("unit", options.unit,
        "unit of length of the input: mm, cm, dm, m or in, instead of the recipe's");
  visit("use_jaw_joint", options.use_jaw_joint, "let the jaw turn, where the recipe has a joint");
}

namespace {

Result<std::optional<ImportRecipe>> ReadRecipe(const std::string& path) {
  if (path.empty()) return std::nullopt;
  const Result<std::string> text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  Result<ImportRecipe> recipe = ParseImportRecipe(*text, path);
  if (!recipe) return tl::unexpected(recipe.error());
  return std::move(*recipe);
}

}  // namespace

ExitCode RigImportCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap rig import",
                "Makes a rig of linear morphs: from a folder with neutral.obj and an OBJ file a\n"
                "target, a glTF or GLB file, or MakeHuman's base.obj with targets/ beside it.",
                "articap rig import makehuman/base.obj -o makehuman_rig");
  std::string input, folder, recipe_path;
  ImportOptions options;
  line.Argument("IN", input, "folder of OBJ files, glTF file, or MakeHuman's base.obj");
  line.Flag("-o,--output", folder, "DIR", "folder of the rig to write")->required();
  line.Flag("--recipe", recipe_path, "FILE", "what the targets mean, TOML; see docs/rigs.md");
  line.Stage("import", options);
  if (const auto exit = line.Parse(arguments)) return *exit;

  const auto recipe = ReadRecipe(recipe_path);
  if (!recipe) return FailWith(recipe.error());
  const auto imported =
      WithProgress("importing " + input, [&] { return ImportRig(input, *recipe, options); });
  if (!imported) return FailWith(imported.error());
  if (imported->report.IsUsable())
    if (const auto saved = SaveRig(imported->output, folder); !saved)
      return FailWith(saved.error());
  return line.Finish({imported->report});
}

}  // namespace articap
