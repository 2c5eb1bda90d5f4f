// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace articap {

// What a phone asks of the lips beyond its targets.
enum class LipContact : std::uint8_t {
  kNone,
  kLipToLip,    // closed while it lasts: P, B, M
  kLipToTeeth,  // lower lip under the upper incisors: F, V
};

// A phone of the synthetic speaker's small inventory. Targets are fractions of a parameter's
// range: +1 its maximum, -1 its minimum.
struct PhoneModel {
  std::string_view name;  // ARPAbet, without stress
  bool vowel = false;
  LipContact contact = LipContact::kNone;
  int tokens = 1;  // how often it is in the deck that sentences are dealt from
  double inherent_ms = 0;
  double minimum_ms = 0;
  // How firmly it holds the jaw and the lips against its neighbours.
  double jaw_weight = 1;
  double lip_weight = 1;
  // Targets.
  double jaw = 0;
  double rounding = 0;
  double spread = 0;  // of both mouth corners
  double upper_retraction = 0;
  double upper_raise = 0;
  double lower_retraction = 0;
  double lower_depression = 0;
  double thrust = 0;
};

// Durations: inherent and minimum durations of Klatt's rules (Klatt 1979; Allen, Hunnicutt and
// Klatt 1987, From Text to Speech: the MITalk system, chapter 9), as tabulated in the Festival
// speech synthesis system (klatt_durs). Targets: this project's own, after the usual descriptions
// of visemes: height of vowels on the jaw, rounding and protrusion of back vowels, W, R and the
// postalveolars, a raised jaw for the sibilants, thrust forward (Mooshammer et al. 2007).
std::span<const PhoneModel> Phones();

// The label of pauses.
inline constexpr std::string_view kSilence = "SIL";

}  // namespace articap
