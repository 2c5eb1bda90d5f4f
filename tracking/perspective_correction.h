// SPDX-License-Identifier: MIT
#pragma once

#include "core/camera.h"
#include "core/dots.h"
#include "core/options.h"
#include "tracking/perspective_bias.h"

namespace articap {

struct PerspectiveOptions {
  MarkerKind marker = MarkerKind::kDisc;
};
void VisitOptions(PerspectiveOptions& options, OptionVisitor& visit);

// Moves the middle of a dot to where the marker's own centre appears, and returns by how much, px.
// The dot itself says all that is needed: PerspectiveBias() depends on a marker's size and distance
// by their quotient only, which is the size of the dot.
//
// A disc whose dot is oval is turned in one of two ways, which are mirror images of one another
// about the line of sight, and a single picture does not say in which (D. Forsyth et al.,
// "Invariant descriptors for 3-D object recognition and pose", PAMI 13(10), 1991). The dot is moved
// by the mean of the two, and the half of their difference becomes part of its covariance.
//
// A dot outside what the lens shows stays as it is.
double CorrectPerspective(const Lens& lens, const PerspectiveOptions& options, Dot& dot);

}  // namespace articap
