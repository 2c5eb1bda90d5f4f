// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace articap {

// Synthetic scenes, solved, as CalibrationJson() writes them; corners with a noise of 0.1 px.

// One camera and 30 views, of which two do not fit and are set aside; the board never comes to the
// right edge. Names from files that would be mischief if a page took them for HTML.
std::string SampleLensJson();
std::string SampleRigJson();      // four cameras
std::string SampleMirrorJson();   // a camera and a mirror
std::string SampleWandJson();     // four cameras that are not synchronous
std::string SampleBlurredJson();  // a lens that is not usable

}  // namespace articap
