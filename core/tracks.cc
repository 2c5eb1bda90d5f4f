// SPDX-License-Identifier: MIT
#include "core/tracks.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/check.h"

namespace articap {
namespace {

const Eigen::Vector3d kNowhere =
    Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());

}  // namespace

template <class Frame>
const float Tracks<Frame>::kUnknownSigma = std::numeric_limits<float>::quiet_NaN();

template <class Frame>
Tracks<Frame>::Tracks(std::vector<std::string> names, int num_frames, double rate_hz,
                      int first_frame, SessionTime start)
    : names_(std::move(names)),
      num_frames_(num_frames),
      rate_hz_(rate_hz),
      first_frame_(first_frame),
      start_(start) {
  ARTICAP_CHECK_GE(num_frames, 0);
  ARTICAP_CHECK_GT(rate_hz, 0);
  const std::size_t num_samples = names_.size() * static_cast<std::size_t>(num_frames);
  positions_mm_.assign(num_samples, kNowhere);
  sigmas_mm_.assign(num_samples, kUnknownSigma);
  states_.assign(num_samples, SampleState::kMissing);
}

template <class Frame>
std::optional<int> Tracks<Frame>::Find(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) return std::nullopt;
  return static_cast<int>(found - names_.begin());
}

template <class Frame>
void Tracks<Frame>::Set(int frame, int marker, const Eigen::Vector3d& position_mm,
                        SampleState state, float sigma_mm) {
  ARTICAP_CHECK(position_mm.allFinite() && state != SampleState::kMissing);
  const std::size_t index = Index(frame, marker);
  positions_mm_[index] = position_mm;
  sigmas_mm_[index] = sigma_mm;
  states_[index] = state;
}

template <class Frame>
void Tracks<Frame>::SetMissing(int frame, int marker) {
  const std::size_t index = Index(frame, marker);
  positions_mm_[index] = kNowhere;
  sigmas_mm_[index] = kUnknownSigma;
  states_[index] = SampleState::kMissing;
}

template <class Frame>
int Tracks<Frame>::CountMissing(int marker) const {
  int count = 0;
  for (int frame = 0; frame < num_frames_; ++frame) count += is_missing(frame, marker);
  return count;
}

template class Tracks<StageFrame>;
template class Tracks<HeadFrame>;
template class Tracks<RigFrame>;

RigTracks AlignToRig(const HeadTracks& tracks, const Sim3d& rig_from_head) {
  RigTracks aligned(tracks.names(), tracks.num_frames(), tracks.rate_hz(), tracks.first_frame(),
                    tracks.start());
  const float scale = static_cast<float>(rig_from_head.scale);
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    for (int marker = 0; marker < tracks.num_markers(); ++marker)
      if (!tracks.is_missing(frame, marker))
        aligned.Set(frame, marker, rig_from_head * tracks.position_mm(frame, marker),
                    tracks.state(frame, marker), scale * tracks.sigma_mm(frame, marker));
  return aligned;
}

}  // namespace articap
