// SPDX-License-Identifier: MIT
#include "core/text_grid.h"

#include <fmt/format.h>
#include <unicode/ucnv.h>
#include <unicode/unistr.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "core/check.h"
#include "core/file_io.h"
#include "core/io/text.h"

namespace articap {
namespace {

// Text encodings.

std::string ConvertToUtf8(std::string_view bytes, const char* encoding) {
  const icu::UnicodeString text(bytes.data(), static_cast<int32_t>(bytes.size()), encoding);
  std::string utf8;
  text.toUTF8String(utf8);
  return utf8;
}

// Praat's files begin with "File type" or, in old short files, with a quote: ASCII, whose zero
// bytes betray UTF-16 without a byte order mark.
const char* Utf16Of(std::string_view bytes) {
  if (bytes.starts_with("\xFE\xFF")) return "UTF-16BE";
  if (bytes.starts_with("\xFF\xFE")) return "UTF-16LE";
  if (bytes.size() < 2) return nullptr;
  if (bytes[0] == '\0' && bytes[1] != '\0') return "UTF-16BE";
  if (bytes[0] != '\0' && bytes[1] == '\0') return "UTF-16LE";
  return nullptr;
}

std::string DecodeText(std::string_view bytes, const std::string& source_name,
                       std::vector<std::string>& warnings) {
  constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";
  constexpr std::string_view kReplacement = "\xEF\xBF\xBD";
  if (const char* encoding = Utf16Of(bytes)) {
    std::string utf8 = ConvertToUtf8(bytes, encoding);
    if (utf8.starts_with(kUtf8Mark)) utf8.erase(0, kUtf8Mark.size());
    if (utf8.find(kReplacement) != std::string::npos || bytes.size() % 2 != 0)
      warnings.push_back(fmt::format(
          "{}: some of its {} is damaged; what could not be read became the character U+FFFD",
          source_name, encoding));
    return utf8;
  }
  if (bytes.starts_with(kUtf8Mark)) bytes.remove_prefix(kUtf8Mark.size());
  if (IsUtf8(bytes)) return std::string(bytes);
  warnings.push_back(
      fmt::format("{}: is not UTF-8; it was read as Latin-1, so look whether its accents are right "
                  "(or save it in Praat as UTF-8)",
                  source_name));
  return ConvertToUtf8(bytes, "ISO-8859-1");
}

// Praat reads free-standing numbers, texts in double quotes and flags in angle brackets; all else
// is there for people. That is why one reader serves the long and the short form.
struct Token {
  enum class Kind : std::uint8_t { kNumber, kText, kFlag, kEnd };
  Kind kind = Kind::kEnd;
  double number = 0;
  std::string text;
};

class TokenReader {
 public:
  TokenReader(std::string_view text, std::string source_name)
      : text_(text), source_name_(std::move(source_name)) {}

  Result<Token> Next();
  Result<double> NextNumber(const char* what);
  Result<std::string> NextText(const char* what);
  Result<std::string> NextFlag(const char* what);
  Result<std::size_t> NextCount(const char* what);

  tl::unexpected<Error> FailHere(const std::string& message) const {
    return Fail(fmt::format("{}:{}: {}", source_name_, token_line_, message));
  }

 private:
  Result<Token> QuotedText();
  Result<Token> NextOfKind(Token::Kind kind, const char* what);
  static bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

  std::string_view text_;
  std::string source_name_;
  std::size_t position_ = 0;
  int line_ = 1;
  int token_line_ = 1;
};

Result<Token> TokenReader::QuotedText() {
  Token token{Token::Kind::kText, 0, {}};
  ++position_;
  while (true) {
    const std::size_t quote = text_.find('"', position_);
    if (quote == std::string_view::npos)
      return FailHere("a text in quotes does not end; the file is cut short or a quote is missing");
    const std::string_view piece = text_.substr(position_, quote - position_);
    line_ += static_cast<int>(std::count(piece.begin(), piece.end(), '\n'));
    token.text += piece;
    position_ = quote + 1;
    if (position_ >= text_.size() || text_[position_] != '"') return token;
    token.text += '"';
    ++position_;
  }
}

Result<Token> TokenReader::Next() {
  while (position_ < text_.size()) {
    token_line_ = line_;
    const char c = text_[position_];
    if (IsSpace(c)) {
      line_ += c == '\n';
      ++position_;
    } else if (c == '"') {
      return QuotedText();
    } else if (c == '!') {  // a comment, to the end of the line
      position_ = std::min(text_.find('\n', position_), text_.size());
    } else if (c == '<') {
      const std::size_t end = text_.find_first_of(">\n", position_);
      if (end == std::string_view::npos || text_[end] == '\n')
        return FailHere("a flag such as <exists> does not end");
      Token token{Token::Kind::kFlag, 0, std::string(text_.substr(position_, end + 1 - position_))};
      position_ = end + 1;
      return token;
    } else {
      const std::size_t end = std::min(text_.find_first_of(" \t\r\n\"", position_), text_.size());
      std::string_view word = text_.substr(position_, end - position_);
      position_ = end;
      if (word.starts_with('+')) word.remove_prefix(1);
      Token token{Token::Kind::kNumber, 0, {}};
      const auto parsed = std::from_chars(word.data(), word.data() + word.size(), token.number);
      if (parsed.ec == std::errc() && parsed.ptr == word.data() + word.size() &&
          std::isfinite(token.number))
        return token;
    }
  }
  token_line_ = line_;
  return Token{};
}

Result<Token> TokenReader::NextOfKind(Token::Kind kind, const char* what) {
  constexpr const char* kNames[] = {"number", "text in quotes", "flag", "end of the file"};
  auto token = Next();
  if (!token) return token;
  if (token->kind == kind) return token;
  const std::string found =
      token->kind == Token::Kind::kNumber ? fmt::format("the number {}", token->number)
      : token->kind == Token::Kind::kEnd  ? std::string("the end of the file")
                                          : fmt::format("'{}'", token->text.substr(0, 40));
  return FailHere(fmt::format("{} should be here, a {}, but there is {}", what,
                              kNames[static_cast<int>(kind)], found));
}

Result<double> TokenReader::NextNumber(const char* what) {
  const auto token = NextOfKind(Token::Kind::kNumber, what);
  if (!token) return tl::unexpected(token.error());
  return token->number;
}

Result<std::string> TokenReader::NextText(const char* what) {
  auto token = NextOfKind(Token::Kind::kText, what);
  if (!token) return tl::unexpected(token.error());
  return std::move(token->text);
}

Result<std::string> TokenReader::NextFlag(const char* what) {
  auto token = NextOfKind(Token::Kind::kFlag, what);
  if (!token) return tl::unexpected(token.error());
  return std::move(token->text);
}

Result<std::size_t> TokenReader::NextCount(const char* what) {
  constexpr double kMost = 1e9;
  const auto number = NextNumber(what);
  if (!number) return tl::unexpected(number.error());
  if (!(*number >= 0 && *number <= kMost) || *number != std::floor(*number))
    return FailHere(fmt::format("{} is {}, which is no count", what, *number));
  return static_cast<std::size_t>(*number);
}

// "ooTextFile" and "TextGrid", then times, <exists> and the number of tiers.
Result<void> ReadFileType(TokenReader& reader) {
  const auto file_type = reader.Next();
  if (!file_type) return tl::unexpected(file_type.error());
  if (!file_type->text.starts_with("ooTextFile"))
    return reader.FailHere("is not a Praat text file: it does not begin with \"ooTextFile\"");
  const auto object_class = reader.NextText("the class of the object");
  if (!object_class) return tl::unexpected(object_class.error());
  if (!object_class->starts_with("TextGrid"))
    return reader.FailHere(
        fmt::format("holds a {}, not a TextGrid; save the TextGrid in Praat", *object_class));
  return {};
}

Result<TextGridLabel> ReadLabel(TokenReader& reader, TextGridTier::Kind kind) {
  TextGridLabel label;
  const bool is_interval = kind == TextGridTier::Kind::kIntervals;
  const auto start_s =
      reader.NextNumber(is_interval ? "the start of an interval" : "the time of a point");
  if (!start_s) return tl::unexpected(start_s.error());
  label.start_s = label.end_s = *start_s;
  if (is_interval) {
    const auto end_s = reader.NextNumber("the end of an interval");
    if (!end_s) return tl::unexpected(end_s.error());
    label.end_s = *end_s;
  }
  auto text = reader.NextText("the label");
  if (!text) return tl::unexpected(text.error());
  label.text = std::move(*text);
  return label;
}

Result<TextGridTier> ReadTier(TokenReader& reader) {
  TextGridTier tier;
  const auto kind = reader.NextText("the class of a tier");
  if (!kind) return tl::unexpected(kind.error());
  if (*kind != "IntervalTier" && *kind != "TextTier")
    return reader.FailHere(
        fmt::format("a tier has the class '{}'; only IntervalTier and TextTier are known", *kind));
  tier.kind = *kind == "TextTier" ? TextGridTier::Kind::kPoints : TextGridTier::Kind::kIntervals;
  auto name = reader.NextText("the name of a tier");
  if (!name) return tl::unexpected(name.error());
  tier.name = std::move(*name);
  for (const char* what : {"the start of a tier", "the end of a tier"})
    if (const auto time = reader.NextNumber(what); !time) return tl::unexpected(time.error());
  const auto count = reader.NextCount("the number of labels");
  if (!count) return tl::unexpected(count.error());
  for (std::size_t i = 0; i < *count; ++i) {
    auto label = ReadLabel(reader, tier.kind);
    if (!label) return tl::unexpected(label.error());
    if (label->end_s < label->start_s)
      return reader.FailHere(
          fmt::format("label {} of tier '{}' ends ({} s) before it starts ({} s)", i + 1, tier.name,
                      label->end_s, label->start_s));
    // Praat itself writes neighbours whose times differ in the last digits.
    constexpr double kRoundingSeconds = 1e-6;
    if (!tier.labels.empty() && label->start_s < tier.labels.back().end_s - kRoundingSeconds)
      return reader.FailHere(
          fmt::format("label {} of tier '{}' starts at {} s, before the one before it ends ({} s)",
                      i + 1, tier.name, label->start_s, tier.labels.back().end_s));
    tier.labels.push_back(std::move(*label));
  }
  return tier;
}

std::string LowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

// "phones", and, as aligners prefix the speaker, "Anna - phones" or "Anna_phones".
bool SaysPhones(std::string_view tier_name) {
  const std::string lower = LowerCase(tier_name);
  for (const std::string_view word : {"phone", "phones", "phon", "phoneme", "phonemes", "phns",
                                      "segment", "segments", "seg", "mau", "sampa", "x-sampa"}) {
    if (!lower.ends_with(word)) continue;
    const std::size_t prefix = lower.size() - word.size();
    if (prefix == 0 || std::string_view(" -_:/.").find(lower[prefix - 1]) != std::string_view::npos)
      return true;
  }
  return false;
}

std::string TierNames(const TextGrid& grid) {
  if (grid.tiers.empty()) return "the TextGrid has no tiers";
  std::string names;
  for (const TextGridTier& tier : grid.tiers)
    names += fmt::format("{}'{}'{}", names.empty() ? "" : ", ", tier.name,
                         tier.kind == TextGridTier::Kind::kPoints ? " (points)" : "");
  return "the tiers are " + names;
}

std::vector<std::string> LabelsOfPoints(const TextGridTier& tier,
                                        std::span<const SessionTime> times) {
  std::vector<std::string> labels(times.size());
  if (times.empty()) return labels;
  for (const TextGridLabel& point : tier.labels) {
    const auto is_before = [](SessionTime time, double point_s) {
      return SecondsOf(time) < point_s;
    };
    auto nearest = std::lower_bound(times.begin(), times.end(), point.start_s, is_before);
    const bool is_first = nearest == times.begin();
    if (nearest == times.end() ||
        (!is_first && point.start_s - SecondsOf(nearest[-1]) < SecondsOf(*nearest) - point.start_s))
      if (!is_first) --nearest;
    // A point outside the take belongs to no frame; half a frame beyond its ends still does.
    const double half_step_s =
        times.size() < 2 ? 0 : (SecondsOf(times[1]) - SecondsOf(times[0])) / 2;
    if (std::abs(SecondsOf(*nearest) - point.start_s) <= half_step_s + 1e-9)
      labels[static_cast<std::size_t>(nearest - times.begin())] = point.text;
  }
  return labels;
}

}  // namespace

Result<TextGrid> ParseTextGrid(std::string_view bytes, const std::string& source_name) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 30;  // ICU counts in int32
  if (bytes.size() > kMostBytes)
    return Fail(fmt::format("{}: {} bytes are too many for a TextGrid", source_name, bytes.size()));
  if (bytes.starts_with("ooBinaryFile"))
    return Fail(
        fmt::format("{}: is a binary Praat file; save it in Praat as a text file", source_name));
  TextGrid grid;
  const std::string text = DecodeText(bytes, source_name, grid.warnings);
  TokenReader reader(text, source_name);
  if (const auto read = ReadFileType(reader); !read) return tl::unexpected(read.error());
  const auto start_s = reader.NextNumber("the start of the TextGrid");
  if (!start_s) return tl::unexpected(start_s.error());
  const auto end_s = reader.NextNumber("the end of the TextGrid");
  if (!end_s) return tl::unexpected(end_s.error());
  grid.start_s = *start_s;
  grid.end_s = *end_s;
  const auto has_tiers = reader.NextFlag("<exists> or <absent>");
  if (!has_tiers) return tl::unexpected(has_tiers.error());
  if (*has_tiers == "<absent>") return grid;
  const auto num_tiers = reader.NextCount("the number of tiers");
  if (!num_tiers) return tl::unexpected(num_tiers.error());
  for (std::size_t i = 0; i < *num_tiers; ++i) {
    auto tier = ReadTier(reader);
    if (!tier) return tl::unexpected(tier.error());
    grid.tiers.push_back(std::move(*tier));
  }
  return grid;
}

Result<TextGrid> ReadTextGrid(const std::filesystem::path& path) {
  const auto bytes = ReadFile(path);
  if (!bytes) return tl::unexpected(bytes.error());
  return ParseTextGrid(*bytes, path.string());
}

void ShiftTimes(TextGrid& grid, double shift_s) {
  grid.start_s += shift_s;
  grid.end_s += shift_s;
  for (TextGridTier& tier : grid.tiers)
    for (TextGridLabel& label : tier.labels) {
      label.start_s += shift_s;
      label.end_s += shift_s;
    }
}

Result<const TextGridTier*> FindPhoneTier(const TextGrid& grid, std::string_view name) {
  if (!name.empty()) {
    for (const TextGridTier& tier : grid.tiers)
      if (tier.name == name) return &tier;
    return Fail(fmt::format("there is no tier '{}'; {}", name, TierNames(grid)));
  }
  const TextGridTier* found = nullptr;
  for (const TextGridTier& tier : grid.tiers) {
    if (tier.kind != TextGridTier::Kind::kIntervals || !SaysPhones(tier.name)) continue;
    if (found)
      return Fail(fmt::format("several tiers may hold the phones ('{}' and '{}'); name one; {}",
                              found->name, tier.name, TierNames(grid)));
    found = &tier;
  }
  if (!found)
    return Fail(
        fmt::format("no tier's name says that it holds phones; name one; {}", TierNames(grid)));
  return found;
}

std::vector<std::string> LabelsOfFrames(const TextGridTier& tier,
                                        std::span<const SessionTime> times) {
  ARTICAP_CHECK(std::is_sorted(times.begin(), times.end()));
  if (tier.kind == TextGridTier::Kind::kPoints) return LabelsOfPoints(tier, times);
  std::vector<std::string> labels(times.size());
  std::size_t current = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double time_s = SecondsOf(times[i]);
    while (current < tier.labels.size() && tier.labels[current].end_s <= time_s) ++current;
    const bool at_the_end =
        current == tier.labels.size() && current > 0 && tier.labels.back().end_s == time_s;
    if (at_the_end)
      labels[i] = tier.labels.back().text;
    else if (current < tier.labels.size() && tier.labels[current].start_s <= time_s)
      labels[i] = tier.labels[current].text;
  }
  return labels;
}

}  // namespace articap
