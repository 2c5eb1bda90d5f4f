// SPDX-License-Identifier: MIT
#include "tracking/assignment.h"

#include <limits>

namespace articap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Columns beyond those of `costs` are each row's own way to stay alone.
class Assignment {
 public:
  Assignment(const Eigen::MatrixXd& costs, double null_cost)
      : costs_(costs),
        null_cost_(null_cost),
        num_rows_(static_cast<int>(costs.rows())),
        num_columns_(static_cast<int>(costs.cols()) + num_rows_),
        row_potential_(num_rows_, 0),
        column_potential_(num_columns_, 0),
        row_of_column_(num_columns_, -1) {}

  std::vector<int> Solve() {
    for (int row = 0; row < num_rows_; ++row) Augment(row);
    std::vector<int> column_of_row(num_rows_, -1);
    for (int column = 0; column < costs_.cols(); ++column)
      if (row_of_column_[column] >= 0) column_of_row[row_of_column_[column]] = column;
    return column_of_row;
  }

 private:
  double CostOf(int row, int column) const {
    if (column < costs_.cols()) return costs_(row, column);
    return column - costs_.cols() == row ? null_cost_ : kInfinity;
  }

  // The cheapest way for a row to get a column, at which others may have to give theirs away.
  void Augment(int start_row) {
    std::vector<double> distance(num_columns_, kInfinity);
    std::vector<int> from_column(num_columns_, -1);
    std::vector<char> done(num_columns_, 0);
    int row = start_row, last = -1;
    double reached = 0;
    while (true) {
      int next = -1;
      for (int column = 0; column < num_columns_; ++column) {
        if (done[column]) continue;
        const double through =
            reached + CostOf(row, column) - row_potential_[row] - column_potential_[column];
        if (through < distance[column]) {
          distance[column] = through;
          from_column[column] = last;
        }
        if (next < 0 || distance[column] < distance[next]) next = column;
      }
      done[next] = 1;
      reached = distance[next];
      last = next;
      if (row_of_column_[next] < 0) break;
      row = row_of_column_[next];
    }
    UpdatePotentials(start_row, distance, done, reached);
    for (int column = last; column >= 0; column = from_column[column])
      row_of_column_[column] =
          from_column[column] >= 0 ? row_of_column_[from_column[column]] : start_row;
  }

  void UpdatePotentials(int start_row, const std::vector<double>& distance,
                        const std::vector<char>& done, double reached) {
    row_potential_[start_row] += reached;
    for (int column = 0; column < num_columns_; ++column) {
      if (!done[column]) continue;
      const double slack = reached - distance[column];
      column_potential_[column] -= slack;
      if (row_of_column_[column] >= 0) row_potential_[row_of_column_[column]] += slack;
    }
  }

  const Eigen::MatrixXd& costs_;
  double null_cost_;
  int num_rows_;
  int num_columns_;
  std::vector<double> row_potential_;
  std::vector<double> column_potential_;
  std::vector<int> row_of_column_;
};

}  // namespace

std::vector<int> Assign(const Eigen::MatrixXd& costs, double null_cost) {
  return Assignment(costs, null_cost).Solve();
}

}  // namespace articap
