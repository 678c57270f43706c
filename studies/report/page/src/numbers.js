// Numbers as a mill engineer reads them. Data are SI; a `scale` turns all values of one chart or column into one unit.

export const MISSING = "–";
export const INSIDE = 1.645; // standard deviations that hold nine of ten numbers
export const isNumber = (value) => typeof value === "number" && Number.isFinite(value);

const SUPERSCRIPT = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
export const superscript = (value) => [...String(value)].map((digit) => SUPERSCRIPT[digit] ?? digit).join("");

const group = (digits) => digits.replace(/\B(?=(\d{3})+(?!\d))/g, "\u202f");

function plain(value, decimals) {
  const [whole, fraction] = Math.abs(value).toFixed(decimals).split(".");
  const text = (whole.length > 4 ? group(whole) : whole) + (fraction ? `.${fraction}` : "");
  return (value < 0 && /[1-9]/.test(text) ? "−" : "") + text;
}

/** With so many significant digits; powers of ten beyond 0.0001 … 1 000 000. */
export function number(value, digits = 4) {
  if (!isNumber(value)) return MISSING;
  if (value === 0) return "0";
  const size = Math.floor(Math.log10(Math.abs(value)) + 1e-12);
  if (size < -4 || size > 6) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return `${mantissa.replace("-", "−").replace(/\.?0+$/, "")} × 10${superscript(Number(exponent))}`;
  }
  const text = plain(value, Math.max(0, digits - 1 - size));
  return text.includes(".") ? text.replace(/\.?0+$/, "") : text;
}

/** As many decimals as two digits of the error ask for. */
function decimalsFor(error) {
  return isNumber(error) && error > 0 ? Math.min(8, Math.max(0, 1 - Math.floor(Math.log10(error) + 1e-12))) : null;
}

const spaced = (unit) => (unit === "" ? "" : unit === "°" ? "°" : `\u00a0${unit}`);

/** "453.6 ± 4.3 mW": the value to two digits of its standard error. */
export function withError(value, error, unit) {
  if (!isNumber(value)) return MISSING;
  const by = scale(unit, [value]);
  const decimals = decimalsFor(error * by.factor);
  if (decimals === null) return number(value * by.factor) + spaced(by.unit);
  return `${plain(value * by.factor, decimals)} ±\u00a0${plain(error * by.factor, decimals)}${spaced(by.unit)}`;
}

export function quantity(value, unit, digits = 4) {
  if (!isNumber(value)) return MISSING;
  const by = scale(unit, [value]);
  return number(value * by.factor, digits) + spaced(by.unit);
}

/** "0.182 … 0.348", both ends with the decimals that their distance asks for. */
export function interval(low, high, factor = 1) {
  if (!isNumber(low) || !isNumber(high)) return MISSING;
  const decimals = decimalsFor(((high - low) * factor) / 4);
  const text = (value) => (decimals === null ? number(value * factor) : plain(value * factor, decimals));
  return `${text(low)} … ${text(high)}`;
}

/** The value to the digits that its interval has. */
export function among(value, low, high, factor = 1) {
  if (!isNumber(value)) return MISSING;
  const decimals = isNumber(low) && isNumber(high) && high > low ? decimalsFor(((high - low) * factor) / 4) : null;
  return decimals === null ? number(value * factor) : plain(value * factor, decimals);
}

export function probability(p) {
  if (!isNumber(p)) return MISSING;
  if (p < 0.001) return "< 0.001";
  return number(p, 2);
}

/** "p < 0.001" or "p = 0.02", for sentences. */
export const pValue = (p) => (isNumber(p) && p < 0.001 ? "p\u00a0<\u00a00.001" : `p\u00a0=\u00a0${probability(p)}`);

export const percent = (share, digits = 3) => (isNumber(share) ? `${number(100 * share, digits)}\u00a0%` : MISSING);
export const signed = (value, digits = 3) => (isNumber(value) && value > 0 ? "+" : "") + number(value, digits);

const PREFIXES = [[1e-15, "f"], [1e-12, "p"], [1e-9, "n"], [1e-6, "µ"], [1e-3, "m"], [1, ""], [1e3, "k"], [1e6, "M"], [1e9, "G"]];
const FIXED = {
  m: [1e3, "mm"], "m^2": [1e6, "mm²"], "m^2/s": [1e6, "mm²/s"], "rad/s": [30 / Math.PI, "rpm"], rad: [180 / Math.PI, "°"], deg: [1, "°"],
  "1": [1, ""], "": [1, ""],
};
const PREFIXED = { J: 0, W: 0, "N m": 0, s: 0, "W/kg": 0, Pa: 0, N: 0 };

/** {factor, unit} for all these values of one SI unit. */
export function scale(unit, values = []) {
  const known = FIXED[unit ?? ""];
  if (known) return { factor: known[0], unit: known[1] };
  const largest = values.reduce((most, value) => (isNumber(value) ? Math.max(most, Math.abs(value)) : most), 0);
  if (unit === "kg" && largest > 0 && largest < 1) return { factor: 1e3, unit: "g" };
  if (unit in PREFIXED) {
    const found = largest > 0 ? PREFIXES.filter(([size]) => largest >= 0.999 * size && (unit !== "s" || size <= 1)).pop() : null;
    const [size, prefix] = found ?? [1, ""];
    return { factor: 1 / size, unit: prefix + unit };
  }
  return { factor: 1, unit: unit.replace(/\^(-?\d)/g, (all, power) => superscript(power)).replace(/ /g, "\u00a0") };
}

/** "speed (m/s)" */
export const named = (name, unit) => (unit ? `${name} (${unit})` : name);
const SHORT = { pept: "PEPT", rms: "RMS" };
/** "bead_friction" → "bead friction" */
export const words = (name) => String(name).replace(/_+/g, " ").trim().replace(/\b(pept|rms)\b/g, (found) => SHORT[found]);
/** A sentence of the program with the names in it as words: "pept_grid.velocity_y" → "PEPT grid: velocity y"; files, places in a case and units stay. */
export const readable = (text) => String(text ?? "").replace(/\b[a-z][a-z0-9]*_[a-z0-9_]*(\.[a-z][a-z0-9_]*)?(?![\w./])/g,
  (name, member, at, whole) => (/[.~/]/.test(whole.charAt(at - 1)) ? name : words(name.replace(".", ": ")))).replace(/\bNaN\b/g, "undefined");
/** "2026-11-22T08:36:11Z" → "2026-11-22 08:36 UTC" */
export const moment = (text) => String(text ?? "").replace(/^(\d{4}-\d\d-\d\d)T(\d\d:\d\d)(:\d\d)?Z$/, "$1 $2 UTC");
export const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);
