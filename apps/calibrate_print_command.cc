// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "apps/output_set.h"
#include "apps/verbs.h"
#include "calib/board_print.h"
#include "core/board.h"

namespace articap {

ExitCode CalibratePrintCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap calibrate print",
                "A calibration board to print, as a PDF in its true size.",
                "articap calibrate print --board charuco:7x5:25:18 -o board.pdf");
  std::string board_text, output;
  PrintOptions options;
  line.Flag("--board", board_text, "BOARD",
            "chessboard:COLUMNSxROWS:SQUARE_MM (inner corners) or "
            "charuco:COLUMNSxROWS:SQUARE_MM:MARKER_MM[:DICTIONARY] (squares)")
      ->required();
  line.Flag("-o,--output", output, "FILE", "PDF file to write")->required();
  line.Stage("print", options);
  if (const auto exit = line.Parse(arguments)) return *exit;
  const Result<BoardSpec> board = ParseBoardSpec(board_text);
  if (!board) return FailWith(ExitCode::kWrongUsage, board.error().message);
  const Result<std::string> pdf = BoardPdf(*board, options);
  if (!pdf) return FailWith(pdf.error());
  OutputSet outputs;
  outputs.Add(output, *pdf);
  if (const auto written = outputs.Commit(); !written) return FailWith(written.error());
  StageReport report;
  report.stage = "print";
  report.verdict = fmt::format(
      "{} written to {}; print it at 100 %, measure the bar, and glue it to something flat",
      NameOf(*board), output);
  report.texts = {{"board", NameOf(*board)}};
  report.options = EchoOptions(options);
  return line.Finish({report});
}

}  // namespace articap
