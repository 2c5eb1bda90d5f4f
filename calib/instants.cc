// SPDX-License-Identifier: MIT
#include "calib/instants.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>
#include <utility>

#include "core/statistics.h"

namespace articap {

double UsualInterval_s(std::vector<SessionTime> times) {
  std::sort(times.begin(), times.end());
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double interval_s = SecondsOf(times[i]) - SecondsOf(times[i - 1]);
    if (interval_s > 0) intervals_s.push_back(interval_s);
  }
  if (intervals_s.empty()) return 1;
  // Where every other picture is lost, the median is two intervals; the quartile is one still.
  const double about_s = QuantileOf(intervals_s, 0.25);
  std::erase_if(intervals_s, [&](double interval_s) {
    return interval_s < 0.5 * about_s || interval_s > 1.5 * about_s;
  });
  return std::accumulate(intervals_s.begin(), intervals_s.end(), 0.0) /
         static_cast<double>(intervals_s.size());
}

InstantTable InstantsByFrame(const std::vector<CameraSightings>& cameras) {
  std::set<std::int64_t> frames;
  for (const CameraSightings& camera : cameras)
    for (const BoardSighting& sighting : camera.sightings) frames.insert(sighting.frame);
  InstantTable instants;
  for (int camera = 0; camera < static_cast<int>(cameras.size()); ++camera)
    for (int i = 0; i < static_cast<int>(cameras[camera].sightings.size()); ++i) {
      const auto frame = frames.find(cameras[camera].sightings[i].frame);
      instants[{camera, i}] = {static_cast<int>(std::distance(frames.begin(), frame)), 0};
    }
  return instants;
}

InstantTable InstantsByTime(const std::vector<std::vector<SessionTime>>& times_of_cameras) {
  const std::vector<SessionTime>& first = times_of_cameras.front();
  const double start_s = SecondsOf(first.front());
  const double interval_s = UsualInterval_s(first);
  std::map<SightingKey, std::int64_t> steps;
  for (int camera = 0; camera < static_cast<int>(times_of_cameras.size()); ++camera)
    for (int i = 0; i < static_cast<int>(times_of_cameras[camera].size()); ++i)
      steps[{camera, i}] =
          std::llround((SecondsOf(times_of_cameras[camera][i]) - start_s) / interval_s);
  std::set<std::int64_t> used;
  for (const auto& [key, step] : steps) used.insert(step);
  InstantTable instants;
  for (const auto& [key, step] : steps)
    instants[key] = {static_cast<int>(std::distance(used.begin(), used.find(step))),
                     start_s + static_cast<double>(step) * interval_s};
  return instants;
}

InstantTable InstantsByTime(const std::vector<CameraSightings>& cameras) {
  std::vector<std::vector<SessionTime>> times;
  for (const CameraSightings& camera : cameras) {
    times.emplace_back();
    for (const BoardSighting& sighting : camera.sightings) times.back().push_back(sighting.time);
  }
  return InstantsByTime(times);
}

}  // namespace articap
