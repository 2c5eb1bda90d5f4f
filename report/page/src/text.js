// SPDX-License-Identifier: MIT
// Names, numbers and elements as people read them.

const kUnits = {
  mm: 'mm', deg: '°', rad: 'rad', hz: 'Hz', s: 's', ms: 'ms', us: 'µs', ns: 'ns', px: 'px', percent: '%', '%': '%',
};

/** "median_residual_mm" -> {label: "median residual", unit: "mm"} */
export function splitUnit(name) {
  const parts = name.split('_');
  const unit = parts.length > 1 ? kUnits[parts[parts.length - 1]] : undefined;
  if (unit) parts.pop();
  return {label: parts.join(' '), unit: unit ?? ''};
}

export function unitText(unit) {
  return unit === '1' ? '' : kUnits[unit] ?? unit;
}

export function withUnit(text, unit) {
  if (!unit) return text;
  return unit === '°' || unit === '%' ? text + unit : `${text}\u202f${unit}`;
}

export function formatNumber(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return '–';
  if (!Number.isFinite(value)) return '∞';
  if (Number.isInteger(value) && Math.abs(value) < 1e15)
    return value.toLocaleString('en').replaceAll(',', '\u202f');
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(2).replace('-', '−');
  return String(Number(value.toPrecision(digits))).replace('-', '−');
}

export function formatFixed(value, decimals) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  const text = value.toFixed(decimals);
  return (Number(text) === 0 ? text.replace('-', '') : text).replace('-', '−');
}

/** Decimals that show a quantity of this span to about a thousandth. */
export function decimalsFor(span) {
  return Math.max(0, Math.min(4, 3 - Math.ceil(Math.log10(Math.max(span, 1e-6)))));
}

export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith('on')) made.addEventListener(key.slice(2), value);
    else if (value === true) made.setAttribute(key, '');
    else if (value !== false && value !== null && value !== undefined) made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

export function cssColor(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
