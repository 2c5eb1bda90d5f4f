// SPDX-License-Identifier: MIT
// The head of the page: title, verdicts, warnings, figures of each stage.
import {element, formatFixed, formatNumber, splitUnit, withUnit} from './text.js';

export function showMasthead({take, stages, tracks}) {
  document.getElementById('title').textContent = take.title;
  const duration_s = take.num_frames / take.rate_hz;
  const facts = [
    [formatNumber(take.num_frames), 'frames'],
    [withUnit(formatNumber(take.rate_hz, 6), 'Hz'), ''],
    [duration_s < 120 ? withUnit(formatFixed(duration_s, 1), 's')
                      : `${Math.floor(duration_s / 60)} min ${formatFixed(duration_s % 60, 0)} s`, ''],
    [String(tracks.parameters.length), 'parameters'],
  ];
  document.getElementById('facts').append(...facts.flatMap(([value, what], i) =>
      [i ? ' · ' : '', element('b', {}, value), what ? ` ${what}` : '']));
  const bad = stages.filter(({usable}) => !usable);
  const verdict = document.getElementById('verdict');
  verdict.hidden = stages.length === 0;
  verdict.textContent = bad.length ? `not usable: ${bad.map(({stage}) => stage).join(', ')}` : 'usable';
  verdict.classList.add(bad.length ? 'bad' : 'good');
}

export function showWarnings(stages) {
  const items = stages.flatMap(({stage, warnings}) => warnings.map((warning) =>
      element('li', {}, element('span', {class: 'stage'}, `${stage}: `), warning)));
  if (items.length === 0) return;
  const section = document.getElementById('warnings');
  section.hidden = false;
  const heading = items.length === 1 ? 'One warning' : `${items.length} warnings`;
  const kShown = 8;
  section.append(element('h2', {}, heading), element('ul', {}, ...items.slice(0, kShown)));
  if (items.length > kShown)
    section.append(element('details', {}, element('summary', {}, `${items.length - kShown} more`),
                           element('ul', {}, ...items.slice(kShown))));
}

export function showStages(stages) {
  document.getElementById('stages').append(...stages.map(stageCard));
}

/** A list of [name, text]; long texts take a line of their own. */
function figureList(entries) {
  const kLongest = 26;
  return element('dl', {class: 'figures'}, ...entries.flatMap(([name, text]) => {
    const attributes = text.length > kLongest ? {class: 'long'} : {};
    return [element('dt', attributes, name), element('dd', attributes, text)];
  }));
}

function stageCard({stage, usable, verdict, figures, texts, tables, options}) {
  const entries = texts.filter(({value}) => value !== '').map(({name, value}) => [name.replaceAll('_', ' '), value]);
  for (const {name, value} of figures) {
    const {label, unit} = splitUnit(name);
    entries.push([label, withUnit(formatNumber(value), value === null ? '' : unit)]);
  }
  const card = element('article', {class: 'card stage-card'},
      element('header', {}, element('h2', {}, stage),
              element('span', {class: `mark ${usable ? 'good' : 'bad'}`}, usable ? '✓ usable' : '✗ not usable')),
      element('p', {class: 'says'}, verdict));
  if (entries.length)
    card.append(element('details', {}, element('summary', {}, `figures (${entries.length})`), figureList(entries)));
  for (const table of tables) if (table.rows.length) card.append(tableDetails(table));
  if (options.length)
    card.append(element('details', {}, element('summary', {}, 'options used'),
                        figureList(options.map(({name, value}) => [name, value === '' ? '–' : value]))));
  return card;
}

function tableDetails({name, columns, rows}) {
  const head = element('tr', {}, element('th', {}, ''), ...columns.map((column) => {
    const {label, unit} = splitUnit(column);
    return element('th', {}, unit ? `${label} (${unit})` : label);
  }));
  const body = rows.map(({label, values}) => element('tr', {}, element('td', {}, label),
      ...values.map((value) => element('td', {}, formatNumber(value)))));
  return element('details', {}, element('summary', {}, `${name.replaceAll('_', ' ')} (${rows.length})`),
                 element('div', {class: 'scroll'}, element('table', {}, head, ...body)));
}
