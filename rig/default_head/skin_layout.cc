// SPDX-License-Identifier: MIT
#include "rig/default_head/skin_layout.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <optional>
#include <utility>

#include "core/check.h"
#include "rig/default_head/contours.h"

namespace articap {
namespace {

// Sections of the columns and levels of the rows before relaxation: some 3 mm apart in the face.
std::vector<double> ColumnSections() {
  std::vector<double> sections;
  for (int i = 0; i <= 10; ++i) sections.push_back(0.13 * i);
  for (const double s : {1.45, 1.6, 1.75, 1.9, 2.06, 2.22, 2.4, 2.6, 2.85, 3.1, 3.35, 3.6, 3.9,
                         4.2, 4.5, 4.85, 5.3, 5.8, 6.4, BaseSurface::kBackSection})
    sections.push_back(s);
  return sections;
}

std::vector<double> RowLevels() {
  std::vector<double> levels{0, 0.5, 1, 1.4, 1.8, 2.2, 2.6, 3, 3.35, 3.7, 4, 4.25, 4.5, 4.75};
  while (levels.back() < 11.0)  // finer on the steep underside of the nose
    levels.push_back(levels.back() + (levels.back() > 7.95 && levels.back() < 8.44 ? 0.08 : 0.16));
  for (const double t : {11.4, 11.75, 12.1, 12.5, 12.9, 13.4, 14.0, 14.6, 15.3, BaseSurface::kCrownLevel})
    levels.push_back(t);
  return levels;
}

int LastBelow(const std::vector<double>& values, double bound) {
  return static_cast<int>(std::upper_bound(values.begin(), values.end(), bound) - values.begin()) - 1;
}

constexpr int kMouthFreeRings = 4;
constexpr int kEyeFreeRings = 3;

// A hole of the grid: the cells between two columns and two rows.
struct Hole {
  int first_column, last_column, first_row, last_row;
  bool Contains(int column, int row) const {
    return column > first_column && column < last_column && row > first_row && row < last_row;
  }
};

// Springs between nodes; relaxation finds the section or level of every node that is not held.
class Springs {
 public:
  void Add(int a, int b, double stiffness) { springs_.push_back({a, b, stiffness}); }

  // Values at rest; `held` has a value for every node that does not move.
  std::vector<double> Relax(const std::vector<std::optional<double>>& held) const {
    std::vector<int> unknown(held.size(), -1);
    int size = 0;
    for (std::size_t i = 0; i < held.size(); ++i)
      if (!held[i]) unknown[i] = size++;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    const auto pull = [&](int node, int other, double stiffness) {
      if (unknown[node] < 0) return;
      entries.emplace_back(unknown[node], unknown[node], stiffness);
      if (held[other])
        right[unknown[node]] += stiffness * *held[other];
      else
        entries.emplace_back(unknown[node], unknown[other], -stiffness);
    };
    for (const Spring& spring : springs_) {
      pull(spring.a, spring.b, spring.stiffness);
      pull(spring.b, spring.a, spring.stiffness);
    }
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    ARTICAP_CHECK(solver.info() == Eigen::Success);
    const Eigen::VectorXd solution = solver.solve(right);
    std::vector<double> values(held.size());
    for (std::size_t i = 0; i < held.size(); ++i)
      values[i] = held[i] ? *held[i] : solution[unknown[i]];
    return values;
  }

 private:
  struct Spring {
    int a, b;
    double stiffness;
  };
  std::vector<Spring> springs_;
};

class LayoutMaker {
 public:
  explicit LayoutMaker(const BaseSurface& surface) : surface_(surface) {}

  SkinLayout Make() {
    MakeGrid();
    MakeMouthRings();
    MakeEyeRings();
    Hold();
    Relax();
    return std::move(layout_);
  }

 private:
  Hole MakeHole(double first_section, double last_section, double first_level, int num_rows) const {
    const int first_row = LastBelow(levels_, first_level);
    return {first_section < 0 ? -1 : LastBelow(sections_, first_section),
            LastBelow(sections_, last_section), first_row, first_row + num_rows};
  }

  void MakeGrid() {
    layout_.num_columns = static_cast<int>(sections_.size());
    layout_.num_rows = static_cast<int>(levels_.size());
    layout_.grid.assign(layout_.num_columns * layout_.num_rows, -1);
    for (int row = 0; row + 1 < layout_.num_rows; ++row)
      for (int column = 0; column < layout_.num_columns; ++column)
        if (!mouth_.Contains(column, row) && !eye_.Contains(column, row))
          layout_.grid[row * layout_.num_columns + column] =
              AddNode(sections_[column], levels_[row]);
    // All columns meet at the crown.
    const int crown = AddNode(0, levels_.back());
    std::fill(layout_.grid.end() - layout_.num_columns, layout_.grid.end(), crown);
  }

  int AddNode(double section, double level) {
    layout_.nodes.emplace_back(section, level);
    return static_cast<int>(layout_.nodes.size()) - 1;
  }

  void MakeMouthRings() {
    std::vector<int> edge;
    for (int c = 0; c <= mouth_.last_column; ++c) edge.push_back(layout_.At(c, mouth_.last_row));
    for (int r = mouth_.last_row - 1; r > mouth_.first_row; --r)
      edge.push_back(layout_.At(mouth_.last_column, r));
    for (int c = mouth_.last_column; c >= 0; --c) edge.push_back(layout_.At(c, mouth_.first_row));
    ARTICAP_CHECK_EQ(edge.size() % 2, 1u);
    layout_.mouth_corner = static_cast<int>(edge.size()) / 2;
    layout_.mouth_rings = AddRings(std::move(edge), kMouthFreeRings + 1);
  }

  void MakeEyeRings() {
    const int middle = (eye_.first_row + eye_.last_row) / 2;
    ARTICAP_CHECK_EQ(2 * middle, eye_.first_row + eye_.last_row);
    std::vector<int> edge;
    for (int r = middle; r > eye_.first_row; --r) edge.push_back(layout_.At(eye_.first_column, r));
    for (int c = eye_.first_column; c < eye_.last_column; ++c)
      edge.push_back(layout_.At(c, eye_.first_row));
    for (int r = eye_.first_row; r < eye_.last_row; ++r)
      edge.push_back(layout_.At(eye_.last_column, r));
    for (int c = eye_.last_column; c > eye_.first_column; --c)
      edge.push_back(layout_.At(c, eye_.last_row));
    for (int r = eye_.last_row; r > middle; --r) edge.push_back(layout_.At(eye_.first_column, r));
    layout_.eye_outer = static_cast<int>(edge.size()) / 2;
    layout_.eye_rings = AddRings(std::move(edge), kEyeFreeRings + 1);
  }

  std::vector<std::vector<int>> AddRings(std::vector<int> edge, int count) {
    std::vector<std::vector<int>> rings{std::move(edge)};
    for (int ring = 0; ring < count; ++ring) {
      rings.emplace_back();
      for (std::size_t k = 0; k < rings[0].size(); ++k) rings.back().push_back(AddNode(0, 0));
    }
    return rings;
  }

  void Hold() {
    sections_held_.resize(layout_.nodes.size());
    levels_held_.resize(layout_.nodes.size());
    const auto hold = [&](int node, const Eigen::Vector2d& at) {
      sections_held_[node] = at.x();
      levels_held_[node] = at.y();
    };
    const int last = layout_.num_columns - 1;
    for (int row = 0; row < layout_.num_rows; ++row) {
      if (layout_.At(0, row) >= 0) sections_held_[layout_.At(0, row)] = 0;
      sections_held_[layout_.At(last, row)] = BaseSurface::kBackSection;
      for (int c = 0; c <= last; ++c)
        if (row == 0 || row + 2 >= layout_.num_rows)
          hold(layout_.At(c, row), {sections_[c], levels_[row]});
    }
    for (const std::vector<int>& ring : layout_.mouth_rings)
      sections_held_[ring.front()] = sections_held_[ring.back()] = 0;
    HoldContours(hold);
    // All columns meet at the crown; where its section lies does not matter.
    hold(layout_.At(0, layout_.num_rows - 1), {0, levels_.back()});
  }

  template <class HoldNode>
  void HoldContours(const HoldNode& hold) {
    const auto front = [&](const Eigen::Vector2d& p) { return surface_.FindInFront(p.x(), p.y()); };
    const std::vector<int>& border = layout_.mouth_rings.back();
    const int corner = layout_.mouth_corner;
    for (int k = 0; k <= 2 * corner; ++k) {
      const double fraction = 1 - std::abs(k - corner) / static_cast<double>(corner);
      Eigen::Vector2d at = front(VermilionBorder(k <= corner ? Lip::kUpper : Lip::kLower, fraction));
      if (k == 0 || k == 2 * corner) at.x() = 0;
      hold(border[k], at);
    }
    const std::vector<int>& margin = layout_.eye_rings.back();
    const int outer = layout_.eye_outer;
    for (int k = 0; k < 2 * outer; ++k) {
      const double fraction = 1 - std::abs(k - outer) / static_cast<double>(outer);
      hold(margin[k], front(LidMargin(k <= outer ? Lid::kLower : Lid::kUpper, fraction)));
    }
  }

  // Stiffness such that the grid without holes would rest where it starts.
  void AddGridSprings(Springs& springs) const {
    const auto gap = [](const std::vector<double>& values, int i) {
      const int last = static_cast<int>(values.size()) - 1;
      return 0.5 * (values[std::min(i + 1, last)] - values[std::max(i - 1, 0)]);
    };
    for (int row = 0; row + 2 < layout_.num_rows; ++row)
      for (int column = 0; column < layout_.num_columns; ++column) {
        const int node = layout_.At(column, row);
        if (node < 0) continue;
        const int above = layout_.At(column, row + 1);
        if (above >= 0)
          springs.Add(node, above, gap(sections_, column) / (levels_[row + 1] - levels_[row]));
        if (column + 1 == layout_.num_columns) continue;
        const int beside = layout_.At(column + 1, row);
        if (beside >= 0)
          springs.Add(node, beside, gap(levels_, row) / (sections_[column + 1] - sections_[column]));
      }
  }

  static void AddRingSprings(const std::vector<std::vector<int>>& rings, bool closed,
                             Springs& springs) {
    const std::size_t size = rings[0].size();
    for (std::size_t ring = 1; ring < rings.size(); ++ring)
      for (std::size_t k = 0; k < size; ++k) {
        springs.Add(rings[ring - 1][k], rings[ring][k], 1);
        if (closed || k + 1 < size) springs.Add(rings[ring][k], rings[ring][(k + 1) % size], 0.5);
      }
  }

  void Relax() {
    Springs springs;
    AddGridSprings(springs);
    AddRingSprings(layout_.mouth_rings, false, springs);
    AddRingSprings(layout_.eye_rings, true, springs);
    const std::vector<double> sections = springs.Relax(sections_held_);
    const std::vector<double> levels = springs.Relax(levels_held_);
    for (std::size_t i = 0; i < layout_.nodes.size(); ++i)
      layout_.nodes[i] = {sections[i], levels[i]};
  }

  const BaseSurface& surface_;
  const std::vector<double> sections_ = ColumnSections();
  const std::vector<double> levels_ = RowLevels();
  const Hole mouth_ = MakeHole(-1, 1.46, 6.22, 10);
  const Hole eye_ = MakeHole(0.67, 2.23, 9.55, 6);
  SkinLayout layout_;
  std::vector<std::optional<double>> sections_held_;
  std::vector<std::optional<double>> levels_held_;
};

}  // namespace

SkinLayout MakeSkinLayout(const BaseSurface& surface) { return LayoutMaker(surface).Make(); }

}  // namespace articap
