// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <nlopt.hpp>
#include <vector>

namespace articap {

struct PraxisResult {
  double objective = 0;
  int evaluations = 0;
};

// Brent's PRAXIS, a direction-set method in the line of Powell's, which Beskow used: without
// bounds, from *x, which it overwrites with the best point.
inline PraxisResult MinimizeWithPraxis(
    const std::function<double(const std::vector<double>&)>& objective,
    const std::vector<double>& steps, int max_evaluations, std::vector<double>* x) {
  struct Call {
    const std::function<double(const std::vector<double>&)>& objective;
    int evaluations = 0;
    static double Evaluate(const std::vector<double>& point, std::vector<double>&, void* data) {
      Call& call = *static_cast<Call*>(data);
      ++call.evaluations;
      return call.objective(point);
    }
  } call{objective};
  nlopt::srand(1);
  nlopt::opt praxis(nlopt::LN_PRAXIS, static_cast<unsigned>(x->size()));
  praxis.set_min_objective(&Call::Evaluate, &call);
  praxis.set_initial_step(steps);
  praxis.set_ftol_rel(1e-10);
  praxis.set_maxeval(max_evaluations);
  double best = 0;
  try {
    praxis.optimize(*x, best);
  } catch (const nlopt::roundoff_limited&) {
    // The best point so far stands.
    best = objective(*x);
  }
  return {best, call.evaluations};
}

}  // namespace articap
