// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "core/board.h"
#include "core/options.h"
#include "core/result.h"

namespace articap {

enum class Paper : std::uint8_t { kA4, kA3, kLetter, kFitted };

struct PrintOptions {
  Paper paper = Paper::kA4;  // kFitted: as large as the board needs
};
void VisitOptions(PrintOptions& options, OptionVisitor& visit);

// The bytes of a PDF of one page with the board in its true size, upright or across as it fits, and
// a line below that says what it is, with a bar of 100 mm to measure the print by. The same board
// gives the same bytes. Refused where the paper is too small, with what would fit.
Result<std::string> BoardPdf(const BoardSpec& board, const PrintOptions& options = {});

}  // namespace articap
