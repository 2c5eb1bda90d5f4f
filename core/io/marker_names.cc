// SPDX-License-Identifier: MIT
#include "core/io/marker_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "core/io/text.h"

namespace articap {
namespace {

// Gives every label after the first of its kind a number, in order: "chin", "chin_2", "chin_3".
// Returns how many were changed.
int MakeUnique(std::vector<std::string>& names, std::size_t max_bytes) {
  std::unordered_set<std::string> taken(names.begin(), names.end());
  std::unordered_set<std::string> seen;
  std::unordered_map<std::string, int> counts;
  int changed = 0;
  for (std::string& name : names) {
    if (seen.insert(name).second) continue;
    std::string candidate;
    int& count = counts.try_emplace(name, 1).first->second;
    do {
      const std::string suffix = fmt::format("_{}", ++count);
      candidate = CleanText(name, max_bytes - suffix.size()) + suffix;
    } while (taken.contains(candidate));
    name = candidate;
    taken.insert(name);
    seen.insert(name);
    ++changed;
  }
  return changed;
}

// Names that programs give to what has no label: "", "*", "*12".
bool IsUnlabelled(std::string_view label) { return label.empty() || label.front() == '*'; }

// "Anna" where every labelled marker is called "Anna:" and something more.
std::string SharedSubject(const std::vector<std::string>& labels) {
  std::string_view subject;
  for (const std::string& label : labels) {
    if (IsUnlabelled(label)) continue;
    const std::size_t colon = label.find(':');
    if (colon == std::string::npos) return "";
    const std::string_view prefix = std::string_view(label).substr(0, colon);
    const std::string_view name = std::string_view(label).substr(colon + 1);
    if (prefix.empty() || Trim(prefix) != prefix || name.empty() || Trim(name) != name) return "";
    if (!subject.empty() && prefix != subject) return "";
    subject = prefix;
  }
  return std::string(subject);
}

int NameUnlabelled(std::vector<std::string>& names) {
  int count = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!IsUnlabelled(names[i])) continue;
    names[i] = fmt::format("unlabelled_{}", i + 1);
    ++count;
  }
  return count;
}

}  // namespace

NamedMarkers NameMarkers(const std::vector<std::string>& labels,
                         std::vector<std::string>& warnings) {
  NamedMarkers named;
  named.names.reserve(labels.size());
  for (const std::string& label : labels) named.names.push_back(CleanText(label));
  named.subject = SharedSubject(named.names);
  if (!named.subject.empty())
    for (std::string& name : named.names)
      if (!IsUnlabelled(name)) name = Trim(std::string_view(name).substr(named.subject.size() + 1));
  if (const int unlabelled = NameUnlabelled(named.names))
    warnings.push_back(fmt::format(
        "{} of {} markers have no label; they are called unlabelled_N, N their place in the file.",
        unlabelled, labels.size()));
  const std::vector<std::string> before = named.names;
  if (const int duplicates = MakeUnique(named.names, 255)) {
    std::size_t example = 0;
    while (before[example] == named.names[example]) ++example;
    warnings.push_back(fmt::format(
        "{} markers shared a name with another and were renamed, as "
        "\"{}\" (marker {}) to \"{}\".",
        duplicates, Printable(before[example]), example + 1, Printable(named.names[example])));
  }
  return named;
}

std::vector<std::string> LabelsToWrite(const MarkerRecording& recording, std::size_t max_bytes) {
  std::vector<std::string> labels = recording.tracks.names();
  const std::string subject = CleanText(recording.subject, max_bytes / 2);
  for (std::string& label : labels)
    if (!subject.empty() && !IsUnlabelled(label)) label = subject + ":" + label;
  std::vector<std::string> ignored_warnings;
  NamedMarkers named = NameMarkers(labels, ignored_warnings);
  for (std::string& name : named.names) {
    if (!named.subject.empty()) name = named.subject + ":" + name;
    name = CleanText(name, max_bytes);
  }
  MakeUnique(named.names, max_bytes);
  return named.names;
}

}  // namespace articap
