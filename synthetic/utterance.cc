// SPDX-License-Identifier: MIT
#include "synthetic/utterance.h"

#include <algorithm>

namespace articap {
namespace {

// Deals each phone as often as it has tokens before shuffling again.
class Deck {
 public:
  Deck(bool vowels, RandomGenerator& random) : random_(random) {
    for (const PhoneModel& phone : Phones())
      if (phone.vowel == vowels) cards_.insert(cards_.end(), phone.tokens, &phone);
    next_ = cards_.size();
  }

  const PhoneModel* Deal() {
    if (next_ == cards_.size()) {
      random_.Shuffle(cards_);
      next_ = 0;
    }
    return cards_[next_++];
  }

 private:
  RandomGenerator& random_;
  std::vector<const PhoneModel*> cards_;
  std::size_t next_ = 0;
};

struct Syllable {
  std::vector<const PhoneModel*> phones;
  bool stressed = false;
};

std::string SpellingOf(const std::vector<Syllable>& word) {
  std::string spelling;
  for (const Syllable& syllable : word) {
    if (!spelling.empty()) spelling += '-';
    for (const PhoneModel* phone : syllable.phones)
      for (const char letter : phone->name) spelling += static_cast<char>(letter - 'A' + 'a');
  }
  return spelling;
}

class Composer {
 public:
  Composer(const UtteranceOptions& options, RandomGenerator& random)
      : options_(options), random_(random), vowels_(true, random), consonants_(false, random) {}

  Utterances Compose() {
    AddPause(options_.lead_in_s);
    for (int sentence = 0; sentence < options_.num_sentences; ++sentence) {
      if (sentence > 0) AddPause(options_.pause_s * random_.Uniform(0.7, 1.3));
      AddSentence();
    }
    AddPause(options_.lead_in_s);
    out_.duration_s = now_s_;
    return std::move(out_);
  }

 private:
  void AddSentence() {
    const int num_words = 5 + random_.Index(4);
    for (int i = 0; i < num_words; ++i) AddWord(i + 1 == num_words);
  }

  std::vector<Syllable> MakeWord() {
    const int num_syllables = 1 + random_.Index(3);
    const int stressed = random_.Index(num_syllables);
    std::vector<Syllable> word;
    for (int i = 0; i < num_syllables; ++i) {
      Syllable syllable{{}, i == stressed};
      if (random_.Happens(0.9)) syllable.phones.push_back(consonants_.Deal());
      syllable.phones.push_back(vowels_.Deal());
      if (random_.Happens(0.4)) syllable.phones.push_back(consonants_.Deal());
      word.push_back(std::move(syllable));
    }
    return word;
  }

  void AddWord(bool last_of_sentence) {
    const std::vector<Syllable> word = MakeWord();
    const double begin_s = now_s_;
    for (std::size_t i = 0; i < word.size(); ++i)
      for (const PhoneModel* phone : word[i].phones)
        AddPhone(*phone, word[i].stressed, last_of_sentence && i + 1 == word.size());
    out_.words.push_back({SpellingOf(word), begin_s, now_s_});
  }

  void AddPhone(const PhoneModel& phone, bool stressed, bool sentence_final) {
    double percentage = phone.vowel ? (stressed ? 0.95 : 0.5) : (stressed ? 0.9 : 0.7);
    if (sentence_final) percentage *= 1.4;  // Klatt's clause-final lengthening
    percentage *= random_.Uniform(0.75, 1.25) / options_.tempo;
    const double duration_s =
        1e-3 * (phone.minimum_ms + (phone.inherent_ms - phone.minimum_ms) * percentage);
    const int word = static_cast<int>(out_.words.size());
    out_.phones.push_back({&phone, now_s_, now_s_ + duration_s, stressed, word});
    now_s_ += duration_s;
  }

  void AddPause(double duration_s) {
    out_.phones.push_back({nullptr, now_s_, now_s_ + duration_s, false, -1});
    now_s_ += duration_s;
  }

  const UtteranceOptions& options_;
  RandomGenerator& random_;
  Deck vowels_;
  Deck consonants_;
  Utterances out_;
  double now_s_ = 0;
};

}  // namespace

Utterances ComposeUtterances(const UtteranceOptions& options, RandomGenerator& random) {
  return Composer(options, random).Compose();
}

}  // namespace articap
