// Printed numbers: fixed decimals, a true minus sign, "–" if a quantity is not defined.

export function number(value, decimals, { signed = false } = {}) {
  if (!Number.isFinite(value)) return "–";
  const text = Math.abs(value).toFixed(decimals);
  const zero = Number(text) === 0;
  if (value < 0 && !zero) return `\u2212${text}`;
  return signed && !zero ? `+${text}` : text;
}

export function quantity(value, decimals, unit, options) {
  const text = number(value, decimals, options);
  return unit && text !== "–" ? `${text}\u00a0${unit}` : text;
}

/** A value of a curve in display units; with "≈" if interpolation may change the last digit. */
export function reading(curve, value, sampled, { unit = curve.unit } = {}) {
  const text = quantity(value, curve.decimals, unit);
  return curve.approximate && !sampled && text !== "–" ? `≈\u00a0${text}` : text;
}

/** A sample in display units; some curves are sampled as one over their values. */
export function inUnit({ reciprocal, factor }, sample) {
  return (reciprocal ? 1 / sample : sample) * factor;
}
