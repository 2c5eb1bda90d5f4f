// SPDX-License-Identifier: MIT
// The head of a page about one result: title, facts, verdict, what it means, warnings.
import {element} from './text.js';

function gradeOf(usable, warnings) {
  if (!usable) return ['bad', '✗', 'Not usable'];
  if (warnings.length > 0)
    return [
      'caution', '!',
      warnings.length === 1 ? 'Usable, with a warning' : `Usable, with ${warnings.length} warnings`
    ];
  return ['good', '✓', 'Usable'];
}

/** `says` and `meaning`: sentences; `warnings`: what each shows, a list of nodes or texts. */
export function showVerdict({title, facts, usable, says, meaning, warnings}) {
  document.title = document.getElementById('title').textContent = title;
  document.getElementById('facts').textContent = facts.join(' · ');
  const [grade, sign, words] = gradeOf(usable, warnings);
  const verdict = document.getElementById('verdict');
  verdict.classList.add(grade);
  verdict.append(
      element(
          'p', {class: 'grade'}, element('span', {class: 'sign', 'aria-hidden': 'true'}, sign),
          words),
      ...says.map((sentence) => element('p', {class: 'says'}, sentence)),
      element('ul', {}, ...meaning.map((sentence) => element('li', {}, sentence))));
  if (warnings.length === 0) return;
  const section = document.getElementById('warnings');
  section.hidden = false;
  section.append(
      element('h2', {}, warnings.length === 1 ? 'One warning' : `${warnings.length} warnings`),
      element('ul', {}, ...warnings.map((warning) => element('li', {}, ...warning))));
}
