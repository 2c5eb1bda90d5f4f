// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/verb_line.h"
#include "core/result.h"
#include "tracking/apply_corrections.h"

namespace articap {

// The flag of the verbs whose result a person may put right.
inline void AddCorrectionsFlag(VerbLine& line, std::string& path) {
  line.Flag("--corrections", path, "FILE", "what a person put right, to be applied again; TOML");
}

// None where no file is named.
inline Result<AppliedCorrections> CorrectionsOf(const std::string& path, int first_frame) {
  if (path.empty()) return AppliedCorrections({}, first_frame);
  Result<Corrections> corrections = ReadCorrections(path);
  if (!corrections) return tl::unexpected(corrections.error());
  return AppliedCorrections(std::move(*corrections), first_frame);
}

}  // namespace articap
