// Colours that colour-blind readers can tell apart: Okabe & Ito 2008 for lines, viridis (van der Walt & Smith 2015) for amounts, and for
// signed values blue – grey – orange, whose brightness falls evenly on both sides of zero.

export const LINES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a6d3b", "#7f7f7f"];

const VIRIDIS = ["#440154", "#482475", "#414487", "#355f8d", "#2a788e", "#21918c", "#22a884", "#44bf70", "#7ad151", "#bddf26", "#fde725"];
const DIVERGING = ["#08306b", "#2166ac", "#4393c3", "#92c5de", "#d1e5f0", "#f0f0f0", "#fde0c5", "#f4a66a", "#d9722b", "#a94a06", "#662506"];

const parse = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
const SCALES = { viridis: VIRIDIS.map(parse), diverging: DIVERGING.map(parse) };

/** [red, green, blue], 0 … 255, at 0 … 1 of a scale. */
export function channels(name, share) {
  const stops = SCALES[name];
  const at = Math.min(1, Math.max(0, share)) * (stops.length - 1);
  const lower = Math.min(stops.length - 2, Math.floor(at));
  return stops[lower].map((channel, index) => Math.round(channel + (at - lower) * (stops[lower + 1][index] - channel)));
}

export const colourAt = (name, share) => `rgb(${channels(name, share).join(",")})`;
export const line = (index) => LINES[index % LINES.length];

let printing = false;
/** Paper is white, whatever the screen is. */
export const setPrinting = (value) => (printing = value);
export const isDark = () => !printing && window.matchMedia("(prefers-color-scheme: dark)").matches;

/** Colours of axes and texts. */
export const theme = () => (isDark()
  ? { text: "#e4e8ec", faint: "#a7b0b9", rule: "#3a434c", back: "#14181c", panel: "#1b2127", empty: "#262d34", strong: "#ffffff" }
  : { text: "#1c2329", faint: "#55606a", rule: "#d9dee3", back: "#ffffff", panel: "#ffffff", empty: "#eceff2", strong: "#000000" });
