// SPDX-License-Identifier: MIT
#include "calib/board_print.h"

#include <fmt/format.h>
#include <hpdf.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "calib/board_pattern.h"
#include "core/check.h"

namespace articap {
namespace {

struct NamedPaper {
  Paper paper;
  const char* name;
  Eigen::Vector2d size_mm;  // upright
};
const NamedPaper kPapers[] = {{Paper::kA4, "A4", {210, 297}},
                              {Paper::kLetter, "letter", {215.9, 279.4}},
                              {Paper::kA3, "A3", {297, 420}}};

constexpr double kPointsPerMm = 72 / 25.4;
// What printers leave white at the paper's edges.
constexpr double kUnprinted_mm = 6;
// Below the board: a line of text and the bar.
constexpr double kFooter_mm = 7;
constexpr double kLongestText_mm = 160;
constexpr double kBar_mm = 100;
constexpr float kFontSize_pt = 8;
// PDF readers take pages up to this (14400 points).
constexpr double kLargestPage_mm = 5080;

Eigen::Vector2d SizeOfSquares(const BoardSpec& board) {
  return board.square_mm * Eigen::Vector2d(board.square_columns(), board.square_rows());
}

// The white around the squares, which sets the board off against what is behind the paper: as much
// as leaves chessboard:9x6:25 on A4.
double MarginOf(const BoardSpec& board) { return std::max(kUnprinted_mm, 0.4 * board.square_mm); }

Eigen::Vector2d NeededPage(const BoardSpec& board) {
  const double margin_mm = MarginOf(board);
  const Eigen::Vector2d squares_mm = SizeOfSquares(board);
  return {std::max(squares_mm.x() + 2 * margin_mm, kLongestText_mm + 2 * kUnprinted_mm),
          squares_mm.y() + 2 * margin_mm + kFooter_mm + kUnprinted_mm};
}

// The paper upright or across, whichever leaves more room; nothing where neither leaves any.
std::optional<Eigen::Vector2d> PageOn(const Eigen::Vector2d& paper_mm,
                                      const Eigen::Vector2d& needed_mm) {
  const Eigen::Vector2d across_mm = paper_mm.reverse();
  const double room = (paper_mm - needed_mm).minCoeff();
  const double room_across = (across_mm - needed_mm).minCoeff();
  if (std::max(room, room_across) < 0) return std::nullopt;
  return room >= room_across ? paper_mm : across_mm;
}

// To a tenth of a millimetre, downwards; 0 where no squares that anyone could use fit.
double LargestSquare(BoardSpec board, const Eigen::Vector2d& paper_mm) {
  const double marker_part = board.marker_mm / board.square_mm;
  for (double tenths = std::floor(10 * board.square_mm); tenths >= 10; --tenths) {
    board.square_mm = tenths / 10;
    board.marker_mm = marker_part * board.square_mm;
    if (PageOn(paper_mm, NeededPage(board))) return board.square_mm;
  }
  return 0;
}

Error TooSmall(const BoardSpec& board, const NamedPaper& paper) {
  const Eigen::Vector2d needed_mm = NeededPage(board);
  std::string instead;
  for (const NamedPaper& other : kPapers)
    if (instead.empty() && PageOn(other.size_mm, needed_mm))
      instead = fmt::format("print it on {}", other.name);
  if (instead.empty()) instead = "print it on paper 'fitted' to it";
  if (const double square_mm = LargestSquare(board, paper.size_mm); square_mm > 0)
    instead += fmt::format(", or make the squares {} mm at most", square_mm);
  return {fmt::format("{} needs {:.0f} x {:.0f} mm of paper, more than {}; {}", NameOf(board),
                      std::ceil(needed_mm.x()), std::ceil(needed_mm.y()), paper.name, instead)};
}

Result<Eigen::Vector2d> PageFor(const BoardSpec& board, Paper wanted) {
  const Eigen::Vector2d needed_mm = NeededPage(board);
  if (wanted == Paper::kFitted) {
    if (needed_mm.maxCoeff() <= kLargestPage_mm) return needed_mm;
    return Fail(fmt::format("{} needs {:.0f} x {:.0f} mm of paper; a PDF's page is {} mm at most",
                            NameOf(board), needed_mm.x(), needed_mm.y(), kLargestPage_mm));
  }
  for (const NamedPaper& paper : kPapers) {
    if (paper.paper != wanted) continue;
    if (const auto page_mm = PageOn(paper.size_mm, needed_mm)) return *page_mm;
    return tl::unexpected(TooSmall(board, paper));
  }
  ARTICAP_CHECK(false);
}

// Draws on one page; mm from its top left corner, y down. Failures stay with the document.
class PdfPage {
 public:
  explicit PdfPage(const Eigen::Vector2d& size_mm)
      : document_(HPDF_New(nullptr, nullptr), &HPDF_Free), height_mm_(size_mm.y()) {
    page_ = HPDF_AddPage(document_.get());
    HPDF_Page_SetWidth(page_, Points(size_mm.x()));
    HPDF_Page_SetHeight(page_, Points(size_mm.y()));
    HPDF_Page_SetFontAndSize(page_, HPDF_GetFont(document_.get(), "Helvetica", nullptr),
                             kFontSize_pt);
  }

  // All in one path, so that no seams show between neighbours.
  void Fill(const std::vector<BoardRectangle>& rectangles, const Eigen::Vector2d& origin_mm) {
    for (const BoardRectangle& rectangle : rectangles) {
      const Eigen::Vector2d size_mm = rectangle.max_mm - rectangle.min_mm;
      const Eigen::Vector2d corner_mm = origin_mm + rectangle.min_mm;
      HPDF_Page_Rectangle(page_, Points(corner_mm.x()),
                          Points(height_mm_ - corner_mm.y() - size_mm.y()), Points(size_mm.x()),
                          Points(size_mm.y()));
    }
    HPDF_Page_Fill(page_);
  }

  void Write(const std::string& text, const Eigen::Vector2d& base_mm) {
    HPDF_Page_BeginText(page_);
    HPDF_Page_TextOut(page_, Points(base_mm.x()), Points(height_mm_ - base_mm.y()), text.c_str());
    HPDF_Page_EndText(page_);
  }

  Result<std::string> Bytes() {
    HPDF_SetInfoAttr(document_.get(), HPDF_INFO_CREATOR, "articap");
    HPDF_SaveToStream(document_.get());
    std::string bytes(HPDF_GetStreamSize(document_.get()), '\0');
    auto size = static_cast<HPDF_UINT32>(bytes.size());
    HPDF_ReadFromStream(document_.get(), reinterpret_cast<HPDF_BYTE*>(bytes.data()), &size);
    if (const HPDF_STATUS error = HPDF_GetError(document_.get()); error != HPDF_OK)
      return Fail(fmt::format("the PDF could not be made: libharu's error 0x{:04x}", error));
    return bytes;
  }

 private:
  static float Points(double mm) { return static_cast<float>(kPointsPerMm * mm); }

  std::unique_ptr<_HPDF_Doc_Rec, decltype(&HPDF_Free)> document_;
  HPDF_Page page_ = nullptr;
  double height_mm_;
};

// A bar with teeth every 10 mm, as wide as it says from outer edge to outer edge.
std::vector<BoardRectangle> Bar() {
  constexpr double kLine_mm = 0.3, kTooth_mm = 2;
  std::vector<BoardRectangle> bar = {{{0, 0}, {kBar_mm, kLine_mm}}};
  for (int tooth = 0; tooth <= 10; ++tooth) {
    const double left_mm = tooth * (kBar_mm - kLine_mm) / 10;
    bar.push_back({{left_mm, -kTooth_mm}, {left_mm + kLine_mm, 0}});
  }
  return bar;
}

}  // namespace

void VisitOptions(PrintOptions& options, OptionVisitor& visit) {
  visit.Enumeration("paper", options.paper, {"a4", "a3", "letter", "fitted"},
                    "paper; fitted: as large as the board needs");
}

Result<std::string> BoardPdf(const BoardSpec& board, const PrintOptions& options) {
  const Result<BoardPattern> pattern = PatternOf(board);
  if (!pattern) return tl::unexpected(pattern.error());
  const Result<Eigen::Vector2d> page_mm = PageFor(board, options.paper);
  if (!page_mm) return tl::unexpected(page_mm.error());
  PdfPage page(*page_mm);
  const double footer_mm = kFooter_mm + kUnprinted_mm;
  const Eigen::Vector2d room_mm = *page_mm - Eigen::Vector2d(0, footer_mm);
  const Eigen::Vector2d top_left_mm = (room_mm - SizeOfSquares(board)) / 2;
  page.Fill(pattern->dark, top_left_mm + Eigen::Vector2d::Constant(board.square_mm));
  const double left_mm = std::max(
      kUnprinted_mm, std::min(top_left_mm.x(), page_mm->x() - kUnprinted_mm - kLongestText_mm));
  page.Write(fmt::format("{}   squares of {} mm   print at 100 %, measure: this bar is {} mm   "
                         "articap",
                         NameOf(board), board.square_mm, kBar_mm),
             {left_mm, page_mm->y() - kUnprinted_mm - 3});
  page.Fill(Bar(), {left_mm, page_mm->y() - kUnprinted_mm - 0.3});
  return page.Bytes();
}

}  // namespace articap
