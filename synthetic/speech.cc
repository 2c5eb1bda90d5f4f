// SPDX-License-Identifier: MIT
#include "synthetic/speech.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "synthetic/lip_gauge.h"
#include "synthetic/random_streams.h"
#include "synthetic/smooth_steps.h"

namespace articap {
namespace {

// How phones drive one parameter of the rig.
struct Articulator {
  const char* parameter;
  double PhoneModel::*target;  // null: only chance moves it
  double PhoneModel::*weight;
  double half_width_s;  // of the kernel: its SD is a third of this
  double variation;     // SD from token to token, as a fraction of the range
  double side;          // +1 left, -1 right
};

// Lips are quicker than the jaw; the jaw's slides are slowest.
constexpr Articulator kArticulators[] = {
    {"jaw_rotation", &PhoneModel::jaw, &PhoneModel::jaw_weight, 0.13, 0.06, 0},
    {"lip_rounding", &PhoneModel::rounding, &PhoneModel::lip_weight, 0.12, 0.06, 0},
    {"upper_lip_retraction", &PhoneModel::upper_retraction, &PhoneModel::lip_weight, 0.11, 0.14, 0},
    {"upper_lip_raise", &PhoneModel::upper_raise, &PhoneModel::lip_weight, 0.1, 0.08, 0},
    {"lower_lip_retraction", &PhoneModel::lower_retraction, &PhoneModel::lip_weight, 0.11, 0.14, 0},
    {"lower_lip_depression", &PhoneModel::lower_depression, &PhoneModel::lip_weight, 0.1, 0.08, 0},
    {"left_mouth_corner_stretch", &PhoneModel::spread, &PhoneModel::lip_weight, 0.12, 0.1, 1},
    {"right_mouth_corner_stretch", &PhoneModel::spread, &PhoneModel::lip_weight, 0.12, 0.1, -1},
    {"jaw_thrust", &PhoneModel::thrust, &PhoneModel::jaw_weight, 0.16, 0.2, 0},
    {"jaw_shift", nullptr, &PhoneModel::jaw_weight, 0.18, 0.35, 0},
};
constexpr double kLongestHalfWidth = 0.18;

// Parameters that decide whether the lips meet.
constexpr const char* kApertureParameters[] = {"jaw_rotation", "upper_lip_raise",
                                               "lower_lip_depression"};

constexpr double kReachLimit = 0.97;       // of the range, for targets
constexpr double kUnstressedReach = 0.8;   // of a target's size
constexpr double kSmallestGapMm = 1.2;     // of phones whose lips do not meet
constexpr double kContactMm = 3;           // openings below this feel the other lip
constexpr double kClosureMarginS = 0.025;  // the lips meet this long before and after the label
constexpr double kClosureRampS = 0.07;     // half of the time they take for it, where there is room

// A fraction of the range, in the parameter's unit.
double ValueOf(const RigParameter& range, double fraction) {
  const double limited = std::clamp(fraction, -kReachLimit, kReachLimit);
  return limited < 0 ? -limited * range.min : limited * range.max;
}

// Where lips would be that touch: 0 instead of a negative opening, with two continuous derivatives.
double AfterContact(double opening_mm) {
  if (opening_mm <= 0) return 0;
  if (opening_mm >= kContactMm) return opening_mm;
  const double x = opening_mm / kContactMm;
  return kContactMm * x * x * x * (6 + x * (-8 + 3 * x));
}

// Lips that are shut: parameter values that take over while they are.
struct Closure {
  double begin_s = 0;
  double end_s = 0;
  Eigen::VectorXd parameters;

  double ramp_s() const { return std::min(kClosureRampS, 0.45 * (end_s - begin_s)); }
  // 0 outside, 1 while the lips are shut.
  double At(double time_s) const {
    return TriweightStep((time_s - begin_s) / ramp_s()) -
           TriweightStep((time_s - end_s) / ramp_s());
  }
};

class Speaker {
 public:
  Speaker(const FaceRig& rig, const SyntheticSpeechOptions& options, RandomGenerator& random)
      : options_(options),
        random_(random),
        ranges_(rig.definition().parameters),
        lips_(LipGauge::Create(rig)),
        stronger_side_(random.Happens(0.5) ? 1 : -1) {
    for (const Articulator& articulator : kArticulators)
      if (const auto parameter = rig.FindParameter(articulator.parameter)) {
        moved_.push_back({*parameter, &articulator});
        courses_.emplace_back(articulator.half_width_s);
      }
    for (const char* name : kApertureParameters)
      if (const auto parameter = rig.FindParameter(name)) aperture_.push_back(*parameter);
  }

  Eigen::MatrixXd Speak(const Utterances& utterances) {
    for (const PhoneToken& token : utterances.phones) AddTargets(token);
    for (const PhoneToken& token : utterances.phones)
      if (lips_ && token.phone && token.phone->contact == LipContact::kLipToLip) AddClosure(token);
    return Sample(utterances.duration_s);
  }

 private:
  struct Moved {
    int parameter;
    const Articulator* articulator;
  };

  void AddTargets(const PhoneToken& token) {
    const Eigen::VectorXd targets = TargetsOf(token);
    for (std::size_t i = 0; i < moved_.size(); ++i)
      courses_[i].Add(token.end_s, targets[moved_[i].parameter],
                      token.phone ? token.phone->*moved_[i].articulator->weight : 1);
  }

  Eigen::VectorXd TargetsOf(const PhoneToken& token) {
    Eigen::VectorXd targets = Eigen::VectorXd::Zero(static_cast<int>(ranges_.size()));
    if (!token.phone) return targets;
    const double reach = options_.effort * (token.stressed ? 1 : kUnstressedReach);
    for (const Moved& moved : moved_) {
      const Articulator& articulator = *moved.articulator;
      double fraction = articulator.target ? token.phone->*articulator.target : 0;
      fraction *= reach * (1 + articulator.side * stronger_side_ * options_.asymmetry / 2);
      fraction += options_.effort * options_.variation * articulator.variation * random_.Normal();
      targets[moved.parameter] = ValueOf(ranges_[moved.parameter], fraction);
    }
    if (lips_) KeepLipsApart(*token.phone, &targets);
    return targets;
  }

  void KeepLipsApart(const PhoneModel& phone, Eigen::VectorXd* targets) const {
    if (phone.contact == LipContact::kLipToLip)
      lips_->SetOpening(0, targets);
    else if (lips_->OpeningMm(*targets) < kSmallestGapMm)
      lips_->SetOpening(kSmallestGapMm, targets);
  }

  // The targets alone leave the lips ajar, because neighbours pull at them.
  void AddClosure(const PhoneToken& token) {
    Eigen::VectorXd parameters = Eigen::VectorXd::Zero(static_cast<int>(ranges_.size()));
    for (std::size_t i = 0; i < moved_.size(); ++i)
      parameters[moved_[i].parameter] = courses_[i].At(token.center_s());
    lips_->SetOpening(0, &parameters);
    closures_.push_back(
        {token.begin_s - kClosureMarginS, token.end_s + kClosureMarginS, parameters});
  }

  Eigen::MatrixXd Sample(double duration_s) const {
    const int num_frames = 1 + static_cast<int>(std::floor(duration_s * options_.rate_hz));
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(num_frames, static_cast<int>(ranges_.size()));
    for (int frame = 0; frame < num_frames; ++frame)
      for (std::size_t i = 0; i < moved_.size(); ++i)
        values(frame, moved_[i].parameter) = courses_[i].At(frame / options_.rate_hz);
    for (const Closure& closure : closures_) Close(closure, &values);
    if (lips_) KeepLipsFromCrossing(&values);
    return values;
  }

  // Lip and jaw move at different speeds, so that the lips may cross on the way between poses in
  // which they do not: the lower lip then rests against the upper.
  void KeepLipsFromCrossing(Eigen::MatrixXd* values) const {
    for (int frame = 0; frame < values->rows(); ++frame) {
      Eigen::VectorXd parameters = values->row(frame);
      const double opening_mm = lips_->OpeningMm(parameters);
      if (opening_mm == 0 || opening_mm >= kContactMm) continue;
      lips_->SetOpening(AfterContact(opening_mm), &parameters);
      values->row(frame) = parameters;
    }
  }

  void Close(const Closure& closure, Eigen::MatrixXd* values) const {
    const double rate_hz = options_.rate_hz;
    const int first =
        std::max(0, static_cast<int>(std::ceil((closure.begin_s - closure.ramp_s()) * rate_hz)));
    const int last =
        std::min(static_cast<int>(values->rows()) - 1,
                 static_cast<int>(std::floor((closure.end_s + closure.ramp_s()) * rate_hz)));
    for (int frame = first; frame <= last; ++frame) {
      const double closed = closure.At(frame / rate_hz);
      for (const int parameter : aperture_) {
        double& value = (*values)(frame, parameter);
        value += closed * (closure.parameters[parameter] - value);
      }
    }
  }

  const SyntheticSpeechOptions& options_;
  RandomGenerator& random_;
  std::vector<RigParameter> ranges_;
  std::optional<LipGauge> lips_;
  double stronger_side_;
  std::vector<Moved> moved_;
  std::vector<SmoothSteps> courses_;  // of moved_
  std::vector<int> aperture_;
  std::vector<Closure> closures_;
};

const char* UnitName(ParameterUnit unit) {
  switch (unit) {
    case ParameterUnit::kRadian:
      return "rad";
    case ParameterUnit::kMillimetre:
      return "mm";
    case ParameterUnit::kWeight:
      return "1";
  }
  return "1";
}

// Labels by frame; a frame at a boundary belongs to the phone that begins there.
std::vector<std::string> PhonesOfFrames(const Utterances& utterances, int num_frames,
                                        double rate_hz) {
  std::vector<std::string> labels;
  std::size_t token = 0;
  for (int frame = 0; frame < num_frames; ++frame) {
    while (token + 1 < utterances.phones.size() &&
           utterances.phones[token].end_s <= frame / rate_hz)
      ++token;
    labels.emplace_back(utterances.phones[token].name());
  }
  return labels;
}

}  // namespace

void VisitOptions(SyntheticSpeechOptions& options, OptionVisitor& visit) {
  visit("sentences", options.num_sentences, "number of sentences");
  visit("rate_hz", options.rate_hz, "frames a second");
  visit("tempo", options.tempo, "tempo of the phones; 1 is a careful reader");
  visit("pause_s", options.pause_s, "mean pause between sentences; s");
  visit("rest_s", options.rest_s, "exact rest before the first and after the last sentence; s");
  visit("effort", options.effort, "reach of the targets; 1 uses most of every range");
  visit("variation", options.variation, "how much a phone differs from one time to the next");
  visit("asymmetry", options.asymmetry, "how much more one mouth corner moves than the other");
}

SyntheticSpeech SynthesizeSpeech(const FaceRig& rig, const SyntheticSpeechOptions& options,
                                 std::uint64_t seed) {
  SyntheticSpeech speech;
  RandomGenerator text_random(seed, random_streams::kText);
  UtteranceOptions text;
  text.num_sentences = options.num_sentences;
  text.tempo = options.tempo;
  text.pause_s = options.pause_s;
  // Movements begin before their phones, by at most the half width of the kernel.
  text.lead_in_s = options.rest_s + kLongestHalfWidth + kClosureMarginS;
  speech.utterances = ComposeUtterances(text, text_random);

  RandomGenerator speaker_random(seed, random_streams::kArticulation);
  ParameterTrack& track = speech.track;
  track.values = Speaker(rig, options, speaker_random).Speak(speech.utterances);
  for (const RigParameter& parameter : rig.definition().parameters) {
    track.names.push_back(parameter.name);
    track.units.push_back(UnitName(parameter.unit));
  }
  track.rate_hz = options.rate_hz;
  track.sigmas = Eigen::MatrixXd::Zero(track.values.rows(), track.values.cols());
  track.residuals_mm.assign(track.values.rows(), 0);
  track.statuses.assign(track.values.rows(), FitStatus::kOk);
  track.phones = PhonesOfFrames(speech.utterances, track.num_frames(), options.rate_hz);
  return speech;
}

TextGrid LabelsOf(const Utterances& utterances) {
  TextGridTier words{.name = "words", .labels = {}};
  double end_s = 0;
  for (const WordToken& word : utterances.words) {
    if (word.begin_s > end_s) words.labels.push_back({end_s, word.begin_s, ""});
    words.labels.push_back({word.begin_s, word.end_s, word.spelling});
    end_s = word.end_s;
  }
  if (end_s < utterances.duration_s) words.labels.push_back({end_s, utterances.duration_s, ""});

  TextGridTier phones{.name = "phones", .labels = {}};
  for (const PhoneToken& token : utterances.phones)
    phones.labels.push_back({token.begin_s, token.end_s, std::string(token.name())});

  TextGrid grid;
  grid.end_s = utterances.duration_s;
  grid.tiers = {std::move(words), std::move(phones)};
  return grid;
}

}  // namespace articap
