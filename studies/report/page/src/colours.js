// The colours of the pictures (palette.js is made of studies/picture/palette.hpp when the page is built), and which of them a value has.
import { DISTINCT, DIVERGING, SEQUENTIAL } from "./palette.js";

const parse = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
const SCALES = { sequential: SEQUENTIAL.map(parse), diverging: DIVERGING.map(parse) };

/** [red, green, blue], 0 … 255, at 0 … 1 of a scale. */
export function channels(name, share) {
  const stops = SCALES[name];
  const at = Math.min(1, Math.max(0, share)) * (stops.length - 1);
  const lower = Math.min(stops.length - 2, Math.floor(at));
  return stops[lower].map((channel, index) => Math.round(channel + (at - lower) * (stops[lower + 1][index] - channel)));
}

export const colourAt = (name, share) => `rgb(${channels(name, share).join(",")})`;
export const line = (index) => DISTINCT[index % DISTINCT.length];

/** Colours of an amount: ends of the bar, and the place of a value on it. Single cells far outside do not set the ends, and zero is no
 *  value. The rule of studies/picture/map_colors.cpp; tests/picture/colours.json holds both to it. */
export function colouring(values, { signed } = {}) {
  const known = values.filter((value) => Number.isFinite(value) && value !== 0).sort((a, b) => a - b);
  if (known.length === 0) return null;
  const at = (share) => known[Math.round(share * (known.length - 1))];
  const [least, most] = [known[0], known[known.length - 1]];
  let [low, high] = [at(0.01), at(0.99)];
  const span = Math.max(high - low, 0.5 * Math.max(Math.abs(low), Math.abs(high)));
  if (most - high < 0.3 * span) high = most;
  if (low - least < 0.3 * span) low = least;
  const size = Math.max(Math.abs(low), Math.abs(high));
  const isSigned = signed ?? (low < -0.05 * size && high > 0.05 * size);
  if (isSigned) [low, high] = [-size, size];
  else if (high > 0 && low < 0.5 * high) low = 0; // from zero, unless that would waste more than half of the scale
  else if (high < 0 && high > 0.5 * low) high = 0;
  if (!(high > low)) [low, high] = [low - 0.5 * size, high + 0.5 * size];
  const name = isSigned ? "diverging" : "sequential";
  return { name, low, high, least, most, colour: (value) => colourAt(name, (value - low) / (high - low)) };
}

let printing = false;
/** Paper is white, whatever the screen is. */
export const setPrinting = (value) => (printing = value);
export const isDark = () => !printing && window.matchMedia("(prefers-color-scheme: dark)").matches;

/** Colours of axes and texts. */
export const theme = () => (isDark()
  ? { text: "#e4e8ec", faint: "#a7b0b9", rule: "#3a434c", back: "#14181c", panel: "#1b2127", empty: "#262d34", strong: "#ffffff" }
  : { text: "#1c2329", faint: "#55606a", rule: "#d9dee3", back: "#ffffff", panel: "#ffffff", empty: "#eceff2", strong: "#000000" });
