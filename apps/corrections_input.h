// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>

#include "apps/verb_line.h"
#include "core/result.h"
#include "tracking/apply_corrections.h"

namespace articap {

// The flag of the verbs whose result a person may put right.
inline void AddCorrectionsFlag(VerbLine& line, std::string& path) {
  line.Flag("--corrections", path, "FILE", "what a person put right, to be applied again; TOML");
}

// None where no file is named. Refused where one names a view that the array does not have.
inline Result<AppliedCorrections> CorrectionsOf(const std::string& path, int first_frame,
                                                const CameraArray& array) {
  if (path.empty()) return AppliedCorrections({}, first_frame);
  Result<Corrections> read = ReadCorrections(path);
  if (!read) return tl::unexpected(read.error());
  AppliedCorrections corrections(std::move(*read), first_frame);
  if (const auto known = corrections.CheckViews(array); !known)
    return tl::unexpected(known.error());
  return corrections;
}

}  // namespace articap
